//! A simulation on either backend, so that a law is written once.

use glam::Vec3;
use strandline_gpu::Gpu;
use strandline_sim::{Drive, Model, Simulator, State, StepReport};

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

    /// As [`On::either`], but a software adapter has the full number too where `STRANDLINE_FULL` is 1, as in
    /// `cargo xtask long`.
    pub fn short<T>(&self, full: T, software: T) -> T {
        if in_full() { full } else { self.either(full, software) }
    }

    /// One number, and a smaller one for the CPU where `STRANDLINE_FULL` is not 1.
    pub fn brief<T>(&self, full: T, brief: T) -> T {
        if matches!(self, Self::Cpu) && !in_full() { brief } else { full }
    }

    /// One bound for the CPU and software adapters, and one for hardware, whose arithmetic is not known to the bit.
    pub fn exact_or<T>(&self, exact: T, hardware: T) -> T {
        match self {
            Self::Gpu(gpu) if !gpu.adapter().software => hardware,
            _ => exact,
        }
    }
}

/// True in `cargo xtask long`, which sets `STRANDLINE_FULL` to 1: laws that are cut short elsewhere are whole.
pub fn in_full() -> bool {
    std::env::var_os("STRANDLINE_FULL").is_some_and(|value| value == "1")
}

/// A simulator on a backend that never fails.
pub struct Rig(Simulator);

impl Rig {
    /// The hair at rest.
    ///
    /// # Panics
    /// The device refuses.
    pub fn new(on: &On, model: Model) -> Self {
        let gpu = match on {
            On::Cpu => None,
            On::Gpu(gpu) => Some(gpu),
        };
        Self(Simulator::new(gpu, model).unwrap())
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
        let mut reports = self.0.run(drives).unwrap();
        reports.extend(self.0.reports().unwrap());
        reports
    }

    /// The state as it is now.
    ///
    /// # Panics
    /// The device refuses.
    pub fn state(&mut self) -> &State {
        self.0.state().unwrap()
    }

    /// Changes the state by hand.
    ///
    /// # Panics
    /// The device refuses.
    pub fn change(&mut self, change: impl FnOnce(&mut State)) {
        let changed = self.0.change(|state, _| {
            change(state);
            Ok(())
        });
        changed.unwrap();
    }

    /// Takes hair into a hand; the number of strands.
    ///
    /// # Panics
    /// The device refuses.
    pub fn grab(&mut self, hand: Vec3, radius: f32) -> usize {
        self.0.grab(hand, radius).unwrap()
    }

    /// The model.
    pub fn model(&self) -> &Model {
        self.0.model()
    }
}

/// Makes a test for each backend of a law: `law! { fn name(on) { ... } }`, where `on` is an [`On`]. One that takes a software
/// adapter long is left to `cargo xtask long` there: `law! { long fn name(on) { ... } }`.
#[macro_export]
macro_rules! law {
    ($(#[$attribute:meta])* fn $name:ident($on:ident) $body:block) => {
        $crate::law! { @ $crate::gpu, $(#[$attribute])* fn $name($on) $body }
    };
    ($(#[$attribute:meta])* long fn $name:ident($on:ident) $body:block) => {
        $crate::law! { @ $crate::gpu_in_full, $(#[$attribute])* fn $name($on) $body }
    };
    (@ $gpu:path, $(#[$attribute:meta])* fn $name:ident($on:ident) $body:block) => {
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
                if let Some(gpu) = $gpu() {
                    law(&$crate::On::Gpu(gpu));
                }
            }
        }
    };
}
