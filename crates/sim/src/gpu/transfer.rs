//! States on their way between host and device.

use std::sync::Arc;

use glam::Vec3;
use strandline_body::BodyFrame;
use strandline_gpu::{Copied, Readback, Slot, Transfer};

use super::buffers::Buffers;
use super::buffers::{floats, floats_mut, speeds};
use super::rod_buffers::RodBuffers;
use super::rod_crowd_buffers::{Rounds, to_pairs};
use super::runner::GpuRunner;
use super::volume::GridState;
use crate::grab::Grab;
use crate::{Settings, SimError, State};

impl GpuRunner {
    /// As [`GpuRunner::set_settings`] where the current state was read: another strand solver begins with it, and nothing
    /// waits.
    ///
    /// # Errors
    /// As there.
    pub(crate) fn set_settings_at(&mut self, settings: &Settings, state: &State) -> Result<(), SimError> {
        if !self.model.settings.change_to(settings).buffers {
            return self.set_settings(settings);
        }
        settings.check_on_gpu()?;
        self.gpu.check()?;
        self.pending.send(&self.gpu, &self.buffers.reports)?;
        self.rebuild(settings, state)
    }

    /// Begins with the current state in other buffers: another strand solver has others.
    pub(super) fn rebuild(&mut self, settings: &Settings, state: &State) -> Result<(), SimError> {
        let mut model = self.model.clone();
        model.set_settings(settings)?;
        self.buffers = Buffers::new(&self.gpu, &model, state)?;
        (self.model, self.side, self.bound) = (model, 0, None);
        Ok(())
    }

    /// Makes the buffers of strands that push each other fit the settings, anew where these are of `other` strands.
    pub(super) fn fit_crowd(&mut self, other: bool) -> Result<(), SimError> {
        let (gpu, model) = (&self.gpu, &self.model);
        let Some(rods) = &mut self.buffers.rods else { return Ok(()) };
        let wanted = model.settings.has_contact().then(|| Rounds::new(&model.settings));
        let had = rods.crowd.as_ref().map(|crowd| crowd.rounds);
        if had.is_some() == wanted.is_some() {
            if let (Some(crowd), Some(rounds)) = (&mut rods.crowd, wanted) {
                crowd.rounds = rounds;
                if other {
                    crowd.radii.write(bytemuck::cast_slice(&model.radii))?;
                }
            }
        } else {
            let RodBuffers { work, crowd, .. } = RodBuffers::new(gpu, model)?;
            (rods.work, rods.crowd) = (work, crowd);
        }
        if had != wanted {
            self.bound = None;
        }
        Ok(())
    }

    /// Runs of steps whose reports have not arrived.
    pub(crate) fn runs_on_way(&self) -> usize {
        self.pending.on_way()
    }

    /// Waits for the device and copies the state back.
    ///
    /// # Errors
    /// The device was lost.
    pub fn state(&self) -> Result<State, SimError> {
        let mut state = self.model.rest_state(self.body.clone());
        state.length_scale.clone_from(&self.length_scale);
        state.grab.clone_from(&self.grab);
        state.lengths = Arc::clone(&self.lengths);
        self.read_into(&mut state)?;
        Ok(state)
    }

    /// Waits for the device and copies what time changes into a state of the host: positions, those of one step ago,
    /// the body and the time; and the velocities with their corrections, of rods how their sections are
    /// turned.
    ///
    /// # Errors
    /// The device was lost; the state is then as it was.
    pub fn read_into(&self, state: &mut State) -> Result<(), SimError> {
        self.begin_read()?.write(state)
    }

    /// Begins to copy the current state to the host. [`ComingState`] receives it.
    ///
    /// # Errors
    /// The device was lost.
    pub fn begin_read(&self) -> Result<ComingState, SimError> {
        let [positions, previous] = self.positions();
        let velocities = &self.buffers.velocities;
        let mut batch = Readback::new();
        let slots = [positions, previous, velocities].map(|buffer| batch.add(buffer, buffer.len()));
        let grid = self.buffers.volume.as_ref().map(|volume| batch.add(&volume.grid, 1));
        let crowd = self.buffers.crowd().map(|crowd| batch.add(&crowd.kept, crowd.kept.len()));
        let transfer = batch.begin(velocities.gpu())?;
        let content = Content {
            slots,
            grid,
            crowd,
            has_rods: self.buffers.rods.is_some(),
            body: self.body.clone(),
            time: self.time,
            hand: self.grab.hand,
        };
        Ok(ComingState { transfer, content })
    }

    /// Replaces the state on the device by one of the host.
    ///
    /// # Errors
    /// The device was lost.
    pub fn write(&mut self, state: &State) -> Result<(), SimError> {
        self.buffers.write_rest(&self.model, &state.lengths)?;
        self.buffers.places[self.side].write(floats(&state.positions))?;
        self.buffers.places[1 - self.side].write(floats(&state.previous_positions))?;
        self.buffers.velocities.write(&speeds(&self.model.with_sections(state)))?;
        self.buffers.write_pairs(state)?;
        self.length_scale.clone_from(&state.length_scale);
        self.lengths = Arc::clone(&state.lengths);
        self.volume_box = state.volume_box;
        if let (Some(volume), None) = (&self.buffers.volume, state.volume_box) {
            volume.put_at_start()?;
        }
        self.body = state.body.clone();
        self.time = state.time;
        self.write_grab(&state.grab)
    }

    /// Holds on the device what a hand holds: see [`State::grab`].
    pub(crate) fn write_grab(&mut self, grab: &Grab) -> Result<(), SimError> {
        self.buffers.write_grips(grab)?;
        self.grab.clone_from(grab);
        Ok(())
    }
}

/// A pending copy of a state to the host.
#[derive(Debug)]
pub struct ComingState {
    transfer: Transfer,
    content: Content,
}

/// Places of its arrays in the copied bytes, and what the host knew.
#[derive(Debug)]
struct Content {
    slots: [Slot<f32>; 3],
    grid: Option<Slot<GridState>>,
    /// Memory of the pairs of strands.
    crowd: Option<Slot<[f32; 4]>>,
    has_rods: bool,
    body: BodyFrame,
    time: f64,
    hand: Vec3,
}

impl ComingState {
    /// True if it has arrived; never waits.
    ///
    /// # Errors
    /// The device was lost.
    pub fn has_arrived(&self) -> Result<bool, SimError> {
        Ok(self.transfer.has_arrived()?)
    }

    /// Writes what time changes into a state of the same strands; waits where it has not arrived.
    ///
    /// # Errors
    /// The device was lost; the state is then as it was.
    pub fn write(self, state: &mut State) -> Result<(), SimError> {
        self.content.write(&self.transfer.take()?, state);
        Ok(())
    }
}

impl Content {
    fn write(&self, copied: &Copied, state: &mut State) {
        let grid = self.grid.clone();
        state.volume_box = grid.and_then(|grid| copied.take(grid).first().map(GridState::place));
        let [positions, previous, velocities] = self.slots.clone().map(|slot| copied.take(slot));
        floats_mut(&mut state.positions).copy_from_slice(&positions);
        floats_mut(&mut state.previous_positions).copy_from_slice(&previous);
        let count = positions.len() / 3;
        let (velocities, others) = velocities.split_at(3 * count);
        floats_mut(&mut state.velocities).copy_from_slice(velocities);
        if self.has_rods {
            let (others, tensions) = others.split_at(others.len() - count);
            let (others, forces) = others.split_at(others.len() - 3 * count);
            floats_mut(&mut state.corrections).copy_from_slice(&others[others.len() - 3 * count..]);
            state.take_loads(forces, tensions);
            floats_mut(&mut state.sections).copy_from_slice(&others[..3 * count]);
            bytemuck::cast_slice_mut(&mut state.spins).copy_from_slice(&others[3 * count..4 * count]);
        } else {
            floats_mut(&mut state.corrections).copy_from_slice(others);
        }
        state.pairs = self.crowd.clone().map_or_else(Vec::new, |kept| to_pairs(&copied.take(kept), count));
        state.body = self.body.clone();
        state.time = self.time;
        state.grab.hand = self.hand;
    }
}
