//! A simulation on whichever backend runs it.

use glam::Vec3;
use strandline_body::Pose;
use strandline_gpu::{Buffer, Gpu};

use crate::gpu::{ComingState, GpuRunner};
use crate::{CpuRunner, Drive, Model, Settings, SimError, State, StepReport};

/// A model, a state and the runner that advances it.
///
/// A state on a device stays there. It is read when it is asked for; and every `simulation.checkpoint_every` steps
/// without a wait, so that the CPU can resume from it where the device fails. Reports of steps on a device come when
/// they have arrived.
pub struct Simulator {
    runner: Runner,
    /// The state on the CPU; of a device as it was when it was last read.
    state: State,
    /// What drove the steps that the device has made since then.
    ahead: Vec<Drive>,
    /// The state read before that one: a picture under way may still show steps after it.
    older: Option<Older>,
    /// A state on its way from the device, after so many of the steps `ahead`.
    coming: Option<(ComingState, usize)>,
    /// Whether a run of the device failed, so that nothing is known of its state.
    lost: bool,
    /// Steps made, steps reported, and the step of the next report that comes from the device.
    steps: u64,
    reported: u64,
    next_report: u64,
    /// Reports to be returned next: of steps before a state that was read, and of those that the CPU made again for a
    /// device that failed.
    kept: Vec<StepReport>,
}

/// A state, and what drove the steps from it to the next one that was read.
struct Older {
    state: State,
    drives: Vec<Drive>,
}

enum Runner {
    Cpu(Box<CpuRunner>),
    Gpu(Box<GpuRunner>),
}

impl Runner {
    fn model(&self) -> &Model {
        match self {
            Self::Cpu(runner) => runner.model(),
            Self::Gpu(runner) => runner.model(),
        }
    }
}

impl Simulator {
    /// The guides at rest, on a device, or on the CPU without one.
    ///
    /// # Errors
    /// As [`GpuRunner::new`].
    pub fn new(gpu: Option<&Gpu>, model: Model) -> Result<Self, SimError> {
        let state = model.rest_state(Pose::IDENTITY);
        let runner = match gpu {
            Some(gpu) => Runner::Gpu(GpuRunner::new(gpu, model)?.into()),
            None => Runner::Cpu(Box::new(model.into())),
        };
        Ok(Self {
            runner,
            state,
            ahead: Vec::new(),
            older: None,
            coming: None,
            lost: false,
            steps: 0,
            reported: 0,
            next_report: 0,
            kept: Vec::new(),
        })
    }

    /// The model.
    pub fn model(&self) -> &Model {
        self.runner.model()
    }

    /// The device, while the simulation runs on one.
    pub fn gpu(&self) -> Option<&Gpu> {
        match &self.runner {
            Runner::Gpu(runner) => Some(runner.gpu()),
            Runner::Cpu(_) => None,
        }
    }

    /// Positions on the device \[m\] at the last state and at the one before it.
    pub fn device_points(&self) -> Option<[&Buffer<f32>; 2]> {
        match &self.runner {
            Runner::Gpu(runner) => Some(runner.positions()),
            Runner::Cpu(_) => None,
        }
    }

    /// Time of the state \[s\].
    pub fn time(&self) -> f64 {
        match &self.runner {
            Runner::Cpu(_) => self.state.time,
            Runner::Gpu(runner) => runner.time(),
        }
    }

    /// Steps made since the simulator was.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The state. A device is waited for, unless it has made no step since it was last read.
    ///
    /// # Errors
    /// The device was lost.
    pub fn state(&mut self) -> Result<&State, SimError> {
        if let Runner::Gpu(_) = &self.runner
            && !self.ahead.is_empty()
        {
            self.find()?;
            let Runner::Gpu(runner) = &self.runner else { return Ok(&self.state) };
            let coming = runner.begin_read()?;
            // Steps before the state are not made again: their reports are kept.
            let reports = self.collect(GpuRunner::reports)?;
            self.kept.extend(reports);
            self.checkpoint(self.ahead.len(), |state| coming.write(state))?;
        }
        Ok(&self.state)
    }

    /// Makes the state after so many of the steps `ahead` the one to resume from, once it is read.
    fn checkpoint(
        &mut self,
        count: usize,
        read: impl FnOnce(&mut State) -> Result<(), SimError>,
    ) -> Result<(), SimError> {
        // The state before the last one makes room.
        let (mut state, drives) = match self.older.take() {
            Some(Older { state, drives }) => (state, Some(drives)),
            None => (self.state.clone(), None),
        };
        if let Err(failure) = read(&mut state) {
            self.older = drives.map(|drives| Older { state, drives });
            return Err(failure);
        }
        let state = std::mem::replace(&mut self.state, state);
        self.older = Some(Older { state, drives: self.ahead.drain(..count).collect() });
        self.coming = None;
        Ok(())
    }

    /// Resumes from the state that is on its way from now on, if it has arrived; sends one on its way where many
    /// steps were made since. What fails here fails in the next run, and these steps are made.
    fn renew_checkpoint(&mut self) {
        let before = self.steps - self.ahead.len() as u64;
        // Steps before it are not made again, so that their reports come first.
        if let Some((coming, count)) =
            self.coming.take_if(|(_, count)| self.reported >= before + *count as u64)
        {
            match coming.has_arrived() {
                Ok(true) => self.checkpoint(count, |state| coming.write(state)).unwrap_or_default(),
                Ok(false) => self.coming = Some((coming, count)),
                Err(_) => {}
            }
        }
        let Runner::Gpu(runner) = &self.runner else { return };
        if self.coming.is_none() && self.ahead.len() >= runner.model().settings().checkpoint_every as usize {
            self.coming = runner.begin_read().ok().map(|coming| (coming, self.ahead.len()));
        }
    }

    /// Takes reports from the device that were not returned yet.
    fn collect(
        &mut self,
        take: impl FnOnce(&mut GpuRunner) -> Result<Vec<StepReport>, SimError>,
    ) -> Result<Vec<StepReport>, SimError> {
        let Runner::Gpu(runner) = &mut self.runner else { return Ok(Vec::new()) };
        let mut found = take(runner)?;
        let known = self.reported.saturating_sub(self.next_report).min(found.len() as u64);
        self.next_report += found.len() as u64;
        self.reported = self.reported.max(self.next_report);
        found.drain(..known as usize);
        Ok(found)
    }

    /// Brings a device of which nothing is known to where the simulation is.
    fn find(&mut self) -> Result<(), SimError> {
        let Runner::Gpu(runner) = &mut self.runner else { return Ok(()) };
        if self.lost {
            runner.forget_reports();
            runner.write(&self.state)?;
            self.next_report = self.steps - self.ahead.len() as u64;
            self.coming = None;
            for drive in &self.ahead {
                runner.step(drive)?;
            }
            self.lost = false;
        }
        Ok(())
    }

    /// The state as it was last read: what a lost device leaves.
    pub fn last_state(&self) -> &State {
        &self.state
    }

    /// Strands in the hand.
    pub fn grabbed(&self) -> usize {
        self.state.grabbed()
    }

    /// Advances by a step for each drive, and reports the steps that are done: on a device those whose reports have
    /// arrived, also of earlier runs; [`Simulator::reports`] waits for the others.
    ///
    /// # Errors
    /// The device has no memory left or was lost.
    pub fn run(&mut self, drives: &[Drive]) -> Result<Vec<StepReport>, SimError> {
        if let Runner::Cpu(runner) = &mut self.runner {
            let mut reports = std::mem::take(&mut self.kept);
            reports.extend(drives.iter().map(|drive| runner.step(&mut self.state, drive)));
            self.steps += drives.len() as u64;
            self.reported = self.steps;
            return Ok(reports);
        }
        self.find()?;
        self.lost = true;
        if let Runner::Gpu(runner) = &mut self.runner {
            for drive in drives {
                runner.step(drive)?;
            }
        }
        let arrived = self.collect(GpuRunner::arrived_reports)?;
        let mut reports = std::mem::take(&mut self.kept);
        reports.extend(arrived);
        self.lost = false;
        self.ahead.extend_from_slice(drives);
        self.steps += drives.len() as u64;
        self.renew_checkpoint();
        Ok(reports)
    }

    /// The reports of all steps that were not returned yet; a device is waited for.
    ///
    /// # Errors
    /// The device was lost.
    pub fn reports(&mut self) -> Result<Vec<StepReport>, SimError> {
        self.find()?;
        let found = self.collect(GpuRunner::reports)?;
        let mut reports = std::mem::take(&mut self.kept);
        reports.extend(found);
        Ok(reports)
    }

    /// Changes the settings between two steps.
    ///
    /// # Errors
    /// A setting outside its range, or one that a device has not, then nothing changes; or the device was lost.
    pub fn set_settings(&mut self, settings: &Settings) -> Result<(), SimError> {
        // Steps that were made with the old settings are made again with none other.
        self.state()?;
        self.older = None;
        match &mut self.runner {
            Runner::Cpu(runner) => runner.set_settings(settings),
            Runner::Gpu(runner) => runner.set_settings(settings),
        }
    }

    /// Replaces the state.
    ///
    /// # Errors
    /// The device was lost; the state is then this one.
    pub fn set_state(&mut self, state: State) -> Result<(), SimError> {
        self.state = state;
        self.write()
    }

    /// Changes the state.
    ///
    /// # Errors
    /// What `change` returns, and then nothing changes; the device was lost.
    pub fn change<T>(
        &mut self,
        change: impl FnOnce(&mut State, &Model) -> Result<T, SimError>,
    ) -> Result<T, SimError> {
        self.state()?;
        let model = self.runner.model();
        let result = change(&mut self.state, model)?;
        self.write().map(|()| result)
    }

    /// Brings the state to the device.
    fn write(&mut self) -> Result<(), SimError> {
        if self.lost {
            // Of steps that do not count.
            if let Runner::Gpu(runner) = &mut self.runner {
                runner.forget_reports();
            }
            self.next_report = self.steps;
        } else {
            // A device that failed shows below.
            let reports = self.collect(GpuRunner::reports).unwrap_or_default();
            self.kept.extend(reports);
        }
        self.ahead.clear();
        (self.older, self.coming) = (None, None);
        if let Runner::Gpu(runner) = &mut self.runner {
            self.lost = true;
            runner.write(&self.state)?;
            self.lost = false;
        }
        Ok(())
    }

    /// Takes hair into a hand: see [`State::grab`]. Returns the number of strands.
    ///
    /// # Errors
    /// The device was lost.
    pub fn grab(&mut self, hand: Vec3, radius: f32) -> Result<usize, SimError> {
        self.state()?;
        let model = self.runner.model();
        let count = self.state.grab(model, hand, radius);
        self.hold().map(|()| count)
    }

    /// Lets go of it.
    ///
    /// # Errors
    /// The device was lost.
    pub fn release(&mut self) -> Result<(), SimError> {
        self.state()?;
        self.state.release();
        self.hold()
    }

    /// Holds on the device what the state's hand holds.
    fn hold(&mut self) -> Result<(), SimError> {
        self.older = None;
        match &mut self.runner {
            Runner::Cpu(_) => Ok(()),
            Runner::Gpu(runner) => runner.write_grab(&self.state),
        }
    }

    /// Falls back to the CPU: from the state that was last read, through the steps that the device had made since.
    pub fn fall_back(&mut self) {
        self.fall_back_seeing(self.steps, |_| ());
    }

    /// Falls back to the CPU and shows the state after so many steps when it comes by: one of the last runs before the
    /// device failed. Returns whether it did; never on the CPU.
    pub fn fall_back_seeing(&mut self, step: u64, mut see: impl FnMut(&State)) -> bool {
        if let Runner::Cpu(_) = &self.runner {
            return false;
        }
        let mut runner = CpuRunner::from(self.model().clone());
        let mut drives = std::mem::take(&mut self.ahead);
        let mut at = self.steps - drives.len() as u64;
        if let Some(Older { state, drives: before }) = self.older.take()
            && (at - before.len() as u64..at).contains(&step)
        {
            at -= before.len() as u64;
            drives.splice(0..0, before);
            self.state = state;
        }
        let mut seen = at == step;
        if seen {
            see(&self.state);
        }
        for drive in drives {
            let report = runner.step(&mut self.state, &drive);
            at += 1;
            self.kept.extend((at > self.reported).then_some(report));
            if at == step {
                see(&self.state);
                seen = true;
            }
        }
        self.reported = self.steps;
        self.runner = Runner::Cpu(runner.into());
        (self.coming, self.lost) = (None, false);
        seen
    }
}
