//! The air among hair.

use glam::Vec3;
use strandline_checks::gpu;
use strandline_sim::cpu::shelter::{Shelter, shelter};
use strandline_sim::{Currents, Drive, Eddy, Source, Stage};

use crate::heads::{apart, drive, mean_apart, obstacles, rods};

/// Waves and sources of both kinds.
fn currents() -> Currents {
    let eddy = Eddy { wave: Vec3::new(20.0, 3.0, -30.0), phase: 0.7, velocity: Vec3::Y * 0.2 };
    let source = Source { place: Vec3::new(0.0, 0.3, 0.0), direction: Vec3::ZERO, speed: 2.0, radius: 0.02 };
    let fan = Source { place: Vec3::new(0.5, 0.0, 0.1), direction: Vec3::NEG_X, ..source };
    Currents { eddies: vec![eddy], sources: vec![source, fan] }
}

#[test]
fn shelter_agrees() {
    let Some(gpu) = gpu() else { return };
    for mut head in rods() {
        // Wisps that hold back most of the wind.
        head.settings.drag.factor = 1.0;
        head.settings.drag.hairs = Some(50.0);
        let model = head.model();
        let state = head.moving(&model);
        let wind = drive(6).wind;
        let drive = Drive { currents: currents(), ..drive(6) };
        let mut expected = Shelter::default();
        shelter(&model, &state, &obstacles(&model, &state), &drive, &mut expected);
        let mut probe = state.probe(&head.gpu_runner(&gpu));
        probe.run(&drive, &[Stage::Shelter]).unwrap();
        let found = probe.air().unwrap();
        // By rounding a point or two lie in the cell beside theirs, and the middle of a cell beside a solid in it.
        let distance = apart(&found, &expected.air, &head.guides);
        assert!(distance < 0.05, "{}: {distance} m/s", head.name);
        let mean = mean_apart(&found, &expected.air, &head.guides);
        // Velocities of solids are ways in a step, rounded to 10 nm.
        let rounded = 1e-8 / head.settings.time_step;
        assert!(mean < rounded.max(1e-4), "{}: {mean} m/s", head.name);
        let slowed = found.iter().any(|air| (air.get(0) - wind).length() > 0.01);
        assert!(slowed, "{}: nothing is sheltered", head.name);
    }
}
