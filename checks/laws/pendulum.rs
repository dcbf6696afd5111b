//! Swinging: one link, chains, and a rope that hangs from both ends.

use std::f32::consts::PI;

use glam::Vec3;
use strandline_checks::{On, Rig, law};
use strandline_sim::constrain::LengthPass;
use strandline_sim::{Drive, Settings};

use crate::strands::{bare, chain, first, line};

const GRAVITY: f32 = 9.81;

/// A stiff rod of `length` that swings about the origin: four points, of which only the two ends
/// of the last segment matter; the first three are held one above the other.
fn rod(amplitude: f32, length: f32) -> Vec<Vec3> {
    let up = |share: f32| Vec3::new(0.0, length * share, 0.0);
    let tip = Vec3::new(length * amplitude.sin(), -length * amplitude.cos(), 0.0);
    vec![up(2.0), up(1.0), Vec3::ZERO, tip]
}

/// Period \[s\] of a pendulum: four times the fall from rest to the first passage through the lowest
/// point. Projection loses amplitude from step to step, and with it the period would change later.
fn period(
    on: &On,
    amplitude: f32,
    length: f32,
    time_step: f32,
    settings: impl Fn(Settings) -> Settings,
) -> f32 {
    let model = chain(&rod(amplitude, length), 1.0, |point| point < 3, &settings(bare(time_step, 4)));
    let mut rig = Rig::new(on, model);
    let mut before = first(rig.state())[3].x;
    for step in 0..100_000 {
        rig.step(&Drive::default());
        let now = first(rig.state())[3].x;
        if now <= 0.0 {
            // Steps are counted from the release.
            return 4.0 * time_step * (step as f32 + before / (before - now));
        }
        before = now;
    }
    panic!("the pendulum does not swing");
}

/// Period over 2 pi sqrt(l / g) by amplitude \[deg\]: reference/pendulum_period.csv.
const PERIODS: [(f32, f32); 5] =
    [(5.0, 1.000_476_2), (10.0, 1.001_907_2), (30.0, 1.017_408_8), (60.0, 1.073_182), (90.0, 1.180_340_6)];

fn period_error(on: &On, degrees: f32, expected: f32, steps_per_period: f32) -> f32 {
    let length = 0.25;
    let small = 2.0 * PI * (length / GRAVITY).sqrt();
    let found = period(on, degrees.to_radians(), length, expected * small / steps_per_period, |s| s);
    (found / small / expected - 1.0).abs()
}

law! {
    fn a_pendulum_keeps_its_period(on) {
        for (degrees, expected) in PERIODS {
            let error = period_error(on, degrees, expected, 500.0);
            // 1 %: reference/README.md; projection loses some energy in every step.
            assert!(error < 0.01, "{degrees} degrees: off by {error}");
        }
    }
}

law! {
    fn the_period_of_a_pendulum_converges(on) {
        let errors = [125.0, 250.0, 500.0].map(|steps| period_error(on, 60.0, 1.073_182, steps));
        // Projection is of first order in the step: half the step, half the error, within a fifth.
        for pair in errors.windows(2) {
            let ratio = pair[0] / pair[1];
            assert!((1.6..2.5).contains(&ratio), "errors {errors:?}");
        }
    }
}

law! {
    fn a_pendulum_in_weaker_gravity_is_distinguished(on) {
        let length = 0.25;
        let small = 2.0 * PI * (length / GRAVITY).sqrt();
        let weaker = |settings: Settings| Settings { gravity: settings.gravity * 0.97, ..settings };
        let found = period(on, 0.1, length, small / 500.0, weaker);
        assert!((found / small / 1.001_5 - 1.0).abs() > 0.01);
    }
}

/// Angular frequencies of a hanging chain over sqrt(g / L): reference/hanging_chain_modes.json,
/// N8_tip_full and N16_tip_half, the first three.
const CHAIN_8_FULL: [f32; 3] = [1.167_149_1, 2.688_794_2, 4.243_665];
const CHAIN_16_HALF: [f32; 3] = [1.201_023_2, 2.718_7, 4.089_476];

/// Relative error of the frequency of a mode of a chain that starts in the shape of the mode.
fn mode_error(on: &On, links: usize, tip_mass: f32, expected: f32) -> f32 {
    let length = 0.3;
    // 120 steps in a period: in shorter ones the fall, g dt^2, drowns in the rounding of positions.
    let settings = bare(2.0 * PI / (120.0 * expected * (GRAVITY / length).sqrt()), 200);
    let shape = mode_shape(links, expected);
    let rest = line(Vec3::ZERO, Vec3::NEG_Y * length, links);
    let model = chain(&rest, tip_mass, |point| point == 0, &settings);
    let mut rig = Rig::new(on, model);
    let link = length / links as f32;
    rig.change(|state| {
        for point in 1..=links {
            let before = state.positions[point - 1].get(0);
            let aside = (shape[point] - shape[point - 1]) * link;
            let down = (link * link - aside * aside).sqrt();
            state.positions[point].set(0, before + Vec3::new(aside, -down, 0.0));
        }
    });
    let amount = |state: &strandline_sim::State| {
        first(state).iter().zip(&shape).map(|(point, shape)| point.x * shape).sum::<f32>()
    };
    let mut crossings = Vec::new();
    let mut before = amount(rig.state());
    let mut time = 0.0_f64;
    while crossings.len() < 3 {
        rig.step(&Drive::default());
        let now = amount(rig.state());
        if before.signum() != now.signum() {
            crossings.push(time + f64::from(settings.time_step * before / (before - now)));
        }
        before = now;
        time += f64::from(settings.time_step);
        assert!(time < 20.0, "the chain does not swing");
    }
    let omega = 2.0 * f64::from(PI) / (crossings[2] - crossings[0]);
    (omega / f64::from(expected * (GRAVITY / length).sqrt()) - 1.0).abs() as f32
}

/// The shape of a mode of a chain of unit masses, small: from the tip up, the tension of each link
/// carries what hangs below and its sideways part accelerates it. Independent of the tip's mass
/// beyond its first link, so only the frequency is copied.
fn mode_shape(links: usize, frequency: f32) -> Vec<f32> {
    let tip_mass = if links == 8 { 1.0 } else { 0.5 };
    let square = frequency * frequency / links as f32;
    let mut shape = vec![0.0; links + 1];
    shape[links] = 1.0;
    let (mut weight, mut moment) = (0.0, 0.0);
    for point in (1..=links).rev() {
        let mass = if point == links { tip_mass } else { 1.0 };
        weight += mass;
        moment += mass * shape[point];
        shape[point - 1] = shape[point] - square * moment / weight;
    }
    let largest = shape.iter().fold(0.0_f32, |most, x| most.max(x.abs()));
    shape.iter().map(|x| 0.05 * (x - shape[0]) / largest).collect()
}

law! {
    fn a_hanging_chain_swings_in_its_modes(on) {
        for (mode, expected) in CHAIN_8_FULL.into_iter().enumerate() {
            let error = mode_error(on, 8, 1.0, expected);
            // 1 %: reference/README.md.
            assert!(error < 0.01, "8 links, mode {mode}: off by {error}");
        }
        for (mode, expected) in CHAIN_16_HALF.into_iter().enumerate() {
            let error = mode_error(on, 16, 0.5, expected);
            assert!(error < 0.01, "16 links, mode {mode}: off by {error}");
        }
        let wrong = mode_error(on, 8, 0.5, CHAIN_8_FULL[0]);
        assert!(wrong > 0.01, "a tip of the wrong mass is not noticed: {wrong}");
    }
}

/// Relative error of the sag of a rope of 16 links whose ends are `span` rope lengths apart, hung
/// from a shape of the right length.
fn sag_error(on: &On, span: f32, sag: f32, settings: &Settings) -> f32 {
    let rise = (0.25 - 0.25 * span * span).sqrt();
    let low = Vec3::new(0.5 * span, -rise, 0.0);
    let mut points = line(Vec3::ZERO, low, 8);
    points.extend(&line(low, Vec3::X * span, 8)[1..]);
    let model = chain(&points, 1.0, |point| point == 0 || point == 16, settings);
    let mut rig = Rig::new(on, model);
    // It hangs still after a few seconds.
    rig.steps(&vec![Drive::default(); (on.either(20.0, 4.0) / settings.time_step) as usize]);
    let lowest = first(rig.state()).iter().fold(0.0_f32, |low, point| low.max(-point.y));
    (lowest / sag - 1.0).abs()
}

/// Sag over length of 16 links by span over length: reference/catenary.csv.
const SAGS: [(f32, f32); 4] = [(0.4, 0.429_992_3), (0.6, 0.363_835_1), (0.8, 0.265_991_5), (0.9, 0.191_079)];

law! {
    long fn a_rope_held_at_both_ends_hangs_in_a_catenary(on) {
        let settings = Settings { damping: 4.0, ..bare(1.0 / 600.0, 200) };
        // A software adapter takes its time: the first and the last.
        for (span, sag) in SAGS.into_iter().step_by(on.either(1, 3)) {
            let error = sag_error(on, span, sag, &settings);
            // 0.2 %: reference/README.md for lengths that are exact, as 200 rounds at 1/600 s make them.
            assert!(error < 0.002, "span {span}: off by {error}");
        }
        let loose = Settings { damping: 4.0, ..bare(1.0 / 60.0, 20) };
        let stretched = sag_error(on, 0.4, SAGS[0].1, &loose);
        assert!(stretched > 0.002, "a rope that stretches is not noticed: {stretched}");
    }
}

law! {
    fn the_length_pass_keeps_the_period_of_a_pendulum(on) {
        let length = 0.25;
        let small = 2.0 * PI * (length / GRAVITY).sqrt();
        let exact = |settings: Settings| settings.with_constrain(|constrain| constrain.length_pass = LengthPass::default());
        let found = period(on, 0.1, length, small / 500.0, exact);
        assert!((found / small / 1.000_6 - 1.0).abs() < 0.01, "{}", found / small);
    }
}
