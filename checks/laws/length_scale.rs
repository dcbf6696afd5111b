//! Strands that are cut or grow while they move [Chen2011 fig. 45].

use glam::{Vec3, vec3};
use strandline_checks::{On, Rig, law};
use strandline_groom::RestShape;
use strandline_sim::constrain::{Angles, Springs};
use strandline_sim::{Drive, Model, Settings, StrandMethod};

use crate::strands::{bare, first, line, one_strand};

const POINTS: usize = 12;

/// A loose strand in steps, scaled.
fn loose(on: &On, scale: f32) -> Rig {
    let zigzag =
        |index: usize| Vec3::new(0.01 * (index % 2) as f32, -0.02 * index as f32, 0.002 * index as f32);
    let guides = one_strand(&(0..POINTS).map(zigzag).collect::<Vec<_>>());
    let rest = RestShape::new(&guides, 6.5e-6);
    let within = bare(1.0 / 60.0, 20).with_constrain(|constrain| {
        constrain.springs = Springs::default();
        constrain.angles = Angles::default();
    });
    let settings = Settings { gravity: Vec3::ZERO, ..within };
    let model = Model::with_rest(&guides, rest, |_, _| false, &settings, Vec::new()).unwrap();
    let mut rig = Rig::new(on, model.clone());
    rig.change(|state| state.set_length_scale(&model, &[scale]).unwrap());
    rig
}

/// Momentum over mass \[m/s\], with masses \[m\].
fn mean_velocity(rig: &mut Rig, masses: &[f32]) -> Vec3 {
    let momentum = |(velocity, mass): (&strandline_groom::Vec3Lanes, &f32)| velocity.get(0) * *mass;
    rig.state().velocities.iter().zip(masses).map(momentum).sum::<Vec3>() / masses.iter().sum::<f32>()
}

/// Change of the velocity of a kicked strand's middle, with masses that follow the length and with those at
/// rest.
fn drift(on: &On, scale: f32) -> [f32; 2] {
    let mut rig = loose(on, scale);
    let points = first(rig.state());
    let length = |lower: usize| points.get(lower + 1).map_or(0.0, |next| next.distance(points[lower]));
    let before = |point: usize| if point > 0 { length(point - 1) } else { 0.0 };
    let scaled: Vec<f32> = (0..POINTS).map(|point| before(point) + length(point)).collect();
    let even: Vec<f32> = (0..POINTS).map(|point| if point % (POINTS - 1) == 0 { 0.5 } else { 1.0 }).collect();
    rig.change(|state| {
        for (index, velocity) in state.velocities.iter_mut().enumerate() {
            velocity.set(0, Vec3::new(0.3 * (index as f32).sin(), 0.2, 0.4 * (index as f32 * 2.0).cos()));
        }
    });
    let start = [&scaled, &even].map(|masses| mean_velocity(&mut rig, masses));
    rig.steps(&vec![Drive::default(); 30]);
    let end = [&scaled, &even].map(|masses| mean_velocity(&mut rig, masses));
    [0, 1].map(|which| (end[which] - start[which]).length() / start[which].length())
}

law! {
    fn the_mass_of_a_strand_follows_its_length(on) {
        for scale in [0.5, 1.8] {
            let [scaled, even] = drift(on, scale);
            // Velocities are differences of rounded positions, as for a strand of its own length.
            assert!(scaled < 3e-4, "{scale}: {scaled}");
            assert!(even > 1e-2, "{scale}: masses at rest are not distinguished, {even}");
        }
    }
}

law! {
    long fn a_strand_hangs_as_far_down_as_it_is_long(on) {
        // A software adapter has the shortest and the longest.
        for scale in [0.3, 1.0, 2.0].into_iter().step_by(on.either(1, 2)) {
            let guides = one_strand(&line(Vec3::ZERO, Vec3::NEG_Y * 0.2, POINTS - 1));
            for settings in [Settings::default(), Settings::constrained()] {
                let model = Model::new(&guides, &settings, Vec::new()).unwrap();
                let mut rig = Rig::new(on, model.clone());
                rig.change(|state| state.set_length_scale(&model, &[scale]).unwrap());
                rig.steps(&vec![Drive::default(); 60]);
                let points = first(rig.state());
                let (tip, along) = (points[POINTS - 1], points.windows(2).map(|pair| pair[0].distance(pair[1])));
                // The length pass is exact but for rounding.
                let method = settings.strands.method;
                assert!((along.sum::<f32>() - 0.2 * scale).abs() < 1e-5, "{method:?}, {scale}: {points:?}");
                // A strand that is thrown out to twice its length swings as far as rounding lets it: not at all where the
                // numbers aside are zeros, 7 mm of 400 on an H200.
                assert!((tip.y + 0.2 * scale).abs() < on.exact_or(1e-5, 2e-3), "{method:?}, {scale}: {tip}");
            }
        }
    }
}

law! {
    fn what_is_left_of_a_rod_keeps_its_shape(on) {
        // An arc that reaches out and hangs, ten times as heavy as its stiffness would hold level.
        let (count, length) = (32_u16, 0.1_f32);
        let mut settings = bare(1.0 / 60.0, 1);
        settings.strands.method = StrandMethod::Rods;
        settings.damping = 20.0;
        let rod = &mut settings.strands.rods;
        rod.rubbing = 0.0;
        let radius = rod.radius * 1e-6;
        rod.youngs_modulus = 4.0 * rod.density * 9.81 * length.powi(3) / (10.0 * radius * radius) * 1e-9;
        let points: Vec<Vec3> = (0..=count)
            .map(|point| {
                let angle = 1.6 * (f32::from(point) - 1.0) / f32::from(count);
                vec3(angle.sin(), angle.cos() - 1.0, 0.2 * angle * angle) * (length / 1.6)
            })
            .collect();
        let guides = one_strand(&points);
        let rest = RestShape::new(&guides, settings.line_density());
        let model = Model::with_rest(&guides, rest, |_, point| point < 2, &settings, Vec::new()).unwrap();
        for scale in [0.6, 1.4] {
            let mut rig = Rig::new(on, model.clone());
            let before = first(rig.state());
            rig.change(|state| state.set_length_scale(&model, &[scale]).unwrap());
            rig.steps(&vec![Drive::default(); 240]);
            let after = first(rig.state());
            // The segments of the first half keep their lengths. In single precision the weight of what is left
            // is carried to 1e-4 of the length; with that of what is gone the half's end moves by 0.22 of it.
            let apart = before[16].distance(after[16]) / length;
            assert!(apart < 2e-3, "{apart} lengths from where it was at {scale} times its length");
        }
    }
}
