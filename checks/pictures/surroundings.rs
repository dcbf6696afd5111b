//! Light from all around hair: the cells that hair is summed into keep still and fill evenly, through `shade` on both
//! backends.

use glam::Vec3;
use strandline_checks::{On, law};
use strandline_groom::Guides;
use strandline_render::{Environment, LevelOfDetail, Look, Shadow};

use crate::drawn::{Drawn, guides};
use crate::opacity::mop;
use crate::terms::plain;

/// Points of a strand: as few as there may be, so that its segments cross many cells.
const POINTS: usize = 4;
/// Distance \[m\] from one strand of a curtain to the next.
const SPACING: f32 = 2e-4;

/// White hair, 0.4 mm thick, in white surroundings: the radiance of a point is the share of them that it sees.
fn surrounded(guides: Guides) -> Drawn {
    let look = Look {
        environment: Environment { sky: Vec3::ONE, ground: Vec3::ONE },
        shadow: Shadow::default(),
        width_scale: 5.0,
        ..plain(Vec3::splat(0.99))
    };
    let detail = LevelOfDetail { segments_per_span: 1, ..LevelOfDetail::full() };
    Drawn { guides, look, lights: Vec::new(), eye: Vec3::Z * 200.0, detail }
}

/// The share of the surroundings that each point sees, shape `[frame][strand][point]`, strand by strand.
fn seen(on: &On, frames: &[Guides]) -> Vec<Vec<f32>> {
    let strands = surrounded(frames[0].clone()).frames(on, frames);
    strands.iter().map(|strands| strands.radiances.iter().map(|radiance| radiance.x).collect()).collect()
}

/// 200 strands of 16 cm beside each other, at a place \[m\] to the side.
fn curtain(x: f32) -> impl Iterator<Item = Vec<Vec3>> {
    (0..200).map(move |strand| {
        let root = Vec3::new(x, 0.0, SPACING * strand as f32);
        vec![root, root + Vec3::Y * 0.16]
    })
}

law! {
    fn hair_that_crosses_cells_changes_the_surroundings_of_other_hair_evenly(on) {
        // A curtain of long segments passes a short strand, a tenth of a cell of 4 mm a frame; one that stays spans the
        // cells.
        let at = Vec3::new(0.058, 0.083, 0.02);
        let short = vec![at, at + Vec3::Y * 1e-3];
        let frame = |frame: usize| {
            let around = [short.clone(), vec![Vec3::ZERO, Vec3::new(0.16, 0.16, 0.0)]];
            guides(around.into_iter().chain(curtain(0.046 + 4e-4 * frame as f32)), POINTS)
        };
        let frames: Vec<Guides> = (0..60).map(frame).collect();
        let shares: Vec<f32> = seen(on, &frames).iter().map(|points| points[0]).collect();
        let most = shares.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
        let (least, greatest) =
            shares.iter().fold((1.0_f32, 0.0_f32), |(a, b), &share| (a.min(share), b.max(share)));
        assert!(greatest - least > 0.1, "{least} to {greatest}");
        // It comes and goes, each in some two cells, 20 frames: the steepest of them was 0.13 of the change, where
        // hair counted to a single cell made jumps of half of it.
        assert!(most < 0.2 * (greatest - least), "{most} in a frame, of {least} to {greatest}");
    }
}

law! {
    fn hair_at_rest_keeps_its_surroundings_while_other_hair_moves(on) {
        let rest = mop(1500);
        // One strand beside the others, whose tip goes out by 3 mm a frame.
        let frame = |frame: usize| {
            let reach = 0.05 + 0.003 * frame as f32;
            let aside = vec![Vec3::new(-0.2, 0.1, 0.0), Vec3::new(-0.2 - reach, 0.1, 0.0)];
            guides(rest.iter().cloned().chain([aside]), 8)
        };
        let frames: Vec<Guides> = (0..6).map(frame).collect();
        let shares = seen(on, &frames);
        for (frame, pair) in shares.windows(2).enumerate() {
            let kept = pair[0].iter().zip(&pair[1]).take(8 * rest.len());
            let change = kept.map(|(before, after)| (after - before).abs()).sum::<f32>() / (8 * rest.len()) as f32;
            // The remaining change is the far tip's occlusion and rounding: found up to 6e-7.
            assert!(change < 1e-4, "frame {frame}: {change}");
        }
    }
}

law! {
    fn the_number_of_segments_does_not_change_the_surroundings(on) {
        let [few, many] = [POINTS, 5 * (POINTS - 1) + 1].map(|points| {
            let points_of = seen(on, &[guides(curtain(0.0), points)]).remove(0);
            let every = (points - 1) / (POINTS - 1);
            points_of.chunks(points).flat_map(|strand| strand.iter().step_by(every)).copied().collect::<Vec<f32>>()
        });
        let mean = |shares: &[f32]| shares.iter().sum::<f32>() / shares.len() as f32;
        let apart = few.iter().zip(&many).map(|(few, many)| (few - many).abs()).sum::<f32>() / few.len() as f32;
        assert!(mean(&many) < 0.9, "the curtain hides much of the surroundings: {}", mean(&many));
        // Segments are summed in pieces of up to a cell, whose middles lie elsewhere: found 0.4 %.
        assert!(apart < 0.02 * mean(&many), "{apart} of {}", mean(&many));
    }
}
