//! Motion of hair: rods or position-based strands, coupled to a FLIP volume [Chen2011 §4].
//!
//! [`Settings`] are plain data in SI units, a [`Model`] is compiled once and never changes, a
//! [`State`] is all that changes with time.

#![deny(unsafe_code)]
// except AVX instructions: strands/rods/avx.rs
// Some items are used only by the GPU backend.
#![cfg_attr(not(feature = "gpu"), allow(dead_code))]
#![cfg_attr(test, allow(clippy::disallowed_methods))] // tests may use inexact math

pub mod cells;
pub mod contact;
pub mod cpu;
#[cfg(feature = "gpu")]
pub mod gpu;
#[cfg(not(feature = "gpu"))]
#[path = "no_gpu.rs"]
pub mod gpu;

mod at_rest;
mod chebyshev;
mod checkpoint;
mod clock;
mod currents;
mod error;
mod grab;
mod journal;
mod length_scale;
mod loads;
mod masses;
mod memory;
mod model;
mod report;
mod rest_state;
mod settings;
mod simulator;

mod state;
mod step;
pub mod strands;
mod teleport;
mod wind;
mod wisps;

pub use checkpoint::{Checkpoint, StateArray};
pub use clock::{Clock, Ticks};
pub use cpu::CpuRunner;
pub use currents::{Currents, Eddy, Source};
pub use error::SimError;
pub use model::Model;
pub use report::{ContactReport, Drift, Extent, Measures, PressureReport, RodReport, StepReport, Stiffening};
pub use settings::{
    Drag, Preconditioner, Settings, StrandMethod, StrandSettings, VolumeMethod, VolumeSettings,
};
pub use simulator::Simulator;
pub use state::{Drive, MOST_SPIN, State};
pub use step::Stage;
pub use strandline_gpu::Backend;
pub use wisps::settings::ContactSettings;

/// Settings of strands of springs and constraints.
pub mod constrain {
    pub use crate::strands::constrain::settings::{Angles, ConstrainSettings, LengthPass, Spring, Springs};
}

/// Settings of rods.
pub mod rods {
    pub use crate::strands::rods::hair_kind::HairKind;
    pub use crate::strands::rods::settings::{GroupSettings, Rest, RodSettings};
}
