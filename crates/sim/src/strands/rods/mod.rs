//! Rods: strands that bend and twist by physics [Bergou2008, Bergou2010]. A strand is stepped
//! implicitly, all of its points at once, by a banded Newton solve.

// Rows and columns of small matrices are numbers, several of them in one loop.
#![allow(clippy::needless_range_loop)]

pub mod air;
mod assemble;
#[cfg(target_arch = "x86_64")]
mod avx;
#[cfg(not(target_arch = "x86_64"))]
#[path = "no_avx.rs"]
mod avx;
mod crowding;
pub mod front;
pub mod hair_kind;
pub(crate) mod hairs;
pub mod joint;
pub mod lengths;
mod loads;
pub mod material;
pub mod model;
pub(crate) mod other_lengths;
pub mod presets;
pub mod pull;
pub mod rest;
pub mod rod;
pub mod rounds;
pub mod settings;
mod stability;
pub(crate) mod workspace;

pub use strandline_base::real;

#[cfg(test)]
mod tests;
