//! Strands as data: a [`Groom`] as loaded or grown, [`Guides`] resampled for the solver and the
//! renderer, and the [`RestShape`] that the solver keeps. No GPU, no time.

#![forbid(unsafe_code)]

mod attributes;
mod error;
mod groom;
mod guides;
mod lanes;
mod outside;
mod rest;
mod style;

pub mod format;

pub use error::GroomError;
pub use groom::{Groom, Widths};
pub use guides::Guides;
pub use lanes::{LANES, Lanes, Vec3Lanes, block_count};
pub use outside::Outside;
pub use rest::RestShape;
pub use style::{Style, StyleSettings};
