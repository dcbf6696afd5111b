//! Points sorted by cell: each is in its cell and in no other, and their order follows from where they are alone.

use std::collections::BTreeMap;

use glam::{Quat, Vec3};
use strandline_body::Pose;
use strandline_checks::{On, law};
use strandline_groom::{Groom, Guides, LANES, Vec3Lanes};
use strandline_sim::cells::Lattice;
use strandline_sim::cpu::cells::{Cells, cells};
use strandline_sim::gpu::{GpuRunner, Probe};
use strandline_sim::{CpuRunner, Drive, Model, Settings, Stage, State};

const STRANDS: usize = 43;
const POINTS: usize = 9;
/// Edge of a cell \[m\]: some cells hold many points, most none.
const EDGE: f32 = 0.03;

/// Hair that leaves a ball in all directions.
fn model(cells: Option<f32>) -> Model {
    let mut groom = Groom::empty(8e-5);
    for strand in 0..STRANDS {
        let turn = Quat::from_rotation_y(2.4 * strand as f32) * Quat::from_rotation_z(0.7 * strand as f32);
        let out = turn * Vec3::X;
        groom.push([0.08 * out, 0.25 * out]);
    }
    let settings = Settings { cells, ..Settings::default() };
    Model::new(&Guides::resample(&groom, POINTS).unwrap(), &settings, Vec::new()).unwrap()
}

fn drive(step: usize) -> Drive {
    let rotation = Quat::from_rotation_y(0.05 * step as f32);
    let world_from_head = Pose { rotation, translation: Vec3::new(0.01 * step as f32, 0.0, 0.0) };
    Drive { body: world_from_head.into(), wind: Vec3::new(0.5, 0.0, 0.3), ..Drive::default() }
}

/// The state after some steps, from the one that is given.
fn stepped(model: &Model, state: &mut State, steps: std::ops::Range<usize>) -> CpuRunner {
    let mut runner = CpuRunner::from(model.clone());
    steps.for_each(|step| drop(runner.step(state, &drive(step))));
    runner
}

/// The order of the points of a state.
fn order(on: &On, model: &Model, state: &State) -> Vec<u32> {
    match on {
        On::Cpu => {
            let mut sorted = Cells::new(EDGE, STRANDS, POINTS);
            cells(&mut sorted, &state.positions);
            sorted.order().to_vec()
        }
        On::Gpu(gpu) => {
            let runner = GpuRunner::new(gpu, model.clone()).unwrap();
            let mut probe = Probe::new(&runner, state).unwrap();
            probe.run(&drive(9), &[Stage::PoseRoots, Stage::Cells]).unwrap();
            probe.cells().unwrap().0
        }
    }
}

fn point(positions: &[Vec3Lanes], index: u32) -> Vec3 {
    positions[index as usize / LANES].get(index as usize % LANES)
}

law! {
    fn each_point_is_in_its_cell_and_in_no_other(on) {
        let model = model(Some(EDGE));
        let mut state = model.rest_state(Pose::IDENTITY);
        stepped(&model, &mut state, 0..5);
        // A point out of reach and one that is nowhere are in no cell.
        state.positions[3].set(1, Vec3::splat(1e6));
        state.positions[4].set(2, Vec3::splat(f32::NAN));
        let found = order(on, &model, &state);
        let lattice = Lattice::new(EDGE, STRANDS * POINTS);
        let mut wanted: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for strand in 0..STRANDS {
            for index in 0..POINTS {
                let index = ((strand / LANES * POINTS + index) * LANES + strand % LANES) as u32;
                if let Some(cell) = lattice.cell(point(&state.positions, index)) {
                    let low = Vec3::from(cell.map(|number| number as f32)) * EDGE;
                    let inside = (point(&state.positions, index) - low) / EDGE;
                    assert!(inside.min_element() > -1e-4 && inside.max_element() < 1.0 + 1e-4, "{inside}");
                    wanted.entry(lattice.bucket(cell)).or_default().push(index);
                }
            }
        }
        wanted.values_mut().for_each(|points| points.sort_unstable());
        let wanted: Vec<u32> = wanted.into_values().flatten().collect();
        assert_eq!(found.len(), STRANDS * POINTS - 2);
        assert_eq!(found, wanted);
    }
}

law! {
    fn the_order_follows_from_where_points_are_alone(on) {
        let model = model(Some(EDGE));
        let mut state = model.rest_state(Pose::IDENTITY);
        stepped(&model, &mut state, 0..7);
        let wanted = order(on, &model, &state);
        // Another past and other speeds at the same places.
        let mut other = model.rest_state(Pose::IDENTITY);
        other.positions.clone_from(&state.positions);
        assert_eq!(order(on, &model, &other), wanted);
        // One that is restored.
        let mut restored = model.rest_state(Pose::IDENTITY);
        restored.restore(&model, &state.checkpoint()).unwrap();
        assert_eq!(order(on, &model, &restored), wanted);
        // Any number of threads.
        for threads in [1, 2, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            assert_eq!(pool.install(|| order(on, &model, &state)), wanted, "{threads} threads");
        }
        // Hair that moved is in another order.
        stepped(&model, &mut state, 7..9);
        assert_ne!(order(on, &model, &state), wanted);
    }
}

#[test]
fn a_step_sorts_the_points_where_it_begins_and_changes_no_bit_by_it() {
    let (with, without) = (model(Some(EDGE)), model(None));
    let mut states = [&with, &without].map(|model| model.rest_state(Pose::IDENTITY));
    let runners = [&with, &without].map(|model| CpuRunner::from(model.clone()));
    for (state, mut runner) in states.iter_mut().zip(runners) {
        for step in 0..6 {
            let start = state.positions.clone();
            let report = runner.step(state, &drive(step));
            let is_in = report.seconds.iter().any(|(stage, _)| *stage == "cells");
            assert_eq!(is_in, runner.model().settings().cells.is_some());
            let mut sorted = Cells::new(EDGE, STRANDS, POINTS);
            cells(&mut sorted, &start);
            if let Some(found) = runner.cells() {
                assert_eq!(found.order(), sorted.order(), "step {step}");
            }
            assert_eq!(runner.cells().is_some(), is_in);
        }
    }
    assert!(states[0].checkpoint() == states[1].checkpoint());
}

#[test]
fn edges_out_of_range_are_refused() {
    for edge in [0.0, f32::NAN, 1e3] {
        let settings = Settings { cells: Some(edge), ..Settings::default() };
        let error = settings.check().unwrap_err().to_string();
        assert!(error.contains("simulation.cells") && error.contains("0.0001 to 100 m"), "{error}");
    }
}
