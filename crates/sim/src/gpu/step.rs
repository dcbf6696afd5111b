//! The step as a list of stages, recorded into one submission.

use strandline_gpu::{Recorder, Timer};

use super::buffers::Buffers;
use super::inputs::Step;
use super::state::Costs;
use super::{Dispatches, GpuSolver, GpuState};
use crate::{Drive, SimError};

/// The stages of a step, bound to buffers, in order.
pub(super) struct Stages {
    list: Vec<(&'static str, Dispatches)>,
}

impl Stages {
    /// Binds the stages for the steps that start with the newer positions on a side.
    pub fn new(solver: &GpuSolver, buffers: &Buffers, side: usize) -> Result<Self, SimError> {
        let (gpu, kernels) = (&solver.gpu, &solver.kernels);
        let preconditioner = solver.solver.settings.volume.preconditioner;
        let scan = &kernels.scan;
        let mut list = vec![("pose_roots", kernels.pose_roots.bind(gpu, buffers, side)?)];
        if buffers.rods.is_some() {
            list.push(("solve_rods", kernels.solve_rods.bind(gpu, buffers, side)?));
        } else {
            list.push(("integrate", kernels.integrate.bind(gpu, buffers, side)?));
            list.push(("constrain", kernels.constrain.bind(gpu, buffers, side)?));
        }
        list.extend([
            ("splat", kernels.splat.bind(gpu, buffers, scan, side)?),
            ("mark", kernels.mark.bind(gpu, buffers)?),
            ("solve_pressure", kernels.solve_pressure.bind(gpu, buffers, scan, preconditioner)?),
            ("gather", kernels.gather.bind(gpu, buffers, side)?),
            ("advance", kernels.advance.bind(gpu, buffers, side)?),
        ]);
        Ok(Self { list })
    }
}

/// Advances a state by one step.
pub(super) fn step(solver: &GpuSolver, state: &mut GpuState, drive: &Drive) -> Result<(), SimError> {
    run(solver, state, drive, |_| true)?;
    state.side = 1 - state.side;
    state.world_from_head = drive.or_still_at(state.world_from_head).world_from_head;
    state.time += f64::from(solver.solver.settings.time_step);
    state.pending += 1;
    Ok(())
}

/// Records and submits the stages of a step that are wanted.
pub(super) fn run(
    solver: &GpuSolver,
    state: &mut GpuState,
    drive: &Drive,
    wanted: impl Fn(&str) -> bool,
) -> Result<(), SimError> {
    state.prepare(solver)?;
    let drive = drive.or_still_at(state.world_from_head);
    state.grab.hand = drive.hand.unwrap_or(state.grab.hand);
    let uniform = Step::new(&solver.solver, &state.world_from_head, &drive, &state.grab, state.pending);
    state.buffers.step.write(&[uniform])?;
    let mut costs = Costs { bytes: state.buffers.bytes_of_step(), ..Costs::default() };
    solver.gpu.guarded("a step", || {
        let mut recorder = Recorder::new(&solver.gpu, state.timer());
        state.timer().inspect(|timer| timer.restart());
        for (name, dispatches) in state.stages.iter().flat_map(|stages| &stages[state.side].list) {
            if dispatches.is_empty() || !wanted(name) {
                continue;
            }
            if *name == "splat"
                && let Some(volume) = &state.buffers.volume
            {
                recorder.clear(&volume.start_index);
            }
            recorder.stage(name, dispatches);
            costs.dispatches += dispatches.len();
            costs.solve_dispatches += if *name == "solve_pressure" { dispatches.len() } else { 0 };
        }
        let recorded = recorder.finish(|encoder| {
            if let Some(timer) = state.timer() {
                timer.resolve(encoder, state.marks().raw(), state.pending as u64 * Timer::BYTES);
            }
        });
        solver.gpu.queue().submit([recorded]);
    })?;
    state.costs = costs;
    Ok(())
}
