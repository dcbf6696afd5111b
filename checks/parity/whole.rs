//! The whole step: short runs by points, long ones by statistics.

use glam::Vec3;
use strandline_body::Pose;
use strandline_checks::{gpu, own_gpu};
use strandline_groom::{Groom, Guides};
use strandline_sim::gpu::GpuRunner;
use strandline_sim::{CpuRunner, Drive, Model, Settings, VolumeSettings};

use crate::heads::{apart, ball, drive, heads, mean_apart};

#[test]
fn short_runs_agree_by_points() {
    let Some(gpu) = gpu() else { return };
    for head in heads() {
        let model = head.model();
        let mut runner = head.gpu_runner(&gpu);
        let mut on_cpu = CpuRunner::from(model.clone());
        let mut expected = model.rest_state(Pose::IDENTITY);
        let mut reports = Vec::new();
        for step in 1..=4 {
            reports.push(on_cpu.step(&mut expected, &drive(step)));
            runner.step(&drive(step)).unwrap();
        }
        let reported = runner.reports().unwrap();
        let found = runner.state().unwrap();
        let name = head.name;
        assert_eq!(reported.len(), 4, "{name}");
        assert_eq!(found.body, expected.body);
        assert_eq!(found.time, expected.time);
        let distance = apart(&expected.positions, &found.positions, &head.guides);
        // Two solves to 1e-5, and contact planes of another age in the edges where solids meet: a
        // point may slip to the other side of an edge, the others stay together.
        assert!(distance < 5e-3, "{name}: {distance}");
        let mean = mean_apart(&expected.positions, &found.positions, &head.guides);
        assert!(mean < 5e-5, "{name}: {mean}");
        let before = mean_apart(&expected.previous_positions, &found.previous_positions, &head.guides);
        assert!(before < 5e-5, "{name}: {before}");
        for (expected, found) in reports.iter().zip(&reported) {
            assert_eq!(found.non_finite, 0);
            let fluid = expected.pressure.fluid_cells.abs_diff(found.pressure.fluid_cells);
            assert!(fluid <= 2 + expected.pressure.fluid_cells / 20, "{name}: {expected:?}, {found:?}");
            assert!(found.pressure.relative_residual <= 1e-5, "{name}: {found:?}");
            assert!(
                (expected.stretch_max - found.stretch_max).abs() < 2e-2,
                "{name}: {expected:?} {found:?}"
            );
        }
    }
}

#[test]
fn long_runs_agree_by_statistics() {
    let Some(gpu) = gpu() else { return };
    let head = &heads()[0];
    let model = head.model();
    let mut runner = head.gpu_runner(&gpu);
    let mut on_cpu = CpuRunner::from(model.clone());
    let mut expected = model.rest_state(Pose::IDENTITY);
    let still = Drive::default();
    let mut energies = [0.0_f64; 2];
    let mut deepest = 0.0_f32;
    for step in 1..=150 {
        let drive = if step <= 60 { drive(step.min(30)) } else { still.clone() };
        let report = on_cpu.step(&mut expected, &drive);
        runner.step(&drive).unwrap();
        assert_eq!(report.non_finite, 0);
        deepest = deepest.max(report.penetration_max);
    }
    let reports = runner.reports().unwrap();
    assert_eq!(reports.len(), 150);
    assert!(reports.iter().all(|report| report.non_finite == 0));
    assert!(reports.iter().all(|report| report.stretch_max < 1e-3), "the length pass holds lengths");
    // Points that a wedge of two solids holds go as deep on either side.
    let depth = reports.iter().map(|report| report.penetration_max).fold(0.0, f32::max);
    assert!(depth < deepest + 1e-3, "{depth}, on the CPU {deepest}");
    let found = runner.state().unwrap();
    let mean = |state: &strandline_sim::State| {
        let points: Vec<glam::Vec3> =
            state.positions.iter().flat_map(|lanes| (0..8).map(|lane| lanes.get(lane))).collect();
        points.iter().sum::<glam::Vec3>() / points.len() as f32
    };
    // Hair of 20 cm that came to rest. Single points may lie on the other side of an edge where solids meet; the mean
    // over all was 0.5 mm, and the centres of mass lay 0.03 mm apart.
    let apart = (mean(&expected) - mean(&found)).length();
    assert!(apart < 1e-3, "{apart}");
    let apart = mean_apart(&expected.positions, &found.positions, &head.guides);
    assert!(apart < 3e-3, "{apart}");
    for (energy, state) in energies.iter_mut().zip([&expected, &found]) {
        let speeds = state.velocities.iter().flat_map(|v| (0..8).map(|lane| v.get(lane).length_squared()));
        *energy = speeds.map(f64::from).sum();
    }
    // Both backends keep a similar energy.
    assert!((0.3..3.0).contains(&(energies[1] / energies[0])), "{energies:?}");
}

#[test]
fn steps_may_be_queued_and_a_zero_number_of_them_changes_nothing() {
    let Some(gpu) = gpu() else { return };
    let head = &heads()[2];
    let mut runner = head.gpu_runner(&gpu);
    let before = runner.state().unwrap();
    assert!(runner.reports().unwrap().is_empty());
    assert_eq!(runner.state().unwrap().positions, before.positions);
    // More than the device keeps reports of.
    for step in 0..70 {
        runner.step(&drive(step)).unwrap();
    }
    let reports = runner.reports().unwrap();
    assert_eq!(reports.len(), 70);
    let costs = runner.costs();
    assert!(costs.dispatches - costs.solve_dispatches < 40, "{costs:?}");
    if gpu.has_timestamps() {
        let stages: Vec<&str> = reports[69].seconds.iter().map(|(name, _)| *name).collect();
        let all =
            ["pose_roots", "integrate", "constrain", "splat", "mark", "solve_pressure", "gather", "advance"];
        assert_eq!(stages, all);
    }
}

#[test]
fn more_points_than_a_row_of_workgroups_holds_all_move() {
    let Some(gpu) = gpu() else { return };
    // 4.4 million points are 68,750 workgroups of points; a row holds 65,535.
    let mut groom = Groom::empty(8e-5);
    for strand in 0..1_100_000 {
        let root = Vec3::new((strand % 1000) as f32, 0.0, (strand / 1000) as f32) * 1e-3;
        groom.push([root, root + Vec3::NEG_Y * 0.1]);
    }
    let guides = Guides::resample(&groom, 4).unwrap();
    drop(groom);
    let volume = VolumeSettings { enabled: false, ..VolumeSettings::default() };
    let settings =
        Settings { volume, ..Settings::constrained() }.with_constrain(|constrain| constrain.iterations = 2);
    let model = Model::new(&guides, &settings, Vec::new()).unwrap();
    let mut on_cpu = CpuRunner::from(model.clone());
    let mut expected = model.rest_state(Pose::IDENTITY);
    let mut runner = GpuRunner::new(&gpu, model).unwrap();
    on_cpu.step(&mut expected, &drive(1));
    runner.step(&drive(1)).unwrap();
    let mut moved = expected.clone();
    runner.read_into(&mut moved).unwrap();
    let distance = apart(&expected.positions, &moved.positions, &guides);
    // Positions of a metre are rounded to 6e-8 m, a few times.
    assert!(distance < 2e-6, "{distance}");
    assert!(apart(&moved.previous_positions, &moved.positions, &guides) > 1e-3, "nothing moved");
}

#[test]
fn more_points_than_a_buffer_holds_are_refused_with_the_sizes() {
    let Some(gpu) = own_gpu() else { return };
    let guides = ball(8, 4);
    let settings = Settings {
        volume: VolumeSettings { cells: [512; 3], ..VolumeSettings::default() },
        ..Settings::default()
    };
    let runner = GpuRunner::new(&gpu, Model::new(&guides, &settings, Vec::new()).unwrap()).unwrap();
    let used = gpu.memory_used();
    let mut other = runner.another(&runner.model().rest_state(Pose::IDENTITY)).unwrap();
    let error = other.step(&drive(1)).unwrap_err().to_string();
    assert!(error.contains(&gpu.adapter().name) && error.contains("134217728"), "{error}");
    drop(other);
    assert_eq!(gpu.memory_used(), used, "what was had for the refused volume is given back");
}
