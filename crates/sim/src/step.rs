//! The step as a list of stages.

use std::time::Instant;

use crate::cpu::advance::advance;
use crate::cpu::constrain::constrain;
use crate::cpu::gather::gather;
use crate::cpu::integrate::integrate;
use crate::cpu::mark::mark;
use crate::cpu::pose_roots::pose_roots;
use crate::cpu::solve_pressure::solve_pressure;
use crate::cpu::solve_rods::solve_rods;
use crate::cpu::splat::splat;
use crate::cpu::{Obstacles, Volume};
use crate::masses::Masses;
use crate::{Drive, Solver, State, StepReport};

/// Advances a state by one step [Chen2011 §4, fig. 11-12].
pub(crate) fn step(solver: &Solver, state: &mut State, drive: &Drive) -> StepReport {
    let drive = drive.or_still_at(state.world_from_head);
    let obstacles = Obstacles {
        colliders: &solver.colliders,
        start: state.world_from_head,
        end: drive.world_from_head,
        time_step: solver.settings.time_step,
    };
    state.grab.hand = drive.hand.unwrap_or(state.grab.hand);
    if state.scratch.masses.key != solver.mass_key() {
        state.scratch.masses = Masses::new(solver, &state.scratch.lengths);
    }
    solver.give_sections(state);
    let mut report = StepReport::default();
    let seconds = &mut report.seconds;
    timed(seconds, "pose_roots", || pose_roots(solver, state, &drive.world_from_head));
    let non_finite = if solver.rods.is_some() {
        let solve = || solve_rods(solver, state, &obstacles, drive.wind);
        let (non_finite, rods) = timed(seconds, "solve_rods", solve);
        report.rods = Some(rods);
        non_finite
    } else {
        timed(seconds, "integrate", || integrate(solver, state, drive.wind));
        timed(seconds, "constrain", || constrain(solver, state, &obstacles))
    };
    if let Some(mut volume) = volume(solver, state) {
        let (positions, velocities) = (&state.scratch.predicted, &mut state.velocities);
        let masses = &state.scratch.masses.mass;
        timed(seconds, "splat", || splat(&mut volume, positions, velocities, masses));
        timed(seconds, "mark", || mark(&mut volume, &obstacles));
        report.pressure = timed(seconds, "solve_pressure", || solve_pressure(&mut volume));
        let (time_step, weights) = (solver.settings.time_step, &solver.inverse_mass);
        timed(seconds, "gather", || gather(&volume, time_step, weights, positions, velocities));
        state.scratch.volume = Some(volume);
    }
    let outcome = timed(seconds, "advance", || advance(solver, state, &obstacles));
    report.stretch_mean = outcome.stretch_mean();
    report.stretch_max = outcome.stretch_max;
    report.penetration_max = outcome.penetration_max;
    report.speed_mean = (outcome.speed_sum / (solver.strand_count * solver.points_per_strand) as f64) as f32;
    report.speed_max = outcome.speed_max;
    let non_finite = non_finite.with(outcome.non_finite);
    (report.non_finite, report.non_finite_strand) = (non_finite.count, non_finite.first_strand);
    report
}

/// The fluid volume of a state, unless it is switched off.
fn volume(solver: &Solver, state: &mut State) -> Option<Volume> {
    let settings = &solver.settings.volume;
    let (old, place) = (state.scratch.volume.take(), state.scratch.place.take());
    settings.enabled.then(|| {
        let mut volume = Volume::keep_or_new(old, settings, solver.strand_count, solver.points_per_strand);
        place.into_iter().for_each(|place| volume.grid.set_place(place));
        volume
    })
}

/// Runs a stage and notes how long it took \[s\].
fn timed<T>(seconds: &mut Vec<(&'static str, f64)>, stage: &'static str, run: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = run();
    seconds.push((stage, start.elapsed().as_secs_f64()));
    result
}
