//! Rods: a style is an equilibrium, and hair comes to rest in it. On the CPU: rods have no kernels yet, and
//! a GPU refuses them.

use glam::Vec3;
use strandline::{Prepared, Scene};
use strandline_body::{Motion, Pose};
use strandline_checks::gpu;
use strandline_groom::{LANES, Style};
use strandline_sim::gpu::GpuSolver;
use strandline_sim::{Drive, Settings, Solver, State, StrandMethod};

fn settings(method: StrandMethod, time_step: f32) -> Settings {
    let mut settings = Settings { time_step, ..Settings::default() };
    settings.strands.method = method;
    settings
}

/// A built-in style with few guides, with its body.
fn style(style: Style, settings: &Settings) -> Solver {
    let mut scene = Scene::default();
    scene.set_style(style);
    scene.style.strand_count = 120;
    let prepared = Prepared::new(&scene).unwrap();
    Solver::new(&prepared.guides, settings, prepared.colliders.clone()).unwrap()
}

/// Mean and largest distance of points from where they rest on the head, over their strands' lengths.
fn drift(solver: &Solver, state: &State) -> (f32, f32) {
    let points = solver.points_per_strand();
    let rest = solver.rest_state(state.world_from_head);
    let (mut sum, mut most) = (0.0, 0.0_f32);
    for strand in 0..solver.strand_count() {
        let (block, lane) = (strand / LANES * points, strand % LANES);
        let length: f32 = (0..points).map(|point| solver.rest().stretch[block + point].0[lane]).sum();
        for point in block..block + points {
            let moved = state.positions[point].get(lane).distance(rest.positions[point].get(lane)) / length;
            sum += moved;
            most = most.max(moved);
        }
    }
    (sum / (solver.strand_count() * points) as f32, most)
}

/// Mean speed \[m/s\] of the last step: of what moved, and as it is stored.
fn speeds(solver: &Solver, state: &State) -> (f32, f32) {
    let count = (state.positions.len() * LANES) as f32;
    let lanes = |index: usize| (0..LANES).map(move |lane| (index, lane));
    let each = (0..state.positions.len()).flat_map(lanes);
    let (mut moved, mut stored) = (0.0, 0.0);
    for (index, lane) in each {
        let way = state.positions[index].get(lane).distance(state.previous_positions[index].get(lane));
        moved += way / solver.settings().time_step;
        stored += state.velocities[index].get(lane).length();
    }
    (moved / count, stored / count)
}

fn stepped(solver: &Solver, seconds: f32, motion: impl Fn(f64) -> Pose) -> State {
    let mut state = solver.rest_state(Pose::IDENTITY);
    let step = solver.settings().time_step;
    for index in 1..=(seconds / step).round() as u32 {
        let world_from_head = motion(f64::from(index) * f64::from(step));
        let report = solver.step(&mut state, &Drive { world_from_head, ..Drive::default() });
        assert_eq!(report.non_finite, 0);
        assert!(report.stretch_max < 1e-3, "stretched by {}", report.stretch_max);
    }
    state
}

#[test]
fn a_style_stays_as_it_was_groomed() {
    for name in [Style::Bob, Style::Wavy, Style::Pixie, Style::Ponytail] {
        let solver = style(name, &settings(StrandMethod::Rods, 1.0 / 60.0));
        let (mean, most) = drift(&solver, &stepped(&solver, 3.0, |_| Pose::IDENTITY));
        // The shape is an equilibrium without the body; what rests nearer to it than the margin is pushed
        // out, which shifts it.
        assert!(mean < 4e-3 && most < 5e-2, "{name:?}: {mean} on average, {most} at most");
    }
    let sagging = style(Style::Wavy, &settings(StrandMethod::Constrain, 1.0 / 60.0));
    let (mean, _) = drift(&sagging, &stepped(&sagging, 3.0, |_| Pose::IDENTITY));
    assert!(mean > 2e-2, "a shape that sags is not noticed: {mean}");
}

#[test]
fn shaken_hair_comes_to_rest_where_it_was() {
    for rate in [60.0, 240.0] {
        let solver = style(Style::Wavy, &settings(StrandMethod::Rods, 1.0 / rate));
        let state =
            stepped(&solver, 5.0, |time| Motion::Shake.pose(time.min(1.0), Vec3::new(0.0, -0.1, 0.0)));
        let (moved, stored) = speeds(&solver, &state);
        // The bound of the law is 5e-4 m/s six seconds after; some strands still creep after four.
        assert!(moved < 2e-3 && stored < 2e-3, "1/{rate} s: {moved} m/s, stored {stored} m/s");
        let (mean, _) = drift(&solver, &state);
        assert!(mean < 2e-2, "1/{rate} s: {mean} from where it was");
    }
}

#[test]
fn rods_are_the_same_for_any_number_of_threads() {
    let solver = style(Style::Curly, &settings(StrandMethod::Rods, 1.0 / 60.0));
    let shaken = || stepped(&solver, 0.2, |time| Motion::Shake.pose(time, Vec3::new(0.0, -0.1, 0.0)));
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let (one, three) = (pool(1).install(shaken), pool(3).install(shaken));
    assert_eq!(one.positions, three.positions);
    assert_eq!(one.velocities, three.velocities);
}

#[test]
fn a_gpu_refuses_rods_by_name() {
    let Some(gpu) = gpu() else { return };
    let solver = style(Style::Bob, &settings(StrandMethod::Rods, 1.0 / 60.0));
    let error = GpuSolver::new(&gpu, solver).err().unwrap().to_string();
    assert!(error.contains("simulation.strands.method"), "{error}");
}
