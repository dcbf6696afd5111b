//! Rods that swing: torsion, long hair that is let go, and hair shaken at three g.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::{Vec3, vec3};
use strandline_body::Pose;
use strandline_checks::{Rig, law};
use strandline_sim::{Drive, MOST_SPIN, Model, Settings, State, VolumeSettings};

use crate::rod_mechanics::{model, rods};
use crate::strands::{first, line, one_strand};

/// Angle \[rad\] by which the section of a segment has turned about the x axis.
fn turned(rest: &State, now: &State, segment: usize) -> f32 {
    let (before, after) = (rest.sections[segment].get(0), now.sections[segment].get(0));
    before.cross(after).x.atan2(before.dot(after))
}

law! {
    long fn a_shaft_twists_at_its_frequency(on) {
        let (length, count) = (0.1_f32, 32);
        let mut settings = Settings { gravity: Vec3::ZERO, ..rods(1e-3) };
        let material = &mut settings.strands.rods;
        (material.damping, material.substeps) = (0.0, 1);
        // Softer than gel and as heavy as gold, so that twists run at 7 m/s and a 200th of a period is 0.3 ms.
        (material.shear_modulus, material.density) = (Some(1e-3), 20_000.0);
        // reference/beam_modes.json: pi / (2 L) sqrt(G J / (rho I)), of a round section that of sqrt(G / rho).
        let rate = FRAC_PI_2 / length * (1e6 / material.density).sqrt();
        settings.time_step = TAU / rate / 200.0;
        let points = line(Vec3::NEG_X * (length / count as f32), Vec3::X * length, count + 1);
        let mut rig = Rig::new(on, model(&one_strand(&points), &settings, |point| point < 2, Vec::new()));
        let rest = rig.state().clone();
        rig.change(|state| {
            for segment in 1..=count {
                let along = (segment as f32 - 0.5) / count as f32;
                state.spins[segment].0[0] = 0.3 * rate * (FRAC_PI_2 * along).sin();
            }
        });
        // The times at which the tip turns back through its rest, in steps.
        let (mut crossings, mut before) = (Vec::new(), 0.0);
        for step in 1..=on.either(850, 450) {
            rig.step(&Drive::default());
            let now = turned(&rest, rig.state(), count);
            if before < 0.0 && now >= 0.0 {
                crossings.push(step as f32 - now / (now - before));
            }
            before = now;
        }
        assert!(crossings.len() > 1, "it does not swing");
        let period = (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f32;
        // The bound of the law. Found: 1.0004 on both, the error of implicit Euler (1 + (2 pi / 200)^2 / 3).
        assert!((period / 200.0 - 1.0).abs() < 0.02, "{} of its period", period / 200.0);
        // It moved its sections only.
        let aside = first(rig.state()).iter().zip(first(&rest)).map(|(now, rest)| now.distance(rest)).fold(0.0, f32::max);
        assert!(aside < 1e-6, "{aside} m aside");
    }
}

law! {
    fn no_section_spins_faster_than_a_file_holds(on) {
        let mut settings = Settings { gravity: Vec3::ZERO, ..rods(1e-3) };
        let material = &mut settings.strands.rods;
        // As soft and heavy as the shaft above: the spin goes on.
        (material.damping, material.substeps) = (0.0, 1);
        (material.shear_modulus, material.density) = (Some(1e-3), 20_000.0);
        settings.time_step = 1e-5;
        let points = line(Vec3::NEG_X * 0.003, Vec3::X * 0.1, 33);
        let mut rig = Rig::new(on, model(&one_strand(&points), &settings, |point| point < 2, Vec::new()));
        let fastest = |state: &State| state.spins.iter().map(|lanes| lanes.0[0].abs()).fold(0.0, f32::max);
        rig.change(|state| (8..33).for_each(|segment| state.spins[segment].0[0] = 50.0 * MOST_SPIN));
        let report = rig.step(&Drive::default());
        assert_eq!((report.non_finite, fastest(rig.state())), (0, MOST_SPIN));
        // A tenth of the stiffness holds back too little.
        rig.change(|state| (8..33).for_each(|segment| state.spins[segment].0[0] = 0.1 * MOST_SPIN));
        rig.step(&Drive::default());
        let now = fastest(rig.state());
        assert!((0.05..0.11).contains(&(now / MOST_SPIN)), "{now}");
    }
}

/// Long hair of the default material that hangs from a head at rest, without a volume: a guide of a head stands for
/// fifty hairs. A hair alone creeps back through the air.
pub fn hanging(time_step: f32) -> Model {
    let mut settings = Settings { time_step, ..Settings::default() };
    settings.volume = VolumeSettings { enabled: false, ..settings.volume };
    settings.drag.hairs = Some(50.0);
    Model::new(&one_strand(&line(Vec3::ZERO, Vec3::NEG_Y * LENGTH, TIP)), &settings, Vec::new()).unwrap()
}

/// Length \[m\] of long hair, and its last point.
pub const LENGTH: f32 = 0.35;
pub const TIP: usize = 27;

law! {
    fn long_hair_that_is_let_go_swings_a_few_times_and_stops(on) {
        for rate in [60.0, 240.0].into_iter().take(on.either(2, 1)) {
            let mut rig = Rig::new(on, hanging(1.0 / rate));
            let tip = first(rig.state())[TIP];
            assert_eq!(rig.grab(tip, 1e-3), 1);
            // Drawn aside by 36 degrees in a second, held for half of one.
            let aside = vec3(0.2, -0.27, 0.0);
            let pull = |step: usize| {
                let hand = tip.lerp(aside, (step as f32 / rate).min(1.0));
                Drive { hand: Some(hand), ..Drive::default() }
            };
            rig.steps(&(1..=(1.5 * rate) as usize).map(pull).collect::<Vec<_>>());
            rig.change(State::release);
            let (mut passages, mut before) = (0, 1.0);
            let mut rests = false;
            for _ in 0..(6.0 * rate) as usize {
                rests = rig.step(&Drive::default()).rods.unwrap().resting == 1;
                let now = first(rig.state())[TIP].x;
                passages += usize::from(now * before < 0.0);
                before = now;
            }
            // A swing passes its rest twice.
            assert!((4..=10).contains(&passages), "1/{rate} s: {passages} passages");
            assert!(rests, "1/{rate} s: not still after 6 s");
            assert!(before.abs() < 2e-3 * LENGTH, "1/{rate} s: {before} m beside its rest");
        }
    }
}

law! {
    fn hair_shaken_at_three_g_keeps_its_lengths(on) {
        for hertz in [1.0, 2.0, 5.0] {
            let (rate, mut rig) = (TAU * hertz, Rig::new(on, hanging(1.0 / 60.0)));
            let reach = 3.0 * 9.81 / (rate * rate);
            let drive = |step: usize| {
                let translation = Vec3::X * (reach * (rate * step as f32 / 60.0).sin());
                Drive::of(Pose { translation, ..Pose::default() })
            };
            let mut whip = 0.0_f32;
            for report in rig.steps(&(1..=on.either(600, 120)).map(drive).collect::<Vec<_>>()) {
                assert_eq!(report.non_finite, 0);
                // The bounds of the law. Found: 3e-6, the rounding of segments of 13 mm.
                let (mean, most) = (report.stretch_mean.abs(), report.stretch_max);
                assert!(mean < 1e-3 && most < 1e-2, "{hertz} Hz: {mean}, at most {most}");
                whip = whip.max(report.speed_max);
            }
            assert!(whip > 3.0 * 9.81 / rate, "it hardly moves: {whip} m/s");
        }
    }
}
