//! The stages in plain Rust, public so that checks can run each alone.

pub mod advance;
pub mod constrain;
pub mod faces;
pub mod gather;
pub mod integrate;
pub mod mark;
mod measures;
mod packing;
pub mod pcg;
pub mod poisson;
pub mod pose_roots;
mod runner;
mod scratch;
pub mod shelter;
mod sleep;
pub mod solve_pressure;
pub mod solve_rods;
pub mod splat;
pub mod volume;

mod fall;
pub(crate) mod length_pass;
mod rod_air;
mod rod_crowd;
mod rod_neighbours;
mod rod_pairs;
mod rod_parts;
mod rod_pulls;
mod rod_rest;
mod rod_room;
mod rod_sieve;
mod rod_strands;
pub(crate) mod spans;
pub(crate) mod wind_box;

pub use runner::CpuRunner;
pub use scratch::Scratch;
pub use volume::Volume;
