//! The air among hair.

use strandline_checks::gpu;
use strandline_sim::Stage;
use strandline_sim::cpu::shelter::{Shelter, shelter};

use crate::heads::{apart, drive, mean_apart, obstacles, rods};

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
        let mut expected = Shelter::default();
        shelter(&model, &state, &obstacles(&model, &state), wind, &mut expected);
        let mut probe = state.probe(&head.gpu_runner(&gpu));
        probe.run(&drive(6), &[Stage::Shelter]).unwrap();
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
