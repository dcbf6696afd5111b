//! Masses and first velocities of points, as a groom has them.

use glam::{Quat, Vec3};
use strandline_body::Pose;
use strandline_checks::{On, Rig, law};
use strandline_groom::{Groom, Guides, RestShape, Vec3Lanes};
use strandline_sim::constrain::{Angles, Springs};
use strandline_sim::{Drive, Model, Settings};

use crate::strands::{bare, first};

const POINTS: usize = 10;

fn mass(point: usize) -> f32 {
    1e-6 * (1.0 + (point % 3) as f32)
}

fn velocity(point: usize) -> Vec3 {
    Vec3::new(0.3 * (point as f32).sin(), 0.2, 0.4 * (point as f32 * 2.0).cos())
}

/// A strand with masses and velocities of its own.
fn guides() -> Guides {
    let mut groom = Groom::empty(8e-5);
    groom.push((0..POINTS).map(|point| Vec3::NEG_Y * 0.02 * point as f32));
    groom.masses = Some((0..POINTS).map(mass).collect());
    groom.velocities = Some((0..POINTS).map(velocity).collect());
    Guides::resample(&groom, POINTS).unwrap()
}

fn settings() -> Settings {
    Settings { gravity: Vec3::ZERO, ..bare(1.0 / 60.0, 20) }
}

/// Momentum over mass \[m/s\], with masses \[kg\].
fn mean_velocity(rig: &mut Rig, mass: fn(usize) -> f32) -> Vec3 {
    let momentum = |(point, velocity): (usize, &Vec3Lanes)| velocity.get(0) * mass(point);
    let momentum: Vec3 = rig.state().velocities.iter().enumerate().map(momentum).sum();
    momentum / (0..POINTS).map(mass).sum::<f32>()
}

/// Change of a loose strand's mean velocity, with its own masses and with even ones.
fn drift(on: &On) -> [f32; 2] {
    let guides = guides();
    let settings = settings().with_constrain(|constrain| {
        constrain.springs = Springs::default();
        constrain.angles = Angles::default();
    });
    let rest = RestShape::new(&guides, settings.strands.constrain.mass_per_length);
    let mut model = Model::with_rest(&guides, rest, |_, _| false, &settings, Vec::new()).unwrap();
    // A mass per length is for hair that has no masses.
    model.set_settings(&settings.with_constrain(|constrain| constrain.mass_per_length = 1e-3)).unwrap();
    assert!((model.rest().mass[4].0[0] / mass(4) - 1.0).abs() < 1e-5);
    let mut rig = Rig::new(on, model);
    let kinds: [fn(usize) -> f32; 2] = [mass, |_| 1.0];
    let start = kinds.map(|mass| mean_velocity(&mut rig, mass));
    rig.steps(&vec![Drive::default(); 30]);
    let end = kinds.map(|mass| mean_velocity(&mut rig, mass));
    [0, 1].map(|kind| (end[kind] - start[kind]).length() / start[kind].length())
}

law! {
    fn points_move_by_the_masses_that_they_have(on) {
        let [own, even] = drift(on);
        // Velocities are differences of rounded positions: 2e-8 m * 60 / 0.3 m/s, summed over 30 steps.
        assert!(own < 3e-4, "{own}");
        assert!(even > 1e-2, "even masses are not distinguished: {even}");
    }
}

law! {
    fn hair_begins_with_the_velocities_that_it_has(on) {
        let settings = settings().with_constrain(|constrain| constrain.iterations = 1);
        let model = Model::new(&guides(), &settings, Vec::new()).unwrap();
        let mut rig = Rig::new(on, model.clone());
        let turned = Pose { rotation: Quat::from_rotation_y(1.0), ..Pose::IDENTITY };
        rig.change(|state| *state = model.rest_state(turned));
        let before = first(rig.state());
        let expected = |point: usize| if point < 2 { Vec3::ZERO } else { turned.rotation * velocity(point) };
        for point in 0..POINTS {
            let found = rig.state().velocities[point].get(0);
            assert!((found - expected(point)).length() < 1e-4, "point {point}: {found}");
        }
        rig.step(&Drive::of(turned));
        // Far along the strand lengths hold its points, but not across it.
        let moved = first(rig.state())[5] - before[5];
        let expected = expected(5) / 60.0;
        assert!((moved - expected).with_y(0.0).length() < 0.3 * expected.length(), "{moved}, {expected}");
        assert!(expected.length() > 1e-3);
    }
}
