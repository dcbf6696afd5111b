//! Coulomb friction: paid once a step.

use glam::{Vec3, vec3};
use strandline_body::{Carrier, Collider, Shape};
use strandline_checks::{On, Rig, law};
use strandline_groom::{Groom, Guides, RestShape};
use strandline_sim::{Drive, Model, Settings};

use crate::strands::bare;

/// Speed \[m/s\] of the middle of mass along a cylinder of 5 cm, after 0.1 s of a loose strand that
/// lies across it, its halves hanging down, and slides along it at 1 m/s.
fn slid(on: &On, rounds: u32, friction: f32) -> f32 {
    let (radius, margin) = (0.05, 1e-3);
    let shape = Shape::Capsule { start: Vec3::NEG_Z, end: Vec3::Z, radius };
    let log = Collider { shape, carrier: Carrier::World, friction };
    let points = (0..=16).map(|index| {
        // Along a quarter circle, then straight down.
        let along = (index as f32 - 8.0) * 0.015;
        let reach = radius + margin;
        let turned = along.abs().min(reach * std::f32::consts::FRAC_PI_2) / reach;
        let hanging = (along.abs() - reach * turned).max(0.0);
        vec3(along.signum() * reach * turned.sin(), reach * turned.cos() - hanging, 0.0)
    });
    let mut groom = Groom::empty(8e-5);
    groom.push(points);
    let hair = Guides::resample(&groom, 17).unwrap();
    let settings = Settings { collision_margin: margin, ..bare(1.0 / 60.0, rounds) };
    let rest = RestShape::new(&hair, 6.5e-6);
    let model = Model::with_rest(&hair, rest, |_, _| false, &settings, vec![log]).unwrap();
    let masses: Vec<f32> = model.rest().mass.iter().map(|lanes| lanes.0[0]).collect();
    let mut rig = Rig::new(on, model);
    // Let it settle, then push it.
    rig.steps(&vec![Drive::default(); 30]);
    rig.change(|state| {
        for velocity in &mut state.velocities {
            (0..8).for_each(|lane| velocity.set(lane, Vec3::Z));
        }
    });
    rig.steps(&vec![Drive::default(); 6]);
    let speeds = rig.state().velocities.iter().zip(&masses).map(|(v, mass)| v.get(0).z * mass);
    speeds.sum::<f32>() / masses.iter().sum::<f32>()
}

law! {
    long fn friction_does_not_depend_on_the_number_of_rounds(on) {
        assert!((slid(on, 20, 0.0) - 1.0).abs() < 1e-3, "{}", slid(on, 20, 0.0));
        let lost = [10, 20, 80].map(|rounds| 1.0 - slid(on, rounds, 0.3));
        // 0.3 g for 0.1 s by the share of its weight that rests on the log: the sum of the cosines over the 17
        // points. In few rounds the strand stretches, so that less of it lies there.
        let expected = 0.3 * 9.81 * 0.1 * 0.39;
        for found in lost {
            assert!((found / expected - 1.0).abs() < 0.15, "{lost:?} m/s are lost, expected {expected}");
        }
    }
}
