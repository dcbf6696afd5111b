//! The stages of the fluid volume.

use strandline_checks::gpu;
use strandline_groom::{LANES, Vec3Lanes};
use strandline_sim::cells::Kind;
use strandline_sim::cpu::{
    Volume, constrain::constrain, gather::gather, integrate::integrate, mark::mark, pose_roots::pose_roots,
    solve_pressure::solve_pressure, splat::splat,
};
use strandline_sim::gpu::{GpuRunner, Gradient, Probe, Spread};
use strandline_sim::{Model, Preconditioner, Stage, State, VolumeMethod, VolumeSettings};

use crate::heads::{Head, Moving, apart, drive, heads, obstacles};

/// Everything up to the volume on the CPU, and an empty volume.
fn constrained(head: &Head) -> (Model, Moving, Volume) {
    let model = head.model();
    let mut state = head.moving(&model);
    let obstacles = obstacles(&model, &state);
    state.run(|state, scratch| pose_roots(&model, state, scratch, &drive(6).body));
    state.run(|state, scratch| integrate(&model, state, scratch, drive(6).wind));
    state.run(|state, scratch| constrain(&model, state, scratch, &obstacles));
    let volume =
        Volume::new(&head.settings.volume, head.guides.strand_count(), head.guides.points_per_strand());
    (model, state, volume)
}

fn splat_cpu(model: &Model, state: &Moving, volume: &mut Volume) {
    splat(volume, state.predicted(), &state.velocities, &model.rest().mass);
}

fn gather_cpu(model: &Model, volume: &Volume, state: &mut State, positions: &[Vec3Lanes]) {
    let time_step = model.settings().time_step;
    gather(volume, time_step, model.inverse_mass(), positions, &mut state.velocities);
}

/// The fastest point \[m/s\], 1 at least: the unit of rounding of velocities.
fn fastest(state: &State) -> f32 {
    let speeds = state.velocities.iter().flat_map(|lanes| (0..LANES).map(|lane| lanes.get(lane).length()));
    speeds.fold(1.0, f32::max)
}

/// The largest difference of the velocities of all faces \[m/s\], and of their changes.
fn faces_apart(volume: &Volume, found: &[[f32; 2]]) -> [f32; 2] {
    let count = volume.grid.cell_count();
    let mut largest = [0.0_f32; 2];
    for (index, pair) in found.iter().enumerate() {
        let (axis, cell) = (index / count, index % count);
        let expected = [volume.faces.velocity(axis, cell), volume.faces.change(axis, cell)];
        for kind in 0..2 {
            let difference = (pair[kind] - expected[kind]).abs();
            assert!(difference.is_finite());
            largest[kind] = largest[kind].max(difference);
        }
    }
    largest
}

#[test]
fn splat_sorts_and_sums_the_same() {
    let Some(gpu) = gpu() else { return };
    for head in heads() {
        let (model, state, mut volume) = constrained(&head);
        splat_cpu(&model, &state, &mut volume);
        let gpu_runner = head.gpu_runner(&gpu);
        let mut probe = state.probe(&gpu_runner);
        probe.run(&drive(6), &[Stage::Splat]).unwrap();
        let name = head.name;
        let (origin, spacing) = probe.grid().unwrap();
        assert_eq!(spacing, volume.grid.spacing(), "{name}");
        let low = volume.grid.low_corner() - spacing;
        assert!((glam::Vec3::from(origin) - low).length() < 1e-6, "{name}");
        // The same order within a cell, so that sums have the same bits in every run.
        let (start_index, order) = (probe.start_index().unwrap(), probe.order().unwrap());
        assert_eq!(order.len(), volume.sort.order().len(), "{name}");
        for cell in 0..volume.grid.cell_count() {
            let range = start_index[cell] as usize..start_index[cell + 1] as usize;
            let points = &order[range.clone()];
            let expected = match volume.sort.cells().binary_search(&(cell as u32)) {
                Ok(index) => volume.sort.points_of(index),
                Err(_) => &[],
            };
            assert_eq!(points, expected, "{name}, cell {cell}");
            // [Chen2011 fig. 26] has the number of points where a cell is empty.
            let first = if range.is_empty() { order.len() } else { range.start };
            assert_eq!(first as u32, volume.sort.start_index()[cell], "{name}, cell {cell}");
        }
        // Sums of up to some hundred velocities in another order, rounded as the fastest of them.
        let speed = fastest(&state);
        let [velocity, change] = faces_apart(&volume, &probe.faces().unwrap());
        assert!(velocity < 2e-5 * speed && change == 0.0, "{name}: {velocity}, {change}");
    }
}

#[test]
fn mark_tells_the_same_cells_and_walls() {
    let Some(gpu) = gpu() else { return };
    for head in heads() {
        let (model, state, mut volume) = constrained(&head);
        splat_cpu(&model, &state, &mut volume);
        let gpu_runner = head.gpu_runner(&gpu);
        let mut probe = state.probe(&gpu_runner);
        probe.run(&drive(6), &[Stage::Splat]).unwrap();
        probe.run(&drive(6), &[Stage::Mark]).unwrap();
        mark(&mut volume, &obstacles(&model, &state), None, None);
        let kinds = probe.kinds().unwrap();
        for (cell, kind) in kinds.iter().enumerate() {
            assert_eq!(*kind, volume.kind(cell), "{}, cell {cell}", head.name);
        }
        let differences = faces_apart(&volume, &probe.faces().unwrap());
        // Walls move as fast as hair.
        let limit = 1e-4 * fastest(&state);
        assert!(differences.iter().all(|difference| *difference < limit), "{}: {differences:?}", head.name);
    }
}

#[test]
fn a_one_sided_volume_packs_the_same_cells_and_moves_hair_alike() {
    let Some(gpu) = gpu() else { return };
    for mut head in heads() {
        head.settings.volume.method = VolumeMethod::OneSided;
        let (model, state, mut volume) = constrained(&head);
        splat_cpu(&model, &state, &mut volume);
        let gpu_runner = head.gpu_runner(&gpu);
        let mut probe = state.probe(&gpu_runner);
        probe.run(&drive(6), &[Stage::Splat]).unwrap();
        probe.run(&drive(6), &[Stage::Mark]).unwrap();
        let packing = model.rest_density().map(|density| (density, model.settings().time_step));
        mark(&mut volume, &obstacles(&model, &state), None, packing);
        let (kinds, occupied) = (probe.kinds().unwrap(), volume.sort.cells().len());
        // A density at the threshold falls to either side by its rounding.
        let other = kinds.iter().enumerate().filter(|(cell, kind)| **kind != volume.kind(*cell)).count();
        assert!(100 * other <= occupied, "{}: {other} of {occupied} cells", head.name);
        assert!(volume.fluid().len() < occupied, "{}: all cells are packed", head.name);
        let [velocity, change] = faces_apart(&volume, &probe.faces().unwrap());
        assert!(velocity < 1e-4 * fastest(&state), "{}: {velocity}, {change}", head.name);
        assert!(other > 0 || change < 1e-4 * fastest(&state), "{}: {change}", head.name);
    }
}

/// A volume with its walls, ready to be solved.
fn marked(head: &Head) -> (Model, Moving, Volume) {
    let (model, state, mut volume) = constrained(head);
    splat_cpu(&model, &state, &mut volume);
    mark(&mut volume, &obstacles(&model, &state), None, None);
    (model, state, volume)
}

/// The same volume, solved on the device.
fn solved(model: &GpuRunner, state: &Moving, volume: &Volume, spread: Spread) -> Probe {
    let mut probe = state.probe(model);
    probe.runner.set_spread(spread);
    probe.set_volume(&volume.contents()).unwrap();
    probe.run(&drive(6), &[Stage::SolvePressure]).unwrap();
    probe
}

#[test]
fn solve_pressure_times_the_same_gradient_in_both_forms() {
    let Some(gpu) = gpu() else { return };
    let head = &heads()[0];
    let (_, state, volume) = marked(head);
    let runner = head.gpu_runner(&gpu);
    let subtracted = |forms: &[Gradient]| {
        let probe = solved(&runner, &state, &volume, Spread::One);
        for form in forms {
            let seconds = probe.runner.seconds_of_gradient(*form, 3).unwrap();
            assert!(seconds.is_none_or(|seconds| seconds > 0.0 && seconds < 1.0), "{form:?}: {seconds:?}");
            assert_eq!(seconds.is_some(), gpu.has_timestamps());
        }
        probe.faces().unwrap()
    };
    let (none, one, three) =
        (subtracted(&[]), subtracted(&[Gradient::Joint]), subtracted(&[Gradient::Split]));
    let largest = none.iter().flatten().fold(0.0, |most: f32, value| most.max(value.abs()));
    let apart = |one: &[[f32; 2]], other: &[[f32; 2]]| {
        let pairs = one.iter().flatten().zip(other.iter().flatten());
        pairs.fold(0.0, |most: f32, (one, other)| most.max((one - other).abs()))
    };
    // The solve may end a bit apart, since its sums run in no fixed order.
    assert!(apart(&one, &three) < 1e-3 * largest, "the two forms do different work");
    assert!(apart(&none, &one) > 0.1 * largest, "what is timed does nothing");
    // Before the first step there is no volume to take it from.
    assert!(runner.another(&state).unwrap().seconds_of_gradient(Gradient::Joint, 1).unwrap().is_none());
}

#[test]
fn solve_pressure_agrees_in_every_way_to_run_it() {
    let Some(gpu) = gpu() else { return };
    for mut head in heads() {
        // Close enough to the solution that two ways to it cannot be far apart.
        head.settings.volume.tolerance = 1e-6;
        for preconditioner in [Preconditioner::Chebyshev, Preconditioner::Jacobi, Preconditioner::None] {
            head.settings.volume.preconditioner = preconditioner;
            let (_, state, volume) = marked(&head);
            let mut solved = volume.clone();
            let expected = solve_pressure(&mut solved);
            let gpu_runner = head.gpu_runner(&gpu);
            for (spread, gradient) in [(Spread::One, Gradient::Joint), (Spread::Many, Gradient::Split)] {
                let mut probe = state.probe(&gpu_runner);
                probe.runner.set_spread(spread);
                probe.runner.set_gradient(gradient);
                probe.set_volume(&volume.contents()).unwrap();
                probe.run(&drive(6), &[Stage::SolvePressure]).unwrap();
                let name = format!("{}, {preconditioner:?}, {spread:?}", head.name);
                let (pressure, found) = probe.pressure().unwrap();
                assert_eq!(found.fluid_cells as usize, expected.fluid_cells, "{name}");
                let iterations = expected.iterations as i64 - i64::from(found.iterations);
                // Single precision sums may need an iteration more or less, or two of many.
                let slack = 1 + expected.iterations as i64 / 20;
                assert!(iterations.abs() <= slack, "{name}: {expected:?}, {found:?}");
                let largest = solved.pressure().iter().fold(0.0, |a: f32, b| a.max(b.abs()));
                for (found, expected) in pressure.iter().zip(solved.pressure()) {
                    assert!((found - expected).abs() <= 1e-4 * largest, "{name}: {found}, {expected}");
                }
                let [velocity, change] = faces_apart(&solved, &probe.faces().unwrap());
                assert!(velocity < 1e-3 && change < 1e-3, "{name}: {velocity}, {change}");
            }
        }
    }
}

#[test]
fn a_solve_that_may_not_go_on_stops_and_says_so() {
    let Some(gpu) = gpu() else { return };
    let mut head = heads().swap_remove(0);
    head.settings.volume.max_iterations = 3;
    head.settings.volume.preconditioner = Preconditioner::Jacobi;
    let (_, state, volume) = marked(&head);
    let expected = solve_pressure(&mut volume.clone());
    let gpu_runner = head.gpu_runner(&gpu);
    for spread in [Spread::One, Spread::Many] {
        let probe = solved(&gpu_runner, &state, &volume, spread);
        let (_, found) = probe.pressure().unwrap();
        assert_eq!(found.iterations, 3, "{spread:?}");
        let relative = found.residual / found.first;
        assert!((relative - expected.relative_residual).abs() < 1e-4, "{relative}, {expected:?}");
    }
}

#[test]
fn more_iterations_than_rounds_go_on_in_one_workgroup() {
    let Some(gpu) = gpu() else { return };
    let mut head = heads().swap_remove(0);
    head.settings.volume = VolumeSettings {
        cells: [36; 3],
        tolerance: 1e-6,
        preconditioner: Preconditioner::None,
        ..head.settings.volume
    };
    let (_, state, mut volume) = marked(&head);
    // A block of hair: a solve of many iterations, on a grid that is large enough for rounds.
    let [x, y, _] = volume.grid.size();
    for cell in 0..volume.grid.cell_count() {
        let place = [cell % x, cell / x % y, cell / (x * y)];
        volume.set_kind(
            cell,
            if place.iter().all(|at| (1..=36).contains(at)) { Kind::Fluid } else { Kind::Air },
        );
    }
    let mut solved = volume.clone();
    let expected = solve_pressure(&mut solved);
    assert!(expected.iterations > 60, "{expected:?}");
    let gpu_runner = head.gpu_runner(&gpu);
    let mut probe = state.probe(&gpu_runner);
    probe.set_volume(&volume.contents()).unwrap();
    probe.run(&drive(6), &[Stage::SolvePressure]).unwrap();
    let (_, found) = probe.pressure().unwrap();
    assert!(found.iterations > 55 && found.residual <= 1e-6 * found.first, "{found:?}");
    let [velocity, _] = faces_apart(&solved, &probe.faces().unwrap());
    assert!(velocity < 1e-3, "{velocity}");
}

#[test]
fn rooms_without_air_are_levelled() {
    let Some(gpu) = gpu() else { return };
    let mut head = heads().swap_remove(0);
    head.settings.volume.cells = [12; 3];
    let (_, state, volume) = marked(&head);
    let gpu_runner = head.gpu_runner(&gpu);
    // Every air cell becomes solid: the fluid is enclosed.
    let mut closed = volume.clone();
    for cell in 0..closed.grid.cell_count() {
        if closed.kind(cell) == Kind::Air {
            closed.set_kind(cell, Kind::Solid);
        }
    }
    let mut expected_faces = closed.clone();
    let expected = solve_pressure(&mut expected_faces);
    assert!(expected.fluid_cells > 10 && expected.relative_residual <= 1e-5, "{expected:?}");
    for spread in [Spread::One, Spread::Many] {
        let probe = solved(&gpu_runner, &state, &closed, spread);
        let (_, found) = probe.pressure().unwrap();
        assert!(found.residual <= 1e-5 * found.first, "{spread:?}: {found:?}");
        let [velocity, _] = faces_apart(&expected_faces, &probe.faces().unwrap());
        assert!(velocity < 1e-3, "{spread:?}: {velocity}");
    }
}

#[test]
fn nothing_to_solve_is_solved() {
    let Some(gpu) = gpu() else { return };
    let mut head = heads().swap_remove(0);
    head.settings.volume.cells = [8; 3];
    let (_, state, volume) = marked(&head);
    let gpu_runner = head.gpu_runner(&gpu);
    for kind in [Kind::Air, Kind::Solid] {
        let mut volume = volume.clone();
        for cell in 0..volume.grid.cell_count() {
            volume.set_kind(cell, kind);
        }
        assert_eq!(solve_pressure(&mut volume.clone()).iterations, 0);
        for spread in [Spread::One, Spread::Many] {
            let probe = solved(&gpu_runner, &state, &volume, spread);
            let (_, found) = probe.pressure().unwrap();
            assert_eq!((found.iterations, found.fluid_cells), (0, 0));
            assert_eq!(faces_apart(&volume, &probe.faces().unwrap()), [0.0; 2]);
        }
    }
}

#[test]
fn gather_agrees() {
    let Some(gpu) = gpu() else { return };
    for head in heads() {
        let (model, mut state, mut volume) = marked(&head);
        solve_pressure(&mut volume);
        let gpu_runner = head.gpu_runner(&gpu);
        let mut probe = state.probe(&gpu_runner);
        probe.set_volume(&volume.contents()).unwrap();
        probe.run(&drive(6), &[Stage::Gather]).unwrap();
        let before = state.velocities.clone();
        let predicted = state.predicted().to_vec();
        gather_cpu(&model, &volume, &mut state, &predicted);
        // A lone strand's volume returns its velocities.
        let changed = apart(&before, &state.velocities, &head.guides);
        assert!(changed > 1e-3 || head.guides.strand_count() == 1, "{}: {changed}", head.name);
        let speed = apart(&state.velocities, &probe.velocities().unwrap(), &head.guides);
        assert!(speed < 1e-5 * fastest(&state), "{}: {speed}", head.name);
    }
}

#[test]
fn points_outside_and_on_borders_of_cells_go_where_they_belong() {
    let Some(gpu) = gpu() else { return };
    let head = heads().swap_remove(2);
    let (model, mut state, mut volume) = constrained(&head);
    // A box from corner to corner, points on its cells' borders, one far out and one not a number.
    let places = [
        [0.0, 0.0, 0.0],
        [1.5, 1.5, 1.5],
        [0.1, 0.2, 0.3],
        [0.75, 0.75, 0.75],
        [1.0, 0.5, 0.25],
        [2e4, 0.0, 0.0],
        [f32::NAN, 0.0, 0.0],
        [0.0, 1.5, 0.0],
        [1.5, 0.0, 0.75],
        [0.2, 0.2, 0.2],
        [0.4, 0.4, 0.4],
        [0.6, 0.6, 0.6],
    ];
    let mut predicted = state.predicted().to_vec();
    for (lanes, place) in predicted.iter_mut().zip(places) {
        (0..8).for_each(|lane| lanes.set(lane, place.into()));
    }
    splat(&mut volume, &predicted, &state.velocities, &model.rest().mass);
    let gpu_runner = head.gpu_runner(&gpu);
    let mut probe = state.probe(&gpu_runner);
    probe.set_predicted(&predicted).unwrap();
    probe.run(&drive(6), &[Stage::Splat]).unwrap();
    let mut order = probe.order().unwrap();
    order.sort_unstable();
    let mut expected = volume.sort.order().to_vec();
    expected.sort_unstable();
    assert_eq!(order, expected);
    assert_eq!(order.len(), 10);
    let [velocity, _] = faces_apart(&volume, &probe.faces().unwrap());
    assert!(velocity < 1e-5, "{velocity}");
    // Points outside keep their velocities.
    probe.run(&drive(6), &[Stage::Gather]).unwrap();
    gather_cpu(&model, &volume, &mut state, &predicted);
    assert!(apart(&state.velocities, &probe.velocities().unwrap(), &head.guides) < 1e-5);
}
