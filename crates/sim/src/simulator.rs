//! A simulation on whichever backend runs it.

use glam::Vec3;
use strandline_base::Stopwatch;
use strandline_body::Pose;
use strandline_gpu::{Buffer, Gpu};

use crate::gpu::GpuRunner;
use crate::{CpuRunner, Drive, Model, Settings, SimError, State, StepReport};

/// A model, a state and the runner that advances it.
///
/// A state on a device stays there; it is read when somebody asks for it, and every
/// `simulation.checkpoint_every` steps, so that it can go on without the device.
pub struct Simulator {
    runner: Runner,
    /// The state on the CPU; of a device as it was when it was last read.
    state: State,
    /// What drove the steps that the device has made since then.
    ahead: Vec<Drive>,
    /// Whether a run of the device failed, so that nothing is known of its state.
    lost: bool,
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
        Ok(Self { runner, state, ahead: Vec::new(), lost: false })
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

    /// The state; of a device it is waited for where it has gone on since it was last read.
    ///
    /// # Errors
    /// The device was lost.
    pub fn state(&mut self) -> Result<&State, SimError> {
        if let Runner::Gpu(runner) = &mut self.runner
            && !self.ahead.is_empty()
        {
            find(runner, &self.state, &self.ahead, &mut self.lost)?;
            runner.read_into(&mut self.state)?;
            self.ahead.clear();
        }
        Ok(&self.state)
    }

    /// The state as it was last read: what a lost device leaves.
    pub fn last_state(&self) -> &State {
        &self.state
    }

    /// Strands in the hand.
    pub fn grabbed(&self) -> usize {
        self.state.grabbed()
    }

    /// Advances by a step for each drive; a device is waited for at the end, for its reports.
    ///
    /// # Errors
    /// The device has no memory left or was lost.
    pub fn run(&mut self, drives: &[Drive]) -> Result<Vec<StepReport>, SimError> {
        let runner = match &mut self.runner {
            Runner::Cpu(runner) => {
                return Ok(drives.iter().map(|drive| runner.step(&mut self.state, drive)).collect());
            }
            Runner::Gpu(runner) => runner,
        };
        if drives.is_empty() {
            return Ok(Vec::new());
        }
        find(runner, &self.state, &self.ahead, &mut self.lost)?;
        let watch = Stopwatch::start();
        self.lost = true;
        for drive in drives {
            runner.step(drive)?;
        }
        let mut reports = runner.reports()?;
        self.lost = false;
        let each = watch.seconds() / drives.len() as f64;
        // A device without timestamps: the wait for it is all that is known.
        for report in reports.iter_mut().filter(|report| report.seconds.is_empty()) {
            report.seconds.push(("step", each));
        }
        self.ahead.extend_from_slice(drives);
        if self.ahead.len() >= self.model().settings().checkpoint_every as usize {
            // A device that fails here fails in the next run too: these steps are made.
            self.state().ok();
        }
        Ok(reports)
    }

    /// Changes the settings between two steps.
    ///
    /// # Errors
    /// A setting outside its range, or one that a device has not, then nothing changes; or the device was lost.
    pub fn set_settings(&mut self, settings: &Settings) -> Result<(), SimError> {
        // Steps that were made with the old settings are made again with none other.
        self.state()?;
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
        self.ahead.clear();
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
        match &mut self.runner {
            Runner::Cpu(_) => Ok(()),
            Runner::Gpu(runner) => runner.write_grab(&self.state),
        }
    }

    // STUB
    pub fn steps(&self) -> u64 {
        0
    }
    pub fn reports(&mut self) -> Result<Vec<StepReport>, SimError> {
        Ok(Vec::new())
    }
    pub fn fall_back_seeing(&mut self, _: u64, see: impl FnOnce(&State)) -> bool {
        self.fall_back();
        see(&self.state);
        true
    }
    // STUB END
    /// Goes on on the CPU: from the state that was last read, through the steps that the device had made since.
    pub fn fall_back(&mut self) {
        let mut runner = CpuRunner::from(self.model().clone());
        for drive in std::mem::take(&mut self.ahead) {
            runner.step(&mut self.state, &drive);
        }
        self.runner = Runner::Cpu(runner.into());
    }
}

/// Brings a device of which nothing is known to where the simulation is.
fn find(runner: &mut GpuRunner, state: &State, ahead: &[Drive], lost: &mut bool) -> Result<(), SimError> {
    if *lost {
        runner.write(state)?;
        for drive in ahead {
            runner.step(drive)?;
        }
        runner.reports()?;
        *lost = false;
    }
    Ok(())
}
