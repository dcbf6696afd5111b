//! Loads at which rods give way.

use glam::Vec3;
use strandline_checks::{On, Rig, law};
use strandline_sim::rods::Rest;
use strandline_sim::{Drive, Settings};

use crate::rod_mechanics::{model, rods};
use crate::strands::{line, one_strand};

/// Length \[m\] of the rods that free segments make, and their number.
const LENGTH: f32 = 0.1;
const COUNT: usize = 32;

/// Rods without moments at first, in air that takes the swing.
fn straight() -> Settings {
    let mut settings = Settings { damping: 2.0, ..rods(1.0 / 60.0) };
    settings.strands.rods.rest = Rest::Unstressed;
    settings
}

/// Distance \[lengths\] of a straight rod from its line, five seconds after a push of 0.03 m/s across it at
/// its tip.
fn aside(on: &On, along: Vec3, across: Vec3, settings: &Settings) -> f32 {
    let points = line(along * (-LENGTH / COUNT as f32), along * LENGTH, COUNT + 1);
    let mut rig = Rig::new(on, model(&one_strand(&points), settings, |point| point < 2, Vec::new()));
    rig.change(|state| {
        for point in 2..COUNT + 2 {
            let share = (point as f32 - 1.0) / COUNT as f32;
            state.velocities[point].set(0, across * (0.03 * share * share));
        }
    });
    rig.steps(&vec![Drive::default(); 300]);
    rig.state().positions.iter().map(|lanes| lanes.get(0).dot(across).abs()).fold(0.0, f32::max) / LENGTH
}

/// Says that a rod comes back to its line at 3 % less than a critical load and gives way at 3 % more.
fn gives_way_at(critical: f32, aside: impl Fn(f32) -> f32) {
    // Found at 0.985: 0.005 and 0.0002; at 1.015: 0.26 and 0.057; at 1.03: 0.36 and 0.16.
    let below = aside(0.97 * critical);
    assert!(below < 0.01, "{below} lengths aside below the critical load");
    let above = aside(1.03 * critical);
    assert!(above > 0.05, "{above} lengths aside above the critical load");
}

law! {
    fn an_upright_rod_buckles_under_its_weight(on) {
        // Greenhill: w L^3 / B = 7.8373; the bound of the law.
        gives_way_at(7.8373, |gamma| {
            let mut settings = straight();
            let rod = &mut settings.strands.rods;
            // E I = w L^3 / gamma, with w = rho A g and I = A r^2 / 4.
            let radius = rod.radius * 1e-6;
            rod.youngs_modulus = 4.0 * rod.density * 9.81 * LENGTH.powi(3) / (gamma * radius * radius) * 1e-9;
            aside(on, Vec3::Y, Vec3::X, &settings)
        });
    }
}

law! {
    fn a_ribbon_on_edge_buckles_aside(on) {
        // reference/lateral_buckling.json: w L^3 / sqrt(B1 C) of a ribbon that bends aside only; the bound of the law.
        // This one bends a hundredth as easily downwards, with which the load is 1.01 of it.
        gives_way_at(12.853_765, |load| {
            let mut settings = straight();
            let rod = &mut settings.strands.rods;
            (rod.radius, rod.ellipticity) = (200.0, 0.1);
            let (wide, narrow) = (2e-4_f32, 2e-5_f32);
            // B1 = E A b^2 / 4 and C = G A a^2 b^2 / (a^2 + b^2), both w L^3 / load.
            let per_area = rod.density * 9.81 * LENGTH.powi(3) / load;
            rod.youngs_modulus = 4.0 * per_area / (narrow * narrow) * 1e-9;
            let squares = wide * wide + narrow * narrow;
            rod.shear_modulus = Some(per_area * squares / (wide * narrow).powi(2) * 1e-9);
            aside(on, Vec3::X, Vec3::Z, &settings)
        });
    }
}
