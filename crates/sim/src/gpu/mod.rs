//! The stages as kernels, through wgpu; every one has a twin in plain Rust under the same name.
//!
//! A [`GpuRunner`] holds the compiled kernels and a state on the device. A step is one submission;
//! nothing is read back until it is asked for.

mod advance;
mod air_buffers;
mod alone;
mod between;
mod buffers;
mod constrain;
mod gather;
mod inputs;
mod integrate;
mod kernels;
mod lengths;
mod lengths_alone;
mod linked;
mod mark;
mod motion;
mod pcg;
mod pending;
mod pose_roots;
mod probe;
mod records;
mod rod_buffers;
mod rod_crowd;
mod rod_crowd_buffers;
mod runner;
mod shelter;
mod slide;
mod solids;
mod solve_pressure;
mod solve_rods;
mod splat;
mod stage;
mod transfer;
mod volume;

pub use between::{ComingPoints, PointCarrier, read_between};
pub use kernels::declarations;
pub use lengths_alone::{LengthsForm, LengthsInput, lengths_alone};
pub use linked::modules;
pub use probe::Probe;
pub use records::{Gradient, PressureState, Spread};
pub use runner::{Costs, GpuRunner};
pub use transfer::ComingState;
