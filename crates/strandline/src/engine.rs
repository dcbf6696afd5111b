//! The simulation on whichever backend it runs.

use std::time::Instant;

use glam::Vec3;
use strandline_gpu::Gpu;

use crate::{
    Error,
    body::Pose,
    groom::Vec3Lanes,
    hair_pose::HairPose,
    sim::{
        Checkpoint, Drive, Settings, SimError, Solver, State, StepReport,
        gpu::{GpuSolver, GpuState},
    },
};

/// A solver and its state; a state on a GPU is mirrored on the host after every run of steps.
pub(crate) struct Engine {
    place: Place,
    state: State,
    /// Whether the run goes on on the CPU when the GPU fails.
    pub fall_back: bool,
    /// What happened on the way, human-readable.
    pub notes: Vec<String>,
}

enum Place {
    Cpu(Box<Solver>),
    Gpu(Box<(GpuSolver, GpuState)>),
}

impl Engine {
    /// Puts a solver on a device, or on the CPU without one.
    pub fn new(gpu: Option<&Gpu>, solver: Solver, fall_back: bool) -> Result<Self, SimError> {
        let state = solver.rest_state(Pose::IDENTITY);
        let Some(gpu) = gpu else {
            return Ok(Self { place: Place::Cpu(solver.into()), state, fall_back, notes: Vec::new() });
        };
        let spare = fall_back.then(|| solver.clone());
        let placed = GpuSolver::new(gpu, solver).and_then(|solver| {
            let device = solver.upload(&state)?;
            Ok(Place::Gpu(Box::new((solver, device))))
        });
        match (placed, spare) {
            (Ok(place), _) => {
                let adapter = gpu.adapter();
                let slow = format!("{adapter}: for tests; `--backend cpu` is many times faster");
                let notes = adapter.software.then_some(slow).into_iter().collect();
                Ok(Self { place, state, fall_back, notes })
            }
            (Err(error), Some(solver)) => {
                let notes = vec![format!("simulating on the CPU: {error}")];
                Ok(Self { place: Place::Cpu(solver.into()), state, fall_back, notes })
            }
            (Err(error), None) => Err(error),
        }
    }

    pub fn solver(&self) -> &Solver {
        match &self.place {
            Place::Cpu(solver) => solver,
            Place::Gpu(pair) => pair.0.solver(),
        }
    }

    /// The device, while the simulation runs on one.
    pub fn gpu(&self) -> Option<&Gpu> {
        match &self.place {
            Place::Gpu(pair) => Some(pair.0.gpu()),
            Place::Cpu(_) => None,
        }
    }

    /// Positions on the device \[m\] at the last state and at the one before it.
    pub fn device_points(&self) -> Option<[&strandline_gpu::Buffer<f32>; 2]> {
        match &self.place {
            Place::Gpu(pair) => Some(pair.1.positions()),
            Place::Cpu(_) => None,
        }
    }

    /// The state after the last run of steps.
    pub fn state(&self) -> &State {
        &self.state
    }

    pub fn take_notes(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notes)
    }

    /// Runs steps. When the GPU fails they run from the last state on the CPU, or not at all.
    pub fn run(&mut self, drives: &[Drive]) -> Result<Vec<StepReport>, SimError> {
        let failure = match &mut self.place {
            Place::Gpu(pair) => {
                let (solver, device) = &mut **pair;
                match run_on_gpu(solver, device, drives, &mut self.state) {
                    Ok(reports) => return Ok(reports),
                    Err(failure) => failure,
                }
            }
            Place::Cpu(solver) => {
                return Ok(drives.iter().map(|drive| solver.step(&mut self.state, drive)).collect());
            }
        };
        self.recover(failure)?;
        self.run(drives)
    }

    /// Changes the settings between two steps.
    pub fn set_settings(&mut self, settings: &Settings) -> Result<(), SimError> {
        let failure = match &mut self.place {
            Place::Cpu(solver) => return solver.set_settings(settings),
            Place::Gpu(pair) => match pair.0.set_settings(settings, &mut pair.1) {
                Ok(()) => return Ok(()),
                Err(error) if error.gpu().is_none() => return Err(error),
                Err(failure) => failure,
            },
        };
        self.recover(failure)?;
        self.set_settings(settings)
    }

    /// Puts every strand back to rest under a pose of the head; their lengths stay.
    pub fn reset(&mut self, pose: Pose) -> Result<(), SimError> {
        let state = self.rest(pose)?;
        self.set_state(state)
    }

    /// Puts every strand where a pose of hair has it; their lengths stay.
    pub fn place(&mut self, hair: &HairPose) -> Result<(), SimError> {
        let mut state = self.rest(hair.world_from_head())?;
        hair.place(&mut state);
        self.set_state(state)
    }

    /// Goes back to a state that was saved.
    pub fn restore(&mut self, from: &Checkpoint) -> Result<(), SimError> {
        let mut state = self.state.clone();
        state.restore(self.solver(), from)?;
        self.set_state(state)
    }

    /// Puts every point where `place` has it, with no motion of its own.
    pub fn show(&mut self, place: impl FnOnce(&mut [Vec3Lanes])) -> Result<(), SimError> {
        place(&mut self.state.positions);
        self.state.previous_positions.clone_from(&self.state.positions);
        self.upload()
    }

    fn rest(&self, pose: Pose) -> Result<State, SimError> {
        let scales = (0..self.solver().strand_count()).map(|strand| self.state.length_scale(strand));
        let scales: Vec<f32> = scales.collect();
        let mut state = self.solver().rest_state(pose);
        // Points slide along their strands, which is exact but for rounding.
        if scales.iter().any(|scale| *scale != 1.0) {
            state.set_length_scale(self.solver(), &scales)?;
        }
        Ok(state)
    }

    fn set_state(&mut self, state: State) -> Result<(), SimError> {
        self.state = state;
        self.upload()
    }

    /// Brings the state to the device.
    fn upload(&mut self) -> Result<(), SimError> {
        let failure = match &mut self.place {
            Place::Cpu(_) => return Ok(()),
            Place::Gpu(pair) => match pair.1.write(&pair.0, &self.state) {
                Ok(()) => return Ok(()),
                Err(failure) => failure,
            },
        };
        self.recover(failure)
    }

    /// Takes hair into a hand; returns the number of strands.
    pub fn grab(&mut self, hand: Vec3, radius: f32) -> Result<usize, SimError> {
        let count = match &self.place {
            Place::Cpu(solver) => self.state.grab(solver, hand, radius),
            Place::Gpu(pair) => self.state.grab(pair.0.solver(), hand, radius),
        };
        self.hold().map(|()| count)
    }

    /// Lets go of it.
    pub fn release(&mut self) -> Result<(), SimError> {
        self.state.release();
        self.hold()
    }

    /// Holds on the device what the state's hand holds.
    fn hold(&mut self) -> Result<(), SimError> {
        match &mut self.place {
            Place::Cpu(_) => Ok(()),
            Place::Gpu(pair) => match pair.1.write_grab(&self.state) {
                Ok(()) => Ok(()),
                Err(failure) => self.recover(failure),
            },
        }
    }

    /// Scales the length of every strand.
    pub fn set_length_scale(&mut self, scales: &[f32]) -> Result<(), SimError> {
        let failure = match &mut self.place {
            Place::Cpu(solver) => return self.state.set_length_scale(solver, scales),
            Place::Gpu(pair) => {
                self.state.set_length_scale(pair.0.solver(), scales)?;
                match pair.1.write(&pair.0, &self.state) {
                    Ok(()) => return Ok(()),
                    Err(failure) => failure,
                }
            }
        };
        // The mirrored state is scaled already.
        self.recover(failure)
    }

    /// Falls back to the CPU, resuming from the last state, if allowed.
    fn recover(&mut self, failure: SimError) -> Result<(), SimError> {
        if !self.fall_back {
            return Err(failure);
        }
        self.place = Place::Cpu(self.solver().clone().into());
        self.notes
            .push(format!("falling back to the CPU, resuming from {:.3} s: {failure}", self.state.time));
        Ok(())
    }
}

fn run_on_gpu(
    solver: &GpuSolver,
    device: &mut GpuState,
    drives: &[Drive],
    state: &mut State,
) -> Result<Vec<StepReport>, SimError> {
    let begin = Instant::now();
    if drives.is_empty() {
        return Ok(Vec::new());
    }
    // A run that failed may have left the device ahead of the state.
    if device.time() != state.time {
        device.write(solver, state)?;
        solver.reports(device)?;
    }
    for drive in drives {
        solver.step(device, drive)?;
    }
    let mut reports = solver.reports(device)?;
    let each = begin.elapsed().as_secs_f64() / drives.len() as f64;
    // A device without timestamps: the wait for it is all that is known.
    for report in reports.iter_mut().filter(|report| report.seconds.is_empty()) {
        report.seconds.push(("step", each));
    }
    device.read_into(state)?;
    Ok(reports)
}

impl From<strandline_gpu::GpuError> for Error {
    fn from(error: strandline_gpu::GpuError) -> Self {
        Self::Sim(error.into())
    }
}
