//! Shadows that keep still: texels and cells stay where they are while hair and lights move a little.

use glam::Vec3;
use strandline_checks::gpu;
use strandline_render::cpu::{Occlusion, Shadows, Strands, opacity_depth, opacity_layers};
use strandline_render::gpu::GpuRenderer;
use strandline_render::{Light, LightKind, Look, Shadow};

use crate::opacity::{mop, renderer, shadows_in, strands};

const DIAMETER: f32 = 4e-4;

/// Shadow maps of one backend.
enum Maps {
    Cpu,
    Gpu(Box<GpuRenderer>),
}

impl Maps {
    /// Both backends, as far as there are.
    fn all() -> Vec<Self> {
        let mut all = vec![Self::Cpu];
        all.extend(gpu().map(|gpu| Self::Gpu(renderer(&gpu).into())));
        all
    }

    fn name(&self) -> &'static str {
        match self {
            Self::Cpu => "cpu",
            Self::Gpu(_) => "gpu",
        }
    }

    /// Share of a light that reaches points of hair, with maps of so many texels a side.
    fn transmittances(&mut self, lines: &[Vec<Vec3>], light: &Light, size: u32, points: &[Vec3]) -> Vec<f32> {
        let strands: Strands = strands(lines, DIAMETER);
        let shadow = Shadow { map_size: size, ..Shadow::default() };
        let shadows = match self {
            Self::Cpu => {
                let mut shadows = Shadows::default();
                let lights = std::slice::from_ref(light);
                opacity_depth(&strands, None, lights, Vec3::ZERO, &shadow, &mut shadows);
                opacity_layers(&strands, &mut shadows);
                shadows
            }
            Self::Gpu(renderer) => {
                shadows_in(renderer, &strands, light, &Look { shadow, follow_strands: 1, ..Look::thesis() })
            }
        };
        let map = shadows.map(0).unwrap();
        points.iter().map(|&point| map.transmittance(point)).collect()
    }
}

/// Mean change from one frame to the next.
fn change(before: &[f32], after: &[f32]) -> f32 {
    before.iter().zip(after).map(|(before, after)| (after - before).abs()).sum::<f32>() / before.len() as f32
}

fn sun() -> Light {
    Light { kind: LightKind::Directional, position: Vec3::new(0.2, 1.0, 0.4), ..Light::default() }
}

#[test]
fn hair_at_rest_keeps_its_shadow_while_other_hair_moves() {
    let mut lines = mop(1500);
    let points = lines.concat();
    // One strand beside the others, whose tip goes out by 3 mm a frame.
    let aside = |reach: f32| (0..13).map(move |point| Vec3::new(0.2 + reach * point as f32 / 12.0, 0.1, 0.0));
    for mut maps in Maps::all() {
        let mut last: Option<Vec<f32>> = None;
        for frame in 0..6 {
            lines.truncate(1500);
            lines.push(aside(0.05 + 0.003 * frame as f32).collect());
            let now = maps.transmittances(&lines, &sun(), 512, &points);
            if let Some(last) = &last {
                // What is left are last bits of places in another window: found up to 1.1e-5.
                let change = change(last, &now);
                println!("{}: {change}", maps.name());
                assert!(change < 1e-3, "{} in frame {frame}: {change}", maps.name());
            }
            last = Some(now);
        }
    }
}

/// Hair that sways to the side, the more the lower it hangs, and breathes: some ten frames of slow motion,
/// 1 mm a frame at the tips.
fn swaying(lines: &[Vec<Vec3>], frame: usize) -> Vec<Vec<Vec3>> {
    let sway = |line: &Vec<Vec3>| -> Vec<Vec3> {
        let away = |(index, point): (usize, &Vec3)| {
            let share = index as f32 / 12.0;
            *point + Vec3::new(1.0, 0.0, 0.3 * point.z.signum()) * (1e-3 * share * share * frame as f32)
        };
        line.iter().enumerate().map(away).collect()
    };
    lines.iter().map(sway).collect()
}

#[test]
fn slow_hair_changes_its_shadow_slowly() {
    let rest = mop(1500);
    // Near the roots nothing moves, and the shadow of what hangs above changes a little.
    let upper = |lines: &[Vec<Vec3>]| lines.iter().flat_map(|line| line[..5].to_vec()).collect::<Vec<_>>();
    for mut maps in Maps::all() {
        let mut mean = |size: u32| {
            let frames: Vec<Vec<f32>> = (0..7)
                .map(|frame| {
                    let lines = swaying(&rest, frame);
                    maps.transmittances(&lines, &sun(), size, &upper(&lines))
                })
                .collect();
            frames.windows(2).map(|pair| change(&pair[0], &pair[1])).sum::<f32>() / 6.0
        };
        let (usual, fine) = (mean(512), mean(2048));
        println!("{}: change of a frame {usual}, with maps four times as fine {fine}", maps.name());
        // Finer maps tell single hairs apart and change more: found 0.009 against 0.023.
        assert!(usual < 0.5 * fine, "{}: {usual}, with finer maps {fine}", maps.name());
    }
}

/// Changes of light from frame to frame while a spot light goes a way, and the mean light.
fn lit_on_a_way(maps: &mut Maps, lines: &[Vec<Vec3>], way: &[Vec3]) -> Vec<f32> {
    let points = lines.concat();
    let frames: Vec<Vec<f32>> = way
        .iter()
        .map(|&position| {
            let light = Light { position, target: Vec3::new(0.0, 0.0, 0.01), ..Light::default() };
            maps.transmittances(lines, &light, 256, &points)
        })
        .collect();
    frames.windows(2).map(|pair| change(&pair[0], &pair[1])).collect()
}

#[test]
fn a_light_that_passes_a_pole_shades_without_a_jump() {
    let lines = mop(1500);
    // Over the head, from the front to the back beside it, and down the side of it: where frames of three
    // common kinds (about the height, about the depth, by the larger share) turn over.
    let over = |step: i32| {
        let turn = 0.2_f32.to_radians() * step as f32;
        Vec3::new(0.002, 1.5 * turn.cos(), 1.5 * turn.sin() + 0.01)
    };
    let beside = |step: i32| {
        let turn = 0.2_f32.to_radians() * step as f32;
        Vec3::new(1.2 * turn.cos(), 0.9, 1.2 * turn.sin() + 0.01)
    };
    for mut maps in Maps::all() {
        for (name, way) in [("over", over as fn(i32) -> Vec3), ("beside", beside)] {
            let way: Vec<Vec3> = (-4..=4).map(way).collect();
            let mut changes = lit_on_a_way(&mut maps, &lines, &way);
            println!("{} {name}: {changes:?}", maps.name());
            changes.sort_by(f32::total_cmp);
            let (usual, most) = (changes[changes.len() / 2], changes[changes.len() - 1]);
            assert!(most < 1.5 * usual, "{} {name}: {most}, usually {usual}", maps.name());
        }
    }
}

#[test]
fn hair_that_crosses_cells_changes_its_surroundings_evenly() {
    // A curtain of long segments that passes a place, a twentieth of a cell a frame, and a post that stays.
    let frame = |frame: usize| {
        let x = 0.05 + 2e-4 * frame as f32;
        let hang =
            |strand: usize| (0..3).map(move |point| Vec3::new(x, 0.08 * point as f32, 2e-4 * strand as f32));
        let post = (0..3).map(|point| Vec3::new(0.16 * (point % 2) as f32, 0.08 * point as f32, 0.0));
        let mut lines: Vec<Vec<Vec3>> = (0..200).map(|strand| hang(strand).collect()).collect();
        lines.push(post.collect());
        let mut occlusion = Occlusion::default();
        occlusion.fill(&strands(&lines, 2e-4), &Shadow::default());
        occlusion.visibilities(Vec3::new(0.058, 0.083, 0.02))[1]
    };
    let seen: Vec<f32> = (0..80).map(frame).collect();
    let most = seen.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
    let (least, greatest) = seen.iter().fold((1.0_f32, 0.0_f32), |(a, b), &seen| (a.min(seen), b.max(seen)));
    println!("{least} to {greatest}, {most} in a frame");
    // It passes the place in some three cells, 60 frames: a change spread over them, never one jump a cell.
    assert!(greatest - least > 0.1 && most < 0.06 * (greatest - least), "{least} to {greatest}, {most}");
}
