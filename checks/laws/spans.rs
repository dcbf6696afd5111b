//! Strands that are held at any of their points.

use std::f32::consts::TAU;

use glam::Vec3;
use strandline_body::{Carrier, Collider, Pose, Shape};
use strandline_checks::{On, Rig, law};
use strandline_groom::{Lanes, RestShape};
use strandline_sim::constrain::LengthPass;
use strandline_sim::{Drive, Model, Settings};

use crate::strands::{bare, chain, first, line, one_strand};

/// Sag over length of a rope of equal links and masses whose ends are `span` lengths apart.
///
/// Each link pulls across with the same force and down with the weight below it, so that link i of n
/// lies along (h, i - (n - 1) / 2); h is found by halving.
fn sag(links: usize, span: f64) -> f64 {
    let hang = |across: f64| {
        let (mut reach, mut height, mut lowest) = (0.0, 0.0, 0.0_f64);
        for link in 0..links {
            let down = link as f64 - 0.5 * (links as f64 - 1.0);
            let size = across.hypot(down) * links as f64;
            reach += across / size;
            height += down / size;
            lowest = lowest.min(height);
        }
        (reach, -lowest)
    };
    let (mut low, mut high) = (1e-6_f64, 1e6);
    for _ in 0..200 {
        let middle = (low * high).sqrt();
        if hang(middle).0 < span { low = middle } else { high = middle }
    }
    hang(low).1
}

/// Sag over length of 16 and 32 links by span: reference/catenary.csv, from an independent
/// program in double precision.
const CATENARIES: [(f64, f64, f64); 4] = [
    (0.4, 0.429_992_270, 0.428_283_539),
    (0.6, 0.363_835_118, 0.363_042_690),
    (0.8, 0.265_991_492, 0.265_575_607),
    (0.9, 0.191_078_964, 0.190_801_297),
];

#[test]
fn ropes_of_the_law_are_those_of_the_reference() {
    for (span, sixteen, thirty_two) in CATENARIES {
        assert!((sag(16, span) - sixteen).abs() < 1e-8, "{span}: {}", sag(16, span));
        assert!((sag(32, span) - thirty_two).abs() < 1e-8, "{span}: {}", sag(32, span));
    }
}

/// Damped, so that it hangs still soon; everything else as hair has it.
fn settings() -> Settings {
    Settings { damping: 4.0, ..bare(1.0 / 60.0, 20) }
        .with_constrain(|constrain| constrain.length_pass = LengthPass::default())
}

/// A rope of a length between two places, bent down at its middle where it is longer than their distance.
fn hung(start: Vec3, end: Vec3, length: f32, links: usize) -> Vec<Vec3> {
    let span = start.distance(end);
    let low = 0.5 * (start + end) - Vec3::Y * 0.5 * (length * length - span * span).max(0.0).sqrt();
    let mut points = line(start, low, links / 2);
    points.extend(&line(low, end, links - links / 2)[1..]);
    points
}

/// Largest share by which a segment of points is longer or shorter than its length.
fn off(points: &[Vec3], length: f32) -> f32 {
    points.windows(2).map(|pair| (pair[0].distance(pair[1]) / length - 1.0).abs()).fold(0.0, f32::max)
}

law! {
    fn a_rope_hangs_in_a_catenary_at_the_default_step(on) {
        let cases = [16, 32, 62].map(|links| [0.2, 0.4, 0.6, 0.8, 0.9, 0.95].map(|span| (links, span)));
        // A software adapter takes its time: the ends of both ranges.
        for (links, span) in cases.into_iter().flatten().step_by(on.short(1, 17)) {
            let length = 0.3;
            let points = hung(Vec3::ZERO, Vec3::X * length * span as f32, length, links);
            let model = chain(&points, 1.0, |point| point == 0 || point == links, &settings());
            let mut rig = Rig::new(on, model);
            rig.steps(&vec![Drive::default(); on.either(1200, 400)]);
            let points = first(rig.state());
            let found = points.iter().fold(0.0_f32, |low, point| low.max(-point.y)) / length;
            let error = f64::from(found) / sag(links, span) - 1.0;
            // 0.2 %: reference/README.md.
            assert!(error.abs() < 2e-3, "{links} links, span {span}: sag {found}, off by {error}");
            let stretch = off(&points, length / links as f32);
            assert!(stretch < 1e-3, "{links} links, span {span}: a segment is off by {stretch}");
        }
    }
}

/// A head that swings so far \[m\] to both sides, so often \[Hz\].
struct Swing {
    far: f32,
    often: f32,
}

/// The points of a rope of 0.4 m and 24 links that is held where `held` says, after two seconds of a
/// swing, and the largest share by which a segment was off.
fn swung(on: &On, held: &[usize], swing: &Swing) -> (Vec<Vec3>, f32) {
    const LINKS: usize = 24;
    let points = hung(Vec3::ZERO, Vec3::X * 0.25, 0.4, LINKS);
    let model = chain(&points, 1.0, |point| held.contains(&point), &settings());
    let length = points[0].distance(points[1]);
    let mut rig = Rig::new(on, model);
    let mut worst = 0.0_f32;
    for step in 1..=120 {
        let time = step as f32 / 60.0;
        let aside = Vec3::new(1.0, 0.0, 1.0).normalize() * swing.far * (TAU * swing.often * time).sin();
        let world_from_head = Pose { translation: aside, ..Pose::IDENTITY };
        rig.step(&Drive::of(world_from_head));
        let points = first(rig.state());
        worst = worst.max(off(&points, length));
    }
    (first(rig.state()), worst)
}

law! {
    fn any_pattern_of_holds_keeps_lengths(on) {
        let patterns = [&[0, 24][..], &[0, 8, 9, 20], &[12], &[24], &[0, 1, 12], &[23, 24], &[0, 1]];
        // A software adapter takes its time for each.
        for held in patterns.into_iter().take(on.either(7, 3)) {
            let (points, worst) = swung(on, held, &Swing { far: 0.05, often: 2.0 });
            assert!(worst < 1e-3, "held at {held:?}: a segment is off by {worst}");
            assert!(points.iter().all(|point| point.length() < 0.6), "held at {held:?}: {points:?}");
        }
        for held in patterns.into_iter().take(on.either(7, 2)) {
            // 20 g: Newton steps end at the limit of single precision, for any motion.
            let (_, worst) = swung(on, held, &Swing { far: 0.2, often: 5.0 });
            assert!(worst < 1e-4, "held at {held:?}, at 20 g: a segment is off by {worst}");
        }
    }
}

law! {
    fn a_rope_that_is_too_short_is_stretched_evenly(on) {
        // Its ends are 10 % farther apart than its length.
        let points = line(Vec3::ZERO, Vec3::X * 0.33, 20);
        let guides = one_strand(&points);
        let mut rest = RestShape::new(&guides, 1e-5);
        // Unequal lengths share as equal ones do: by length.
        let lengths: Vec<f32> = (0..20).map(|link| if link % 2 == 0 { 0.02 } else { 0.01 }).collect();
        for (lanes, length) in rest.stretch.iter_mut().zip(&lengths) {
            *lanes = Lanes([*length; 8]);
        }
        let held = |_, point| point == 0 || point == 20;
        let mut rig = Rig::new(on, Model::with_rest(&guides, rest, held, &settings(), Vec::new()).unwrap());
        rig.steps(&vec![Drive::default(); 120]);
        let points = first(rig.state());
        for (pair, length) in points.windows(2).zip(&lengths) {
            let stretch = pair[0].distance(pair[1]) / length - 1.0;
            // Gravity bends it a little, and 32 turns even it out to a thousandth.
            assert!((stretch - 0.1).abs() < 1e-3, "{stretch} in {points:?}");
        }
    }
}

law! {
    fn a_rope_over_a_ball_keeps_out_of_it(on) {
        let ball = Collider {
            shape: Shape::Sphere { center: Vec3::ZERO, radius: 0.05 },
            carrier: Carrier::World,
            friction: 0.0,
        };
        let points = hung(Vec3::new(-0.1, 0.02, 0.0), Vec3::new(0.1, 0.02, 0.0), 0.24, 24);
        let rope: Vec<Vec3> = points.iter().map(|point| Vec3::new(point.x, 0.04 - point.y, point.z)).collect();
        let guides = one_strand(&rope);
        let rest = RestShape::new(&guides, 1e-5);
        let held = |_, point| point == 0 || point == 24;
        let mut rig = Rig::new(on, Model::with_rest(&guides, rest, held, &settings(), vec![ball]).unwrap());
        let reports = rig.steps(&vec![Drive::default(); 240]);
        let last = reports.last().unwrap();
        assert!(last.penetration_max < 1e-3 && last.stretch_max < 1e-3, "{last:?}");
        let lowest = first(rig.state())[12].y;
        assert!((0.049..0.06).contains(&lowest), "its middle does not lie on the ball: {lowest}");
    }
}

law! {
    fn a_hand_between_two_holds_stretches_nothing(on) {
        let points = hung(Vec3::ZERO, Vec3::X * 0.2, 0.3, 24);
        let model = chain(&points, 1.0, |point| point == 0 || point == 24, &settings());
        let mut rig = Rig::new(on, model);
        let middle = points[12];
        assert_eq!(rig.grab(middle, 0.005), 1);
        for step in 1..=90 {
            // Far out of reach, and back to where it took it.
            let far = (TAU * step as f32 / 120.0).sin().max(0.0);
            let hand = middle.lerp(Vec3::new(0.3, 0.4, 0.5), far);
            let report = rig.step(&Drive { hand: Some(hand), ..Drive::default() });
            assert!(report.stretch_max < 2e-3, "step {step}: {}", report.stretch_max);
        }
        rig.steps(&vec![Drive { hand: Some(middle), ..Drive::default() }; 60]);
        let missed = first(rig.state())[12].distance(middle);
        assert!(missed < 1e-3, "the hand missed by {missed} m");
    }
}
