//! Runs steps on a GPU.

use std::sync::Arc;

use strandline_body::BodyFrame;
use strandline_gpu::{Buffer, Dispatches, Gpu, GpuError, Recorder, Timer};
use strandline_groom::{LANES, Lanes, RestShape};

use super::buffers::{Buffers, REPORTS};
use super::inputs::Step;
use super::kernels::Kernels;
use super::motion::has_roots;
use super::pending::{Pending, Reported};
use super::records::{Gradient, Spread};
use super::solids;
use super::volume::Volume;
use crate::grab::Grab;
use crate::step::{Stage, stages};
use crate::{ContactReport, Drive, Model, RodReport, Settings, SimError, State, StepReport};

/// A model with its kernels and a state on a device.
///
/// It agrees with a [`CpuRunner`](crate::CpuRunner) of the same model within rounding, as far as the order of
/// sums and the freshness of contact planes allow. An exact mannequin is sampled every 3 mm, since kernels know grids
/// only.
pub struct GpuRunner {
    pub(super) gpu: Gpu,
    pub(super) model: Model,
    pub(super) kernels: Arc<Kernels>,
    /// Segments of strands that can stretch.
    segment_count: usize,
    pub(super) buffers: Buffers,
    /// Index of the newer of the two buffers of positions.
    pub(super) side: usize,
    /// The stages bound to the buffers, in order, for both sides; `None` after a change.
    pub(super) bound: Option<[Vec<(Stage, Dispatches)>; 2]>,
    pub(super) body: BodyFrame,
    pub(super) time: f64,
    pub(super) length_scale: Vec<Lanes>,
    /// The rest shape with these lengths.
    pub(super) lengths: Arc<RestShape>,
    /// Box of the volume from the next step on \[m\]; `None` leaves it.
    pub(super) volume_box: Option<[f32; 4]>,
    pub(super) grab: Grab,
    pub(super) pending: Pending,
    /// Reports that were read but not returned yet.
    reports: Vec<StepReport>,
    gradient: Gradient,
    spread: Spread,
    costs: Costs,
}

/// Work that a step caused on the device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Costs {
    /// Kernels started.
    pub dispatches: usize,
    /// Dispatches of the pressure solve among them.
    pub solve_dispatches: usize,
    /// Bytes that the kernels without the solve's rounds must move at least: every number that they
    /// read or write, once for each kernel.
    pub bytes: u64,
}

impl GpuRunner {
    /// Compiles the kernels for a model; its guides are at rest.
    ///
    /// # Errors
    /// MIC(0), which is for the CPU only; more than 2,000 iterations of the pressure solve; whatever the
    /// device refuses.
    pub fn new(gpu: &Gpu, model: Model) -> Result<Self, SimError> {
        model.settings.check_on_gpu()?;
        let kernels = Kernels::new(gpu)?;
        let state = model.rest_state(BodyFrame::REST);
        Self::with_kernels(gpu, model, Arc::new(kernels), &state)
    }

    /// Another runner with the same kernels, for a state.
    ///
    /// # Errors
    /// The device has no memory left or was lost.
    pub fn another(&self, state: &State) -> Result<Self, SimError> {
        Self::with_kernels(&self.gpu, self.model.clone(), Arc::clone(&self.kernels), state)
    }

    fn with_kernels(gpu: &Gpu, model: Model, kernels: Arc<Kernels>, state: &State) -> Result<Self, SimError> {
        let made = Self {
            gpu: gpu.clone(),
            kernels,
            buffers: Buffers::new(gpu, &model, state)?,
            segment_count: segment_count(&model),
            model,
            side: 0,
            bound: None,
            body: state.body.clone(),
            time: state.time,
            length_scale: state.length_scale.clone(),
            lengths: Arc::clone(&state.lengths),
            volume_box: state.volume_box,
            grab: state.grab.clone(),
            pending: Pending::new(gpu)?,
            reports: Vec::new(),
            gradient: Gradient::default(),
            spread: Spread::default(),
            costs: Costs::default(),
        };
        gpu.check()?;
        Ok(made)
    }

    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Time of the state \[s\].
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Body now.
    pub fn body(&self) -> &BodyFrame {
        &self.body
    }

    /// Positions \[m\] now and one step ago, world space, `[block][point][component][lane]`: for a
    /// renderer on the same device. They change places with every step.
    pub fn positions(&self) -> [&Buffer<f32>; 2] {
        [&self.buffers.places[self.side], &self.buffers.places[1 - self.side]]
    }

    /// Work that the last step caused on the device.
    pub fn costs(&self) -> Costs {
        self.costs
    }

    /// Chooses between one kernel and three for the pressure gradient [Chen2011 table 1].
    pub fn set_gradient(&mut self, gradient: Gradient) {
        self.gradient = gradient;
        self.bound = None;
    }

    /// Chooses where the pressure solve runs.
    pub fn set_spread(&mut self, spread: Spread) {
        self.spread = spread;
        self.bound = None;
    }

    /// Changes the settings between two steps: uploads what the change invalidates and waits only for another strand
    /// solver.
    ///
    /// # Errors
    /// A setting outside its range or MIC(0), or too little room for pairs of strands, then nothing changes; or the device
    /// was lost.
    pub fn set_settings(&mut self, settings: &Settings) -> Result<(), SimError> {
        settings.check_on_gpu()?;
        self.gpu.check()?;
        let change = self.model.settings.change_to(settings);
        if change.buffers {
            self.drain()?;
            return self.rebuild(settings, &self.state()?);
        }
        let before = self.model.settings.clone();
        self.model.set_settings(settings)?;
        if let Err(error) = self.fit_crowd(change.stages) {
            self.model.set_settings(&before)?;
            return Err(error);
        }
        if change.masses {
            self.buffers.write_rest(&self.model, &self.lengths)?;
        } else if change.rest_shape {
            self.buffers.write_rods(&self.model, &self.lengths)?;
        }
        // Densities at rest go with the masses.
        if change.stages || change.masses && self.model.rest_density().is_some() {
            self.bound = None;
        }
        Ok(())
    }

    /// Advances the state by one step of `settings.time_step`: one submission, which is not waited
    /// for. When the device holds as many reports as it can, they are sent on their way.
    ///
    /// # Errors
    /// The device has no memory left or was lost; then nothing is known of the state until
    /// [`GpuRunner::write`] replaces it.
    pub fn step(&mut self, drive: &Drive) -> Result<(), SimError> {
        self.run(drive, |_| true)?;
        self.side = 1 - self.side;
        self.body = drive.or_still_at(&self.body, self.model.strand_count).body;
        self.time += f64::from(self.model.settings.time_step);
        self.pending.count += 1;
        Ok(())
    }

    /// Waits for the device and reports all steps that were not reported yet.
    ///
    /// # Errors
    /// The device was lost.
    pub fn reports(&mut self) -> Result<Vec<StepReport>, SimError> {
        self.drain()?;
        Ok(std::mem::take(&mut self.reports))
    }

    /// The reports that have arrived by now, in the order of their steps; those of the last steps are sent on their
    /// way. Waits only where many runs are on their way, and never for a host that never waits.
    ///
    /// # Errors
    /// The device was lost.
    pub fn arrived_reports(&mut self) -> Result<Vec<StepReport>, SimError> {
        self.pending.send(&self.gpu, &self.buffers.reports)?;
        let found = self.pending.arrived(&self.gpu)?;
        self.keep(found);
        Ok(std::mem::take(&mut self.reports))
    }

    /// Forgets the reports of steps that will be computed again.
    pub fn forget_reports(&mut self) {
        self.pending.forget();
        self.reports.clear();
    }

    /// See [`Simulator::device_solids`](crate::Simulator::device_solids).
    pub fn solids(&self) -> (Buffer<[u32; 4]>, [usize; 2]) {
        solids::rows(&self.buffers.step, &self.model.colliders)
    }

    /// Records and submits the stages of a step that are wanted.
    pub(super) fn run(&mut self, drive: &Drive, wanted: impl Fn(Stage) -> bool) -> Result<(), SimError> {
        let drive = drive.or_still_at(&self.body, self.model.strand_count);
        if has_roots(&self.body, &drive.body)
            && self.buffers.make_room_for_roots(&self.gpu, &self.model, &self.lengths, &self.grab)?
        {
            self.bound = None;
        }
        self.prepare()?;
        self.grab.hand = drive.hand.unwrap_or(self.grab.hand);
        let bodies = [&self.body, &drive.body];
        let (skin, skin_shift) = solids::write_skins(
            (&self.buffers.step, &mut self.buffers.skins),
            &self.model.colliders,
            bodies,
        )?;
        let uniform = Step::new(&self.model, &self.body, &drive, &self.grab, self.pending.count);
        self.buffers.step.write(&[Step { skin, skin_shift, ..uniform }])?;
        solids::write_pieces(&self.buffers.step, &self.model, bodies)?;
        self.buffers.write_roots(&self.model, bodies)?;
        if let Some(shelter) = self.buffers.shelter() {
            shelter.currents.write_at(0, &drive.currents.rows())?;
        }
        let mut costs = Costs { bytes: self.buffers.bytes_of_step(), ..Costs::default() };
        let Pending { timer, marks, count, .. } = &self.pending;
        self.gpu.ask("a step", || {
            let mut recorder = Recorder::new(&self.gpu, timer.as_ref());
            timer.iter().for_each(Timer::restart);
            for (stage, dispatches) in self.bound.iter().flat_map(|sides| &sides[self.side]) {
                if !wanted(*stage) {
                    continue;
                }
                if let (Stage::Splat, Some(volume)) = (stage, &self.buffers.volume) {
                    recorder.clear(&volume.start_index);
                }
                if let (Stage::Shelter, Some(shelter)) = (stage, self.buffers.shelter()) {
                    recorder.clear(&shelter.sums);
                }
                recorder.stage(stage.name(), dispatches);
                costs.dispatches += dispatches.len();
                costs.solve_dispatches += if *stage == Stage::SolvePressure { dispatches.len() } else { 0 };
            }
            let recorded = recorder.finish(|encoder| {
                if let Some(timer) = timer {
                    timer.resolve(encoder, marks.raw(), *count as u64 * Timer::BYTES);
                }
            });
            self.gpu.queue().submit([recorded]);
        })?;
        self.costs = costs;
        Ok(())
    }

    /// Makes the volume fit the settings and binds the stages where that changed.
    pub(super) fn prepare(&mut self) -> Result<(), SimError> {
        let settings = &self.model.settings.volume;
        let kept = self.buffers.volume.take().filter(|old| settings.enabled && old.cells == settings.cells);
        let changed = kept.is_some() != settings.enabled;
        self.buffers.volume = match kept {
            Some(volume) => Some(volume),
            None if settings.enabled => {
                let Buffers { lane_count, points, .. } = self.buffers;
                let made = Volume::new(&self.gpu, settings.cells, lane_count, points);
                Some(made.map_err(|error| SimError::of_volume(settings.cells, error))?)
            }
            None => None,
        };
        let changed = self.buffers.fit_shelter(&self.gpu, &self.model.settings)? || changed;
        if let (Some(volume), Some(place)) = (&self.buffers.volume, self.volume_box.take()) {
            volume.put(place)?;
        }
        if changed || self.bound.is_none() {
            // Reports of other stages go first.
            self.pending.send(&self.gpu, &self.buffers.reports)?;
            if let Some(volume) = &mut self.buffers.volume {
                volume.gradient = self.gradient;
                volume.spread = self.spread;
                volume.pack(self.model.rest_density())?;
            }
            self.bound = None;
            self.bound = Some([self.bind(0)?, self.bind(1)?]);
        }
        if self.pending.count == REPORTS {
            self.pending.send(&self.gpu, &self.buffers.reports)?;
        }
        Ok(())
    }

    /// Binds the stages for the steps that start with the newer positions on a side.
    fn bind(&self, side: usize) -> Result<Vec<(Stage, Dispatches)>, GpuError> {
        let of = (&self.gpu, &self.model);
        let bind = |stage| Ok((stage, self.kernels.bind(stage, of, &self.buffers, side)?));
        stages(&self.model.settings).map(bind).collect()
    }

    /// Waits for all reports.
    fn drain(&mut self) -> Result<(), SimError> {
        let found = self.pending.drain(&self.gpu, &self.buffers.reports)?;
        self.keep(found);
        Ok(())
    }

    fn keep(&mut self, found: Vec<Reported>) {
        let (model, segments) = (&self.model, self.segment_count);
        self.reports.extend(found.into_iter().map(|reported| step_report(reported, model, segments)));
    }
}

/// Segments of strands that can stretch.
fn segment_count(model: &Model) -> usize {
    let points = model.points_per_strand;
    let free = |strand: usize, point: usize| {
        model.inverse_mass[strand / LANES * points + point].0[strand % LANES] > 0.0
    };
    let stretches = |strand: usize| (1..points).filter(move |&p| free(strand, p - 1) || free(strand, p));
    (0..model.strand_count).map(|strand| stretches(strand).count()).sum()
}

fn step_report((report, seconds): Reported, model: &Model, segment_count: usize) -> StepReport {
    StepReport {
        seconds,
        pressure: report.pressure.into(),
        contacts: model.settings.has_contact().then_some(ContactReport {
            pairs: report.pairs as usize,
            deepest: report.deepest,
            crossed: report.crossed as usize,
        }),
        rods: model.rods.is_some().then_some(RodReport {
            residual: report.residual,
            unsolved: report.unsolved as usize,
            resting: report.resting as usize,
        }),
        stretch_mean: report.stretch_sum / segment_count.max(1) as f32,
        stretch_max: report.stretch_max,
        penetration_max: report.penetration_max,
        speed_mean: report.speed_sum / (model.strand_count * model.points_per_strand) as f32,
        speed_max: report.speed_max,
        non_finite: report.non_finite as usize,
        non_finite_strand: None,
    }
}

/// Keeps errors of a lost device apart from those of settings.
impl SimError {
    /// Error of a volume with a number of cells: that of the setting, if there is too little room.
    fn of_volume(cells: [u32; 3], source: GpuError) -> Self {
        match source {
            GpuError::Limit { .. } | GpuError::OutOfMemory { .. } => Self::Cells { cells, source },
            other => Self::Gpu(other),
        }
    }
}
