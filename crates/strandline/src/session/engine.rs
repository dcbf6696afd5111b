//! The simulation, which falls back to the CPU when its GPU fails, if allowed.

use std::borrow::Cow;

use glam::Vec3;
use strandline_gpu::{Buffer, Gpu, GpuError};

use crate::{
    body::BodyFrame,
    groom::Vec3Lanes,
    render::gpu::DeviceSolids,
    sim::{Checkpoint, Drift, Drive, Measures, Model, Settings, SimError, Simulator, State, StepReport},
    snapshot::hair_pose::HairPose,
};

/// A simulator that outlives its device.
pub(crate) struct Engine {
    simulator: Simulator,
    /// True where the run falls back to the CPU when the GPU fails.
    pub fall_back: bool,
    /// Notes, human-readable.
    pub notes: Vec<String>,
}

impl Engine {
    /// Puts a model on a device, or on the CPU without one.
    pub fn new(gpu: Option<&Gpu>, model: Model, fall_back: bool) -> Result<Self, SimError> {
        let spare = (fall_back && gpu.is_some()).then(|| model.clone());
        let (simulator, notes) = match (Simulator::new(gpu, model), spare) {
            (Ok(simulator), _) => {
                let software = gpu.map(Gpu::adapter).filter(|adapter| adapter.software);
                let slow = |adapter| format!("{adapter}: for tests; `--backend cpu` is many times faster");
                (simulator, software.map(slow).into_iter().collect())
            }
            (Err(error), Some(model)) => {
                (Simulator::new(None, model)?, vec![format!("simulating on the CPU: {error}")])
            }
            (Err(error), None) => return Err(error),
        };
        Ok(Self { simulator, fall_back, notes })
    }

    pub fn model(&self) -> &Model {
        self.simulator.model()
    }

    /// The device, while the simulation runs on one.
    pub fn gpu(&self) -> Option<&Gpu> {
        self.simulator.gpu()
    }

    /// Positions on the device \[m\] at the last state and at the one before it.
    pub fn device_points(&self) -> Option<[&Buffer<f32>; 2]> {
        self.simulator.device_points()
    }

    /// Solids on a device, if the simulation runs there.
    pub fn device_solids(&self, gpu: &Gpu) -> Option<DeviceSolids> {
        let (rows, [base, first]) = self.simulator.device_solids()?;
        gpu.is_same(rows.gpu()).then_some(DeviceSolids { rows, base, first })
    }

    /// Strands in the hand.
    pub fn grabbed(&self) -> usize {
        self.simulator.grabbed()
    }

    /// The state. A device is waited for.
    pub fn state(&mut self) -> Result<&State, SimError> {
        self.guarded(|simulator| simulator.state().map(|_| ()))?;
        Ok(self.simulator.last_state())
    }

    /// The state as it was last read.
    pub fn last_state(&self) -> &State {
        self.simulator.last_state()
    }

    /// Steps made since it began.
    pub fn steps(&self) -> u64 {
        self.simulator.steps()
    }

    /// The reports of all steps that were not returned yet; a device is waited for.
    pub fn reports(&mut self) -> Result<Vec<StepReport>, SimError> {
        self.guarded(Simulator::reports)
    }

    /// True where [`Engine::state`] would not wait; else the state is asked for.
    pub fn has_state(&mut self) -> Result<bool, SimError> {
        self.guarded(Simulator::has_state)
    }

    /// Runs of steps that a device has not reported yet.
    pub fn runs_on_way(&mut self) -> Result<usize, SimError> {
        self.guarded(Simulator::runs_on_way)
    }

    /// Never reports the steps that were made so far.
    pub fn discard_reports(&mut self) {
        self.simulator.discard_reports();
    }

    /// The state after a step whose device was lost: see [`Simulator::state_after`].
    pub fn state_after(&self, step: u64) -> Cow<'_, State> {
        self.simulator.state_after(step)
    }

    /// Distance of the hair from the groom as loaded, which the head carries.
    pub fn drift(&mut self) -> Result<Drift, SimError> {
        self.state()?;
        Ok(self.model().drift(self.simulator.last_state()))
    }

    /// Measures of the hair in the air of a drive; a device is waited for.
    pub fn measures(&mut self, drive: &Drive) -> Result<Measures, SimError> {
        self.state()?;
        Ok(self.model().measures(self.simulator.last_state(), drive))
    }

    pub fn take_notes(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notes)
    }

    /// Runs steps. When the GPU fails they run on the CPU, or not at all.
    pub fn run(&mut self, drives: &[Drive]) -> Result<Vec<StepReport>, SimError> {
        self.guarded(|simulator| simulator.run(drives))
    }

    /// Changes the settings between two steps.
    pub fn set_settings(&mut self, settings: &Settings) -> Result<(), SimError> {
        self.guarded(|simulator| simulator.set_settings(settings))
    }

    /// Puts every strand back to rest on a body; their lengths stay.
    pub fn reset(&mut self, body: BodyFrame) -> Result<(), SimError> {
        self.guarded(|simulator| {
            simulator.change(|state, model| {
                *state = rest(state, model, body.clone())?;
                Ok(())
            })
        })
    }

    /// Puts every strand where a pose of hair has it; their lengths stay.
    pub fn place(&mut self, hair: &HairPose) -> Result<(), SimError> {
        self.guarded(|simulator| {
            simulator.change(|state, model| {
                *state = rest(state, model, hair.body().clone())?;
                hair.place(state);
                Ok(())
            })
        })
    }

    /// Moves the body to another place at once and carries the hair with it.
    pub fn carry(&mut self, body: &BodyFrame) -> Result<(), SimError> {
        self.guarded(|simulator| {
            simulator.change(|state, model| {
                state.carry(model, body);
                Ok(())
            })
        })
    }

    /// Goes back to a state that was saved.
    pub fn restore(&mut self, from: &Checkpoint) -> Result<(), SimError> {
        self.guarded(|simulator| simulator.change(|state, model| state.restore(model, from)))
    }

    /// Puts every point where `place` has it, with no motion of its own.
    pub fn show(&mut self, place: impl Fn(&mut [Vec3Lanes])) -> Result<(), SimError> {
        self.guarded(|simulator| {
            simulator.change(|state, _| {
                place(&mut state.positions);
                state.previous_positions.clone_from(&state.positions);
                Ok(())
            })
        })
    }

    /// Takes hair into a hand; returns the number of strands.
    pub fn grab(&mut self, hand: Vec3, radius: f32) -> Result<usize, SimError> {
        self.guarded(|simulator| simulator.grab(hand, radius))
    }

    /// Lets go of it.
    pub fn release(&mut self) -> Result<(), SimError> {
        self.guarded(Simulator::release)
    }

    /// Scales the length of every strand of hair that has not moved yet: on the host, so that what follows reads nothing from
    /// a device.
    pub fn begin_with_lengths(&mut self, scales: &[f32]) -> Result<(), SimError> {
        self.guarded(|simulator| simulator.change(|state, model| state.set_length_scale(model, scales)))
    }

    /// Scales the length of every strand.
    pub fn set_length_scale(&mut self, scales: &[f32]) -> Result<(), SimError> {
        self.guarded(|simulator| simulator.set_length_scale(scales))
    }

    /// Does something; where the device fails, and it is allowed, again on the CPU.
    fn guarded<T>(&mut self, act: impl Fn(&mut Simulator) -> Result<T, SimError>) -> Result<T, SimError> {
        match act(&mut self.simulator) {
            Err(failure)
                if self.fall_back && failure.gpu().is_some_and(is_failure) && self.gpu().is_some() =>
            {
                self.simulator.fall_back();
                self.note(&failure);
                act(&mut self.simulator)
            }
            done => done,
        }
    }

    /// Falls back to the CPU after a failure of the device, from the state that was last read and through the steps since.
    pub fn fall_back_after(&mut self, failure: &str) {
        if self.gpu().is_some() {
            self.simulator.fall_back();
            self.note(failure);
        }
    }

    fn note(&mut self, failure: impl std::fmt::Display) {
        let time = self.simulator.time();
        self.notes.push(format!("falling back to the CPU, resuming from {time:.3} s: {failure}"));
    }
}

/// True but for a wait that the host refuses, which asks in its place and keeps the device.
fn is_failure(error: &GpuError) -> bool {
    !matches!(error, GpuError::WouldWait { .. })
}

/// Strands at rest on a body, of the lengths that those of a state have.
fn rest(state: &State, model: &Model, body: BodyFrame) -> Result<State, SimError> {
    let scales: Vec<f32> = (0..model.strand_count()).map(|strand| state.length_scale(strand)).collect();
    let mut state = model.rest_state(body);
    // Points slide along their strands, which is exact but for rounding.
    if scales.iter().any(|scale| *scale != 1.0) {
        state.set_length_scale(model, &scales)?;
    }
    Ok(state)
}
