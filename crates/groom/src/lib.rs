//! Strands as data: a [`Groom`] as loaded or grown, [`Guides`] resampled for the solver and the
//! renderer, and the [`RestShape`] that the solver keeps. No GPU, no time.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods))] // compared values may be rounded

mod arcs;
mod attributes;
mod bands;
mod binding;
mod brush;
mod choice;
mod error;
mod groom;
mod guides;
mod influences;
mod outside;
mod resampled;
mod rest;
mod selected;
mod style;
mod ties;
mod unlike;

pub mod format;
pub mod root_ball;

pub use bands::Band;
pub use binding::{Binding, Frames, Influence, MOST_INFLUENCES, Surface, closing};
pub use brush::{Stroke, Tool};
pub use error::GroomError;
pub use groom::{Groom, Widths};
pub use guides::Guides;
pub use influences::Influences;
pub use outside::Outside;
pub use rest::RestShape;
pub use root_ball::RootBall;
pub use strandline_base::{LANES, LaneSet, Lanes, Vec3Lanes, block_count};
pub use style::{Style, StyleSettings};
pub use ties::Tie;
