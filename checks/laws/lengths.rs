//! Lengths are kept by moving points, without adding motion to the hair.

use std::f32::consts::TAU;

use glam::Vec3;
use strandline_body::Pose;
use strandline_checks::{On, Rig, law};
use strandline_groom::LANES;
use strandline_sim::{Drive, Model, Settings, State, VolumeSettings};

use crate::strands::{ball_of_hair, skull};

/// The hair that the volume moved: points of a strand, their length \[m\].
const HAIR: [(usize, f32); 2] = [(12, 0.3), (16, 0.5)];

fn head(on: &On, strands: usize, hair: (usize, f32), settings: &Settings, volume: bool) -> Rig {
    let settings = Settings {
        volume: VolumeSettings { enabled: volume, ..VolumeSettings::default() },
        ..settings.clone()
    };
    let guides = ball_of_hair(strands, hair.0, hair.1);
    Rig::new(on, Model::new(&guides, &settings, vec![skull(0.3)]).unwrap())
}

/// Largest difference \[m/s\] of a stored velocity and the way of its point in the last step, and the
/// largest stored velocity.
fn motion(state: &State, time_step: f32) -> (f32, f32) {
    let (mut apart, mut fastest) = (0.0_f32, 0.0_f32);
    let places = state.positions.iter().zip(&state.previous_positions);
    for (velocity, (now, before)) in state.velocities.iter().zip(places) {
        for lane in 0..LANES {
            let way = (now.get(lane) - before.get(lane)) / time_step;
            apart = apart.max(velocity.get(lane).distance(way));
            fastest = fastest.max(velocity.get(lane).length());
        }
    }
    (apart, fastest)
}

law! {
    fn stored_velocities_are_the_motion(on) {
        // Of rods that are solved in parts it is the motion in the last of them.
        let mut rods = Settings::default();
        rods.strands.rods.substeps = 1;
        // Rods rest from the first step on.
        let ways = [(Settings::constrained(), 600), (rods, 60)];
        for (hair, (settings, steps)) in HAIR.into_iter().flat_map(|hair| ways.iter().map(move |way| (hair, way))) {
            let mut rig = head(on, 16, hair, settings, false);
            rig.steps(&vec![Drive::default(); *steps]);
            let (apart, fastest) = motion(rig.state(), 1.0 / 60.0);
            // Positions of half a metre are rounded to 6e-8 m, in 1/60 s.
            assert!(apart < 2e-5, "{hair:?} at rest: {apart} m/s");
            // 2 mm/s moves a point by a pixel in a second where a head fills the picture.
            assert!(fastest < 2e-3, "{hair:?} at rest: {fastest} m/s");
            let mut swung = 0.0_f32;
            for step in 1..=30 {
                let aside = Vec3::X * 0.05 * (TAU * 2.0 * step as f32 / 60.0).sin();
                let world_from_head = Pose { translation: aside, ..Pose::IDENTITY };
                rig.step(&Drive::of(world_from_head));
                let (apart, fastest) = motion(rig.state(), 1.0 / 60.0);
                assert!(apart < 2e-5, "{hair:?}, shaken: {apart} m/s in step {step}");
                swung = swung.max(fastest);
            }
            assert!(swung > 0.5, "nothing moved: {swung} m/s");
        }
    }
}

/// Distance \[m\] of the points of two states: root mean square, that of the tips, the largest.
fn apart(one: &State, other: &State, points: usize) -> [f32; 3] {
    let (mut all, mut tips, mut largest) = (0.0, 0.0, 0.0_f32);
    for (index, (one, other)) in one.positions.iter().zip(&other.positions).enumerate() {
        for lane in 0..LANES {
            let square = one.get(lane).distance_squared(other.get(lane));
            all += square;
            tips += if index % points == points - 1 { square } else { 0.0 };
            largest = largest.max(square);
        }
    }
    let count = (one.positions.len() * LANES) as f32;
    [all / count, tips * points as f32 / count, largest].map(f32::sqrt)
}

law! {
    long fn the_volume_does_not_move_resting_hair(on) {
        for hair in HAIR.into_iter().take(on.either(2, 1)) {
            let [mut with, mut without] = [true, false].map(|volume| head(on, 64, hair, &Settings::constrained(), volume));
            without.steps(&vec![Drive::default(); 900]);
            let rest = without.state().clone();
            with.change(|state| {
                state.positions.clone_from(&rest.positions);
                state.previous_positions.clone_from(&rest.previous_positions);
                state.velocities.clone_from(&rest.velocities);
                state.corrections.clone_from(&rest.corrections);
            });
            for rig in [&mut with, &mut without] {
                rig.steps(&vec![Drive::default(); on.either(600, 120)]);
            }
            let found = apart(with.state(), without.state(), hair.0);
            // A tenth of a pixel is 0.1 mm where a head fills the picture.
            assert!(found.iter().all(|way| *way < 1e-4), "{hair:?}: rms, tips, largest {found:?} m");
        }
    }
}
