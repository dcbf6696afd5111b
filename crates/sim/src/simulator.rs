//! A simulation on whichever backend runs it.

use std::borrow::Cow;

use glam::Vec3;
use strandline_body::BodyFrame;
use strandline_gpu::{Buffer, Gpu};

use crate::gpu::GpuRunner;
use crate::grab::Grab;
use crate::journal::{Entry, Journal};
use crate::length_scale::Lengths;
use crate::{CpuRunner, Drive, Model, Settings, SimError, State, StepReport};

/// A model, a state and the runner that advances it.
///
/// A state on a device stays there. It is read when it is asked for; and every `simulation.checkpoint_every` steps
/// without a wait, so that the CPU can resume from it where the device fails. Reports of steps on a device come when
/// they have arrived.
pub struct Simulator {
    runner: Runner,
    /// The state, of a device as it was last read, and what happened since.
    journal: Journal,
    /// True after a failed run of the device: its state is unknown.
    lost: bool,
    reports: Reports,
}

/// Reports in order: each step is reported once, also where it is computed again.
#[derive(Default)]
struct Reports {
    /// Steps that were reported.
    reported: u64,
    /// Steps before that of the next report from the device.
    next: u64,
    /// Reports to be returned next.
    kept: Vec<StepReport>,
}

impl Reports {
    /// Keeps those of the next steps that were not reported yet.
    fn keep(&mut self, found: Vec<StepReport>) {
        let known = self.reported.saturating_sub(self.next).min(found.len() as u64);
        self.next += found.len() as u64;
        self.reported = self.reported.max(self.next);
        self.kept.extend(found.into_iter().skip(known as usize));
    }

    fn take(&mut self) -> Vec<StepReport> {
        std::mem::take(&mut self.kept)
    }
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
        let journal = Journal::new(model.rest_state(BodyFrame::REST), model.settings().clone());
        let runner = match gpu {
            Some(gpu) => Runner::Gpu(GpuRunner::new(gpu, model)?.into()),
            None => Runner::Cpu(Box::new(model.into())),
        };
        Ok(Self { runner, journal, lost: false, reports: Reports::default() })
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

    /// Solids on the device, in rows that `solid_rows` of crates/body describes: their buffer, the row of it from which
    /// others are counted, and the row of the first solid counted from there.
    pub fn device_solids(&self) -> Option<(Buffer<[u32; 4]>, [usize; 2])> {
        match &self.runner {
            Runner::Gpu(runner) => Some(runner.solids()),
            Runner::Cpu(_) => None,
        }
    }

    /// Time of the state \[s\].
    pub fn time(&self) -> f64 {
        match &self.runner {
            Runner::Cpu(_) => self.journal.state().time,
            Runner::Gpu(runner) => runner.time(),
        }
    }

    /// Steps made since the simulator was created.
    pub fn steps(&self) -> u64 {
        self.journal.steps()
    }

    /// The state. A device is waited for, unless nothing happened since it was last read.
    ///
    /// # Errors
    /// The device was lost; it would have to be waited for, and the host never waits.
    pub fn state(&mut self) -> Result<&State, SimError> {
        if self.journal.is_current() {
            return Ok(self.journal.state());
        }
        self.find()?;
        if let Runner::Gpu(runner) = &mut self.runner {
            // Refused here also where the copy would arrive at once.
            runner.gpu().check_wait("the state of the hair")?;
            let coming = runner.begin_read()?;
            // Steps before the state are not computed again: their reports are kept.
            self.reports.keep(runner.reports()?);
            self.journal.read(coming, runner.model())?;
        }
        Ok(self.journal.state())
    }

    /// True where [`Simulator::state`] would not wait. Else the state is asked for, and a later call finds it, unless steps
    /// are made between the two.
    ///
    /// # Errors
    /// The device was lost.
    pub fn has_state(&mut self) -> Result<bool, SimError> {
        if self.journal.is_current() {
            return Ok(true);
        }
        self.find()?;
        let Runner::Gpu(runner) = &mut self.runner else { return Ok(true) };
        self.reports.keep(runner.arrived_reports()?);
        self.journal.receive(self.reports.reported, runner.model());
        let is_there = self.journal.is_current();
        if !is_there && !self.journal.is_coming() {
            self.journal.send(runner.begin_read()?);
        }
        Ok(is_there)
    }

    /// Runs of steps that a device has not reported yet: 0 on the CPU. Never waits.
    ///
    /// # Errors
    /// The device was lost.
    pub fn runs_on_way(&mut self) -> Result<usize, SimError> {
        self.find()?;
        let Runner::Gpu(runner) = &mut self.runner else { return Ok(0) };
        self.reports.keep(runner.arrived_reports()?);
        Ok(runner.runs_on_way())
    }

    /// Never reports the steps that were made so far, however late their reports come.
    pub fn discard_reports(&mut self) {
        if let Runner::Gpu(runner) = &mut self.runner {
            runner.forget_reports();
        }
        let steps = self.journal.steps();
        self.reports = Reports { reported: steps, next: steps, kept: Vec::new() };
    }

    /// The state as it was last read: what a lost device leaves.
    pub fn last_state(&self) -> &State {
        self.journal.state()
    }

    /// The state after a step, for a picture under way whose device was lost: the CPU computes those of the last runs
    /// again. The last state that was read where the step lies too far back.
    pub fn state_after(&self, step: u64) -> Cow<'_, State> {
        self.journal.state_after(step, self.runner.model())
    }

    /// Restores the state of a device after a failed run: writes the last checkpoint and repeats the entries since.
    fn find(&mut self) -> Result<(), SimError> {
        let Runner::Gpu(runner) = &mut self.runner else { return Ok(()) };
        if !self.lost {
            return Ok(());
        }
        let (step, settings, state, entries) = self.journal.since();
        runner.forget_reports();
        runner.set_settings(settings)?;
        runner.write(state)?;
        self.reports.next = step;
        for entry in entries {
            match entry {
                Entry::Step(drive) => runner.step(drive)?,
                Entry::Settings(settings) => runner.set_settings(settings)?,
                Entry::Hold(grab) => runner.write_grab(grab)?,
                Entry::Lengths(scale) => runner.set_lengths(&Lengths::of(runner.model(), scale.clone()))?,
            }
        }
        self.journal.recall();
        self.lost = false;
        Ok(())
    }

    /// Strands in the hand.
    pub fn grabbed(&self) -> usize {
        self.journal.grab().count()
    }

    /// Advances by a step for each drive, and reports the steps that are done: on a device those whose reports have
    /// arrived, also of earlier runs; [`Simulator::reports`] waits for the others.
    ///
    /// # Errors
    /// The device has no memory left or was lost.
    pub fn run(&mut self, drives: &[Drive]) -> Result<Vec<StepReport>, SimError> {
        self.find()?;
        match &mut self.runner {
            Runner::Cpu(runner) => {
                let state = self.journal.advance(drives.len());
                self.reports.keep(drives.iter().map(|drive| runner.step(state, drive)).collect());
            }
            Runner::Gpu(runner) => {
                self.lost = true;
                for drive in drives {
                    runner.step(drive)?;
                }
                self.reports.keep(runner.arrived_reports()?);
                self.lost = false;
                self.journal.stepped(drives);
                self.journal.receive(self.reports.reported, runner.model());
                if self.journal.is_due()
                    && let Ok(coming) = runner.begin_read()
                {
                    self.journal.send(coming);
                }
            }
        }
        Ok(self.reports.take())
    }

    /// The reports of all steps that were not returned yet; a device is waited for.
    ///
    /// # Errors
    /// The device was lost.
    pub fn reports(&mut self) -> Result<Vec<StepReport>, SimError> {
        self.find()?;
        if let Runner::Gpu(runner) = &mut self.runner {
            self.reports.keep(runner.reports()?);
        }
        Ok(self.reports.take())
    }

    /// Changes the settings between two steps.
    ///
    /// # Errors
    /// A setting outside its range, or one that a device has not, then nothing changes; or the device was lost.
    pub fn set_settings(&mut self, settings: &Settings) -> Result<(), SimError> {
        // Another strand solver has other states.
        let other = settings.strands.method != self.model().settings().strands.method;
        if other {
            self.state()?;
        }
        match &mut self.runner {
            Runner::Cpu(runner) => runner.set_settings(settings)?,
            // The state was read above.
            Runner::Gpu(runner) if other => runner.set_settings_at(settings, self.journal.state())?,
            Runner::Gpu(runner) => runner.set_settings(settings)?,
        }
        self.journal.set(settings);
        if other {
            self.runner.model().give_sections(self.journal.state_mut());
            // States of the other solver have other sections.
            self.journal.restart();
        }
        Ok(())
    }

    /// Replaces the state.
    ///
    /// # Errors
    /// The device was lost; the state is then this one.
    pub fn set_state(&mut self, state: State) -> Result<(), SimError> {
        *self.journal.state_mut() = state;
        self.write()
    }

    /// Changes the state.
    ///
    /// # Errors
    /// The error of `change`, which then changes nothing; the device was lost.
    pub fn change<T>(
        &mut self,
        change: impl FnOnce(&mut State, &Model) -> Result<T, SimError>,
    ) -> Result<T, SimError> {
        self.state()?;
        let result = change(self.journal.state_mut(), self.runner.model())?;
        self.write().map(|()| result)
    }

    /// Brings the state to the device.
    fn write(&mut self) -> Result<(), SimError> {
        let Runner::Gpu(runner) = &mut self.runner else { return Ok(()) };
        self.journal.restart();
        if self.lost {
            // Reports of steps that do not count.
            runner.forget_reports();
            runner.set_settings(self.journal.since().1)?;
            self.reports.next = self.journal.steps();
        } else {
            // A device that failed shows below.
            self.reports.keep(runner.reports().unwrap_or_default());
        }
        self.lost = true;
        runner.write(self.journal.state())?;
        self.lost = false;
        Ok(())
    }

    /// Sets the length of every strand: see [`State::set_length_scale`]. A device is not waited for.
    ///
    /// # Errors
    /// As [`State::set_length_scale`]; the device was lost.
    pub fn set_length_scale(&mut self, scales: &[f32]) -> Result<(), SimError> {
        let lengths = Lengths::new(self.runner.model(), scales)?;
        self.find()?;
        match &mut self.runner {
            Runner::Cpu(_) => self.journal.state_mut().set_lengths(&lengths),
            Runner::Gpu(runner) => {
                runner.set_lengths(&lengths)?;
                self.journal.lengthen(lengths);
            }
        }
        Ok(())
    }

    /// Takes hair into a hand: see [`State::grab`]. Returns the number of strands.
    ///
    /// # Errors
    /// The device was lost.
    pub fn grab(&mut self, hand: Vec3, radius: f32) -> Result<usize, SimError> {
        self.state()?;
        let mut grab = Grab::default();
        if hand.is_finite() && radius.is_finite() {
            grab = Grab::new(self.runner.model(), &self.journal.state().positions, hand, radius);
        }
        let count = grab.count();
        self.hold(grab).map(|()| count)
    }

    /// Lets go of it. A device is not waited for.
    ///
    /// # Errors
    /// The device was lost.
    pub fn release(&mut self) -> Result<(), SimError> {
        self.hold(Grab::default())
    }

    /// Holds something in the hand from now on.
    fn hold(&mut self, grab: Grab) -> Result<(), SimError> {
        if let Runner::Gpu(runner) = &mut self.runner {
            runner.write_grab(&grab)?;
        }
        self.journal.hold(grab);
        Ok(())
    }

    /// Falls back to the CPU: from the state that was last read, through the steps that the device had made since.
    pub fn fall_back(&mut self) {
        if let Runner::Gpu(runner) = &self.runner {
            let (runner, reports) = self.journal.fall_back(runner.model().clone());
            self.reports.next = self.journal.steps() - reports.len() as u64;
            self.reports.keep(reports);
            (self.runner, self.lost) = (Runner::Cpu(runner.into()), false);
        }
    }
}
