//! Drawn hair on the sample bust that turns and shrugs, against the exact deformed mesh.

use std::ops::Range;
use std::path::Path;

use glam::Vec3;
use strandline::{Prepared, Scene};
use strandline_body::{BodyFrame, SkinRoots};
use strandline_checks::{Depths, On, Rig, in_full};
use strandline_groom::{Frames, LANES, Vec3Lanes};
use strandline_render::{
    DetailLevel, RootTurns, Strands,
    cpu::{Curves, interpolate, keep_outside, tessellate},
};
use strandline_sim::{Drive, Model};

/// Depth \[m\] of rounding.
const ROUNDING: f32 = 2e-5;

/// Counts of points: those looked at, those inside, and the depth \[m\] of the deepest.
#[derive(Clone, Copy, Debug, Default)]
struct Found {
    all: usize,
    inside: usize,
    deepest: f32,
}

impl Found {
    fn add(&mut self, depths: &[f32]) {
        self.all += depths.len();
        self.inside += depths.iter().filter(|depth| **depth > ROUNDING).count();
        self.deepest = depths.iter().fold(self.deepest, |deepest, depth| deepest.max(*depth));
    }
}

fn ponytail(clip: &str) -> Option<Prepared> {
    let bust = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/bust.glb");
    strandline_checks::ponytail_on(bust, |scene: &mut Scene| {
        scene.body.clip = Some(clip.to_owned());
        scene.motion.name = "still".parse().unwrap();
    })
}

/// Points of strands in a range of their numbers \[m\], of `each` points a strand.
fn within(range: Range<usize>, each: usize, points: &[Vec3]) -> Vec<Vec3> {
    points.chunks(each).flat_map(|strand| strand[range.clone()].iter().copied()).collect()
}

fn in_order(lanes: &[Vec3Lanes], strands: usize, points: usize) -> Vec<Vec3> {
    let place = |strand: usize, point: usize| lanes[strand / LANES * points + point].get(strand % LANES);
    (0..strands).flat_map(|strand| (0..points).map(move |point| place(strand, point))).collect()
}

/// Points that pictures draw \[m\], world space: those of the first span behind the root, which leads out of the skin, and all
/// others.
fn drawn(prepared: &Prepared, placed: &[Vec3Lanes], body: &BodyFrame) -> [Vec<Vec3>; 2] {
    let look = &prepared.scene.look;
    let bound = prepared.bound.as_ref().unwrap();
    let all = bound.strands();
    let spans = prepared.scene.level_of_detail.segments_per_span;
    let level = DetailLevel::full(spans, look.follow_strands);
    let (mut curves, mut strands) = (Curves::default(), Strands::default());
    let mut turns = RootTurns::default();
    turns.place(body, Some(bound.binding()), all.strand_count());
    tessellate(placed, all, &turns, &level, &mut curves);
    interpolate(&curves, all, &turns, look, &level, &mut strands);
    keep_outside(&mut strands, &curves, all.points_per_strand(), &bound.solids().placed(body.clone()));
    let each = level.segment_count(all.points_per_strand()) + 1;
    let first = spans as usize;
    [within(1..first, each, &strands.positions), within(first..each, each, &strands.positions)]
}

/// Runs a clip and looks every so many steps, and where the report says more than 1 mm: free points of guides, points of
/// bound strands, drawn points of the first span, all other drawn points; and the report's deepest \[m\] of all steps.
fn looks(clip: &str, seconds: f64, every: usize) -> Option<([Found; 4], f32)> {
    let prepared = ponytail(clip)?;
    let mut settings = prepared.scene.simulation.clone();
    let hairs = prepared.scene.look.hair_count as f32 / prepared.guides.strand_count() as f32;
    settings.drag.hairs = settings.drag.hairs.or(Some(hairs));
    let (guides, bound) = (&prepared.guides, prepared.bound.as_ref().unwrap());
    let mesh = prepared.mesh.as_ref().unwrap();
    let roots: Vec<Vec3> = (0..guides.strand_count()).map(|strand| guides.position(strand, 0)).collect();
    let roots = SkinRoots::new(mesh, &roots);
    let points = guides.points_per_strand();
    let mut rig = Rig::new(&On::Cpu, Model::new(guides, &settings, prepared.colliders.clone()).unwrap());
    let mut body = roots.placed(prepared.head.frame(0.0), &BodyFrame::REST);
    let (mut found, mut reported) = ([Found::default(); 4], 0.0_f32);
    let (mut frames, mut placed) = (Frames::default(), Vec::new());
    for step in 1..=(seconds / f64::from(settings.time_step)) as usize {
        body = roots.placed(prepared.head.frame(step as f64 * f64::from(settings.time_step)), &body);
        let report = rig.step(&Drive::of(body.clone()));
        reported = reported.max(report.penetration_max);
        if step % every != 0 && report.penetration_max < 1e-3 {
            continue;
        }
        let head = body.world_from_head();
        let skin = body.skin().unwrap().iter().map(|place| head.point(*place)).collect();
        let depths = Depths::new(mesh, skin);
        let free =
            within(2..points, points, &in_order(&rig.state().positions, guides.strand_count(), points));
        found[0].add(&depths.of(&free));
        bound.place(&rig.state().positions, &body, &mut frames, &mut placed);
        let strands = bound.strands().strand_count();
        found[1].add(&depths.of(&within(1..points, points, &in_order(&placed, strands, points))));
        for (found, drawn) in found[2..].iter_mut().zip(drawn(&prepared, &placed, &body)) {
            found.add(&depths.of(&drawn));
        }
    }
    Some((found, reported))
}

/// The bounds are those that a viewer asks for; the report of every step tells the same.
#[test]
fn drawn_hair_stays_outside_the_sample_bust() {
    let (seconds, every, clips) = if in_full() { (2.7, 3, 2) } else { (0.6, 18, 1) };
    for clip in ["shrug", "look"].into_iter().take(clips) {
        let Some((found, reported)) = looks(clip, seconds, every) else { return };
        println!("{clip}: {found:?}, the report says {:.2} mm at most", 1e3 * reported);
        for Found { all, inside, deepest } in found {
            assert!(all > 0 && inside * 1000 <= all && deepest < 2e-3, "{clip}: {found:?}");
        }
        assert!(reported < 2e-3, "{clip}: the report says {reported} m");
    }
}
