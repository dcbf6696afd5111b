//! States that were read from a device and what happened after each, so that the CPU can compute any later state again.

use std::borrow::Cow;

use strandline_groom::Lanes;

use crate::gpu::ComingState;
use crate::grab::Grab;
use crate::length_scale::Lengths;
use crate::{CpuRunner, Drive, Model, Settings, SimError, State, StepReport};

/// Checkpoints of a simulation and the entries between them.
///
/// On a device `past` holds the checkpoint before the last one, since a picture under way may show a step before the
/// last. On the CPU `past` holds only the checkpoints of a lost device, until the next run but one.
pub(crate) struct Journal {
    past: Vec<Span>,
    last: Span,
    /// A pending read of the device's state, and the number of entries of `last` before it.
    coming: Option<(ComingState, usize)>,
}

/// A change of a state.
pub(crate) enum Entry {
    /// A step.
    Step(Drive),
    /// A change of the settings; the strands are solved by the same method.
    Settings(Box<Settings>),
    /// A change of what the hand holds.
    Hold(Grab),
    /// A change of the lengths of strands: each over its rest length, shape `[block]` of lanes.
    Lengths(Vec<Lanes>),
}

/// A state and what happened after it.
struct Span {
    /// Steps made before the state.
    step: u64,
    settings: Settings,
    state: State,
    entries: Vec<Entry>,
}

impl Span {
    /// Steps made before its end.
    fn end(&self) -> u64 {
        self.step + steps(&self.entries)
    }

    /// The settings at its end.
    fn settings_at_end(&self) -> &Settings {
        let changed = self.entries.iter().rev().find_map(|entry| match entry {
            Entry::Settings(settings) => Some(&**settings),
            Entry::Step(_) | Entry::Hold(_) | Entry::Lengths(_) => None,
        });
        changed.unwrap_or(&self.settings)
    }

    /// The hair in the hand at its end.
    fn grab_at_end(&self) -> &Grab {
        let changed = self.entries.iter().rev().find_map(|entry| match entry {
            Entry::Hold(grab) => Some(grab),
            Entry::Step(_) | Entry::Settings(_) | Entry::Lengths(_) => None,
        });
        changed.unwrap_or(&self.state.grab)
    }

    /// The lengths of strands at its end.
    fn lengths_at_end(&self, model: &Model) -> Lengths {
        let changed = self.entries.iter().rev().find_map(|entry| match entry {
            Entry::Lengths(scale) => Some(Lengths::of(model, scale.clone())),
            Entry::Step(_) | Entry::Settings(_) | Entry::Hold(_) => None,
        });
        changed.unwrap_or_else(|| self.state.all_lengths())
    }

    /// A span of its state without what happened after it.
    fn begin(&self) -> Self {
        let Self { step, settings, state, .. } = self;
        Self { step: *step, settings: settings.clone(), state: state.clone(), entries: Vec::new() }
    }

    /// The span that follows, of the state at the end of this one.
    fn next(&self, state: State, entries: Vec<Entry>) -> Self {
        Self { step: self.end(), settings: self.settings_at_end().clone(), state, entries }
    }

    /// Computes its entries again on the CPU, as far as the state after a step.
    fn replay(&self, model: Model, step: u64) -> (CpuRunner, State, Vec<StepReport>) {
        let mut runner = CpuRunner::from(model);
        // All of these settings were accepted before.
        runner.set_settings(&self.settings).unwrap_or_default();
        let (mut state, mut reports) = (self.state.clone(), Vec::new());
        for entry in &self.entries {
            match entry {
                Entry::Step(_) if self.step + reports.len() as u64 == step => break,
                Entry::Step(drive) => reports.push(runner.step(&mut state, drive)),
                Entry::Settings(settings) => runner.set_settings(settings).unwrap_or_default(),
                Entry::Hold(grab) => state.grab.clone_from(grab),
                Entry::Lengths(scale) => state.set_lengths(&Lengths::of(runner.model(), scale.clone())),
            }
        }
        (runner, state, reports)
    }
}

impl Journal {
    /// Begins with a state.
    pub fn new(state: State, settings: Settings) -> Self {
        let last = Span { step: 0, settings, state, entries: Vec::new() };
        Self { past: Vec::new(), last, coming: None }
    }

    /// Steps made.
    pub fn steps(&self) -> u64 {
        self.last.end()
    }

    /// The last checkpoint.
    pub fn state(&self) -> &State {
        &self.last.state
    }

    /// The hair in the hand now.
    pub fn grab(&self) -> &Grab {
        self.last.grab_at_end()
    }

    /// The last checkpoint, to be changed. On a device [`Journal::restart`] has to follow.
    pub fn state_mut(&mut self) -> &mut State {
        &mut self.last.state
    }

    /// True if nothing happened since the last checkpoint.
    pub fn is_current(&self) -> bool {
        self.last.entries.is_empty()
    }

    /// The last checkpoint: steps made before it, its settings, the state, and what happened since.
    pub fn since(&self) -> (u64, &Settings, &State, &[Entry]) {
        let Span { step, settings, state, entries } = &self.last;
        (*step, settings, state, entries)
    }

    /// Records steps of a device.
    pub fn stepped(&mut self, drives: &[Drive]) {
        self.last.entries.extend(drives.iter().cloned().map(Entry::Step));
    }

    /// Records steps of the CPU and returns the state, which the caller advances by them.
    pub fn advance(&mut self, steps: usize) -> &mut State {
        if self.past.last().is_some_and(|left| left.step < self.last.step) {
            self.past.clear();
        }
        self.last.step += steps as u64;
        &mut self.last.state
    }

    /// Records a change of the settings.
    pub fn set(&mut self, settings: &Settings) {
        match self.last.entries.last_mut() {
            None => self.last.settings.clone_from(settings),
            Some(Entry::Settings(last)) => last.as_mut().clone_from(settings),
            Some(_) => self.last.entries.push(Entry::Settings(Box::new(settings.clone()))),
        }
    }

    /// Records the hair in the hand from now on.
    pub fn hold(&mut self, grab: Grab) {
        match self.is_current() {
            true => self.last.state.grab = grab,
            false => self.last.entries.push(Entry::Hold(grab)),
        }
    }

    /// Records lengths of strands that the device has applied.
    pub fn lengthen(&mut self, lengths: Lengths) {
        self.last.entries.push(Entry::Lengths(lengths.scale));
    }

    /// Starts a new span after the last checkpoint was changed or replaced.
    pub fn restart(&mut self) {
        (self.last.step, self.last.settings) = (self.last.end(), self.last.settings_at_end().clone());
        self.last.entries.clear();
        self.past.clear();
        self.coming = None;
    }

    /// Records a pending read of the device's current state.
    pub fn send(&mut self, coming: ComingState) {
        self.coming = Some((coming, self.last.entries.len()));
    }

    /// True if a read of the device's current state is pending.
    pub fn is_coming(&self) -> bool {
        self.coming.as_ref().is_some_and(|(_, count)| *count == self.last.entries.len())
    }

    /// Drops the pending read.
    pub fn recall(&mut self) {
        self.coming = None;
    }

    /// True if the next read of the state is due: none is pending, and `checkpoint_every` steps were made since the last
    /// checkpoint.
    pub fn is_due(&self) -> bool {
        let every = self.last.settings_at_end().checkpoint_every;
        self.coming.is_none() && self.last.end() - self.last.step >= u64::from(every)
    }

    /// Makes the pending state a checkpoint once it has arrived and all steps before it have reports; `reported` counts
    /// the steps with a report. Steps before a checkpoint are not computed again. A read that fails is dropped: the next
    /// run fails with the same error.
    pub fn receive(&mut self, reported: u64, model: &Model) {
        let Some((coming, count)) = self.coming.take() else { return };
        if self.last.step + steps(&self.last.entries[..count]) > reported {
            self.coming = Some((coming, count));
            return;
        }
        match coming.has_arrived() {
            Ok(true) => self.renew(coming, count, model).unwrap_or_default(),
            Ok(false) => self.coming = Some((coming, count)),
            Err(_) => {}
        }
    }

    /// Waits for the current state of the device and makes it a checkpoint.
    ///
    /// # Errors
    /// The device was lost; nothing changes.
    pub fn read(&mut self, coming: ComingState, model: &Model) -> Result<(), SimError> {
        self.renew(coming, self.last.entries.len(), model)
    }

    /// Makes the state after `count` entries the last checkpoint. The one before the last is dropped.
    fn renew(&mut self, coming: ComingState, count: usize, model: &Model) -> Result<(), SimError> {
        let mut spare = self.past.pop().unwrap_or_else(|| self.last.begin());
        if let Err(failure) = coming.write(&mut spare.state) {
            self.past.push(spare);
            return Err(failure);
        }
        let entries = self.last.entries.split_off(count);
        spare.state.keep_lengths(&self.last.lengths_at_end(model));
        let hand = spare.state.grab.hand;
        spare.state.grab = Grab { hand, ..self.last.grab_at_end().clone() };
        let next = self.last.next(spare.state, entries);
        self.past.push(std::mem::replace(&mut self.last, next));
        self.coming = None;
        Ok(())
    }

    /// Recomputes on the CPU all steps since the last checkpoint. Returns the runner that continues from there, and the
    /// reports of these steps.
    pub fn fall_back(&mut self, model: Model) -> (CpuRunner, Vec<StepReport>) {
        let (runner, state, reports) = self.last.replay(model, u64::MAX);
        let next = self.last.next(state, Vec::new());
        self.past.push(std::mem::replace(&mut self.last, next));
        self.past.push(self.last.begin());
        self.coming = None;
        (runner, reports)
    }

    /// The state after a step, recomputed on the CPU unless it is a checkpoint. For a step before the oldest checkpoint,
    /// the last checkpoint.
    pub fn state_after(&self, step: u64, model: &Model) -> Cow<'_, State> {
        let spans = || self.past.iter().rev().chain([&self.last]);
        if let Some(span) = spans().find(|span| span.step == step) {
            return Cow::Borrowed(&span.state);
        }
        match spans().find(|span| (span.step..=span.end()).contains(&step)) {
            Some(span) => Cow::Owned(span.replay(model.clone(), step).1),
            None => Cow::Borrowed(&self.last.state),
        }
    }
}

/// Steps among entries.
fn steps(entries: &[Entry]) -> u64 {
    entries.iter().filter(|entry| matches!(entry, Entry::Step(_))).count() as u64
}
