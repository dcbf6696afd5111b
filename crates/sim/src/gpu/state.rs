use strandline_body::Pose;
use strandline_gpu::{Buffer, Readback, Timer};
use strandline_groom::{Lanes, RestShape, Vec3Lanes};

use super::advance::Report;
use super::buffers::{Buffers, REPORTS, floats, speeds};
use super::solver::GpuSolver;
use super::step::Stages;
use super::volume::{GridState, Volume};
use super::{Gradient, Spread};
use crate::grab::Grab;
use crate::masses::Masses;
use crate::{RodReport, SimError, Solver, State, StepReport};

/// All that changes with time, on the device.
pub struct GpuState {
    pub(super) buffers: Buffers,
    /// Which of the two buffers of positions is the newer.
    pub(super) side: usize,
    /// The stages bound to the buffers, for both sides; none after a change.
    pub(super) stages: Option<[Stages; 2]>,
    pub(super) world_from_head: Pose,
    pub(super) time: f64,
    length_scale: Vec<Lanes>,
    /// Where the box of the volume is to be from the next step on \[m\]; none leaves it.
    place: Option<[f32; 4]>,
    pub(super) grab: Grab,
    /// The rest shape with the length scales applied.
    pub(super) lengths: RestShape,
    timer: Option<Timer>,
    marks: Buffer<u64>,
    /// Steps whose reports lie on the device.
    pub(super) pending: usize,
    reports: Vec<StepReport>,
    pub(super) gradient: Gradient,
    pub(super) spread: Spread,
    pub(super) costs: Costs,
}

/// What a step asked of the device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Costs {
    /// Kernels started.
    pub dispatches: usize,
    /// Those of the pressure solve among them.
    pub solve_dispatches: usize,
    /// Bytes that the kernels without the solve's rounds must move at least: every number that they
    /// read or write, once for each kernel.
    pub bytes: u64,
}

impl GpuState {
    pub(super) fn new(solver: &GpuSolver, buffers: Buffers, state: &State) -> Result<Self, SimError> {
        let gpu = &solver.gpu;
        Ok(Self {
            buffers,
            side: 0,
            stages: None,
            world_from_head: state.world_from_head,
            time: state.time,
            length_scale: state.length_scale.clone(),
            place: state.scratch.place,
            grab: state.grab.clone(),
            lengths: state.scratch.lengths.clone(),
            timer: Timer::new(gpu)?,
            marks: Buffer::new(gpu, "times of stages", REPORTS * Timer::BYTES as usize / size_of::<u64>())?,
            pending: 0,
            reports: Vec::new(),
            gradient: Gradient::default(),
            spread: Spread::default(),
            costs: Costs::default(),
        })
    }

    /// Time \[s\].
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Pose of the head now.
    pub fn world_from_head(&self) -> Pose {
        self.world_from_head
    }

    /// Positions \[m\] now and one step ago, world space, `[block][point][component][lane]`: for a
    /// renderer on the same device. They change places with every step.
    pub fn positions(&self) -> [&Buffer<f32>; 2] {
        [&self.buffers.places[self.side], &self.buffers.places[1 - self.side]]
    }

    /// What the last step asked of the device.
    pub fn costs(&self) -> Costs {
        self.costs
    }

    /// Chooses between one kernel and three for the pressure gradient [Chen2011 table 1].
    pub fn set_gradient(&mut self, gradient: Gradient) {
        self.gradient = gradient;
        self.unbind();
    }

    /// Chooses where the pressure solve runs.
    pub fn set_spread(&mut self, spread: Spread) {
        self.spread = spread;
        self.unbind();
    }

    /// Has the stages bound anew before the next step.
    pub(super) fn unbind(&mut self) {
        self.stages = None;
    }

    /// Makes the volume fit the settings and binds the stages where that changed.
    pub(super) fn prepare(&mut self, solver: &GpuSolver) -> Result<(), SimError> {
        let settings = &solver.solver.settings.volume;
        let kept = self.buffers.volume.take().filter(|old| settings.enabled && old.cells == settings.cells);
        let changed = kept.is_some() != settings.enabled;
        self.buffers.volume = match kept {
            Some(volume) => Some(volume),
            None if settings.enabled => {
                let Buffers { lane_count, points, .. } = self.buffers;
                let made = Volume::new(&solver.gpu, settings.cells, lane_count, points);
                Some(made.map_err(|error| SimError::of_volume(settings.cells, error))?)
            }
            None => None,
        };
        if let (Some(volume), Some(place)) = (&self.buffers.volume, self.place.take()) {
            volume.put(place)?;
        }
        if changed || self.stages.is_none() {
            // Times of stages that are no longer there cannot be told apart later.
            self.drain(solver)?;
            if let Some(volume) = &mut self.buffers.volume {
                volume.gradient = self.gradient;
                volume.spread = self.spread;
            }
            self.stages = None;
            self.stages =
                Some([Stages::new(solver, &self.buffers, 0)?, Stages::new(solver, &self.buffers, 1)?]);
        }
        if self.pending == REPORTS {
            self.drain(solver)?;
        }
        Ok(())
    }

    pub(super) fn timer(&self) -> Option<&Timer> {
        self.timer.as_ref()
    }

    pub(super) fn marks(&self) -> &Buffer<u64> {
        &self.marks
    }

    pub(super) fn take_reports(&mut self, solver: &GpuSolver) -> Result<Vec<StepReport>, SimError> {
        self.drain(solver)?;
        Ok(std::mem::take(&mut self.reports))
    }

    /// Reads the reports that lie on the device.
    pub(super) fn drain(&mut self, solver: &GpuSolver) -> Result<(), SimError> {
        if self.pending == 0 {
            return Ok(());
        }
        let stride = if self.timer.is_some() { Timer::BYTES as usize / size_of::<u64>() } else { 0 };
        let mut batch = Readback::new();
        let reports = batch.add(&self.buffers.reports, self.pending);
        let marks = batch.add(&self.marks, self.pending * stride);
        let copied = batch.read(&solver.gpu)?;
        let (found, marks) = (copied.take(reports), copied.take(marks));
        for (slot, report) in found.iter().enumerate() {
            let seconds = match &self.timer {
                Some(timer) => timer.seconds(&marks[slot * stride..(slot + 1) * stride]),
                None => Vec::new(),
            };
            self.reports.push(step_report(report, seconds, solver));
        }
        self.pending = 0;
        Ok(())
    }

    pub(super) fn to_host(&self, solver: &Solver) -> Result<State, SimError> {
        let mut state = solver.rest_state(self.world_from_head);
        state.length_scale.clone_from(&self.length_scale);
        state.grab.clone_from(&self.grab);
        state.scratch.lengths.clone_from(&self.lengths);
        state.scratch.masses = Masses::new(solver, &self.lengths);
        self.read_into(&mut state)?;
        Ok(state)
    }

    /// Waits for the device and copies what a picture needs into a state of the host: positions,
    /// those of one step ago, the head's pose and the time; and the velocities with their corrections, of rods
    /// how their sections are turned.
    ///
    /// # Errors
    /// The device was lost; the state is then as it was.
    pub fn read_into(&self, state: &mut State) -> Result<(), SimError> {
        let [positions, previous] = self.positions();
        let velocities = &self.buffers.velocities;
        let mut batch = Readback::new();
        let parts = [positions, previous, velocities].map(|buffer| batch.add(buffer, buffer.len()));
        let grid = self.buffers.volume.as_ref().map(|volume| batch.add(&volume.grid, 1));
        let copied = batch.read(velocities.gpu())?;
        state.scratch.place = grid.and_then(|grid| copied.take(grid).first().map(GridState::place));
        let [positions, previous, velocities] = parts.map(|part| copied.take(part));
        floats_mut(&mut state.positions).copy_from_slice(&positions);
        floats_mut(&mut state.previous_positions).copy_from_slice(&previous);
        let count = self.buffers.point_count();
        let (velocities, others) = velocities.split_at(3 * count);
        floats_mut(&mut state.velocities).copy_from_slice(velocities);
        if self.buffers.rods.is_some() {
            state.corrections.fill(Vec3Lanes::default());
            floats_mut(&mut state.sections).copy_from_slice(&others[..3 * count]);
            bytemuck::cast_slice_mut(&mut state.spins).copy_from_slice(&others[3 * count..4 * count]);
        } else {
            floats_mut(&mut state.corrections).copy_from_slice(others);
        }
        state.world_from_head = self.world_from_head;
        state.time = self.time;
        state.grab.hand = self.grab.hand;
        Ok(())
    }

    /// Replaces the state on the device by one of the host.
    ///
    /// # Errors
    /// The device was lost.
    pub fn write(&mut self, solver: &GpuSolver, state: &State) -> Result<(), SimError> {
        self.buffers.write_rest(&solver.solver, &state.scratch.lengths)?;
        self.buffers.places[self.side].write(floats(&state.positions))?;
        self.buffers.places[1 - self.side].write(floats(&state.previous_positions))?;
        self.buffers.velocities.write(&speeds(&solver.solver.with_sections(state)))?;
        self.length_scale.clone_from(&state.length_scale);
        self.lengths.clone_from(&state.scratch.lengths);
        self.place = state.scratch.place;
        self.world_from_head = state.world_from_head;
        self.time = state.time;
        self.write_grab(state)
    }

    /// Holds on the device what the hand of a state of the host holds: see [`State::grab`].
    ///
    /// # Errors
    /// The device was lost.
    pub fn write_grab(&mut self, state: &State) -> Result<(), SimError> {
        self.buffers.write_grips(&state.grab)?;
        self.grab.clone_from(&state.grab);
        Ok(())
    }
}

pub(super) fn floats_mut(lanes: &mut [Vec3Lanes]) -> &mut [f32] {
    bytemuck::cast_slice_mut(lanes)
}

fn step_report(report: &Report, seconds: Vec<(&'static str, f64)>, solver: &GpuSolver) -> StepReport {
    let (rods, segment_count) = (solver.solver.rods.is_some(), solver.segment_count);
    StepReport {
        seconds,
        pressure: report.pressure.into(),
        rods: rods.then_some(RodReport {
            residual: report.residual,
            unsolved: report.unsolved as usize,
            resting: report.resting as usize,
        }),
        stretch_mean: report.stretch_sum / segment_count.max(1) as f32,
        stretch_max: report.stretch_max,
        penetration_max: report.penetration_max,
        speed_mean: report.speed_sum / (solver.solver.strand_count * solver.solver.points_per_strand) as f32,
        speed_max: report.speed_max,
        non_finite: report.non_finite as usize,
        non_finite_strand: None,
    }
}
