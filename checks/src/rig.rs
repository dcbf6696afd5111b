//! A simulation on either backend, so that a law is written once.

use glam::Vec3;
use strandline_body::Pose;
use strandline_gpu::Gpu;
use strandline_sim::gpu::{GpuSolver, GpuState};
use strandline_sim::{Drive, Solver, State, StepReport};

/// The backend that a law is tried on.
#[derive(Clone, Debug)]
pub enum On {
    /// Plain Rust.
    Cpu,
    /// Kernels.
    Gpu(Gpu),
}

impl On {
    /// One number, and a smaller one for a software adapter, which would take too long.
    pub fn either<T>(&self, full: T, software: T) -> T {
        match self {
            Self::Gpu(gpu) if gpu.adapter().software => software,
            _ => full,
        }
    }
}

/// A solver and a state on a backend.
pub struct Rig {
    place: Place,
    state: State,
    /// Whether the device has gone on since the state was read.
    stale: bool,
}

enum Place {
    Cpu(Box<Solver>),
    Gpu(Box<(GpuSolver, GpuState)>),
}

impl Rig {
    /// The hair at rest.
    ///
    /// # Panics
    /// The device refuses.
    pub fn new(on: &On, solver: Solver) -> Self {
        let state = solver.rest_state(Pose::IDENTITY);
        let place = match on {
            On::Cpu => Place::Cpu(solver.into()),
            On::Gpu(gpu) => {
                let solver = GpuSolver::new(gpu, solver).unwrap();
                let device = solver.upload(&state).unwrap();
                Place::Gpu(Box::new((solver, device)))
            }
        };
        Self { place, state, stale: false }
    }

    /// Advances by a step.
    ///
    /// # Panics
    /// The device refuses.
    pub fn step(&mut self, drive: &Drive) -> StepReport {
        self.steps(std::slice::from_ref(drive)).pop().unwrap_or_default()
    }

    /// Advances by a step for each drive; a device waits only at the end.
    ///
    /// # Panics
    /// The device refuses.
    pub fn steps(&mut self, drives: &[Drive]) -> Vec<StepReport> {
        match &mut self.place {
            Place::Cpu(solver) => drives.iter().map(|drive| solver.step(&mut self.state, drive)).collect(),
            Place::Gpu(pair) => {
                for drive in drives {
                    pair.0.step(&mut pair.1, drive).unwrap();
                }
                self.stale = true;
                pair.0.reports(&mut pair.1).unwrap()
            }
        }
    }

    /// The state as it is now.
    ///
    /// # Panics
    /// The device refuses.
    pub fn state(&mut self) -> &State {
        if let Place::Gpu(pair) = &self.place
            && std::mem::take(&mut self.stale)
        {
            pair.1.read_into(&mut self.state).unwrap();
        }
        &self.state
    }

    /// Changes the state by hand.
    ///
    /// # Panics
    /// The device refuses.
    pub fn change(&mut self, change: impl FnOnce(&mut State)) {
        self.state();
        change(&mut self.state);
        if let Place::Gpu(pair) = &mut self.place {
            pair.1.write(&pair.0, &self.state).unwrap();
        }
    }

    /// Takes hair into a hand; the number of strands.
    ///
    /// # Panics
    /// The device refuses.
    pub fn grab(&mut self, hand: Vec3, radius: f32) -> usize {
        self.state();
        match &mut self.place {
            Place::Cpu(solver) => self.state.grab(solver, hand, radius),
            Place::Gpu(pair) => {
                let count = self.state.grab(pair.0.solver(), hand, radius);
                pair.1.write_grab(&self.state).unwrap();
                count
            }
        }
    }

    /// The solver.
    pub fn solver(&self) -> &Solver {
        match &self.place {
            Place::Cpu(solver) => solver,
            Place::Gpu(pair) => pair.0.solver(),
        }
    }
}

/// Makes a test for each backend of a law: `law! { fn name(on) { ... } }`, where `on` is an [`On`].
#[macro_export]
macro_rules! law {
    ($(#[$attribute:meta])* fn $name:ident($on:ident) $body:block) => {
        $(#[$attribute])*
        mod $name {
            #[allow(unused_imports)]
            use super::*;

            fn law($on: &$crate::On) $body

            #[test]
            fn cpu() {
                law(&$crate::On::Cpu);
            }

            #[test]
            fn gpu() {
                if let Some(gpu) = $crate::gpu() {
                    law(&$crate::On::Gpu(gpu));
                }
            }
        }
    };
}
