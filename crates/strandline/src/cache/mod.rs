//! Hair that moved, as a file: the moving cache, text USD, and one groom file a frame. docs/cache.md is the page
//! for users.
//!
//! An `Out` writes frames during a run, [`Cache`] reads a moving cache. What leaves is decided in `shape`
//! alone: strands, and whatever attributes they have; every writer takes them from there.

mod arrays;
pub(crate) mod drawn;
mod files;
pub(crate) mod kept;
mod meta;
mod out;
mod read;
pub(crate) mod relative;
mod shape;
mod snapshot;
mod state;
mod store;
#[cfg(test)]
mod tests;
mod usd;
mod usd_text;

pub(crate) use arrays::check_memory;
pub use out::{Out, OutSettings, Written};
pub use read::{Cache, check_cache};
pub(crate) use shape::Leaving;
pub use shape::{Target, What};
pub(crate) use snapshot::Snapshot;

use glam::Vec3;

use crate::body::BodyFrame;

/// Most frames of a file.
pub(crate) const MAX_FRAMES: u64 = 1_000_000;
/// Most strands and points of a frame, as of a groom.
pub(crate) const MAX_STRANDS: u64 = crate::groom::format::MAX_STRANDS;
pub(crate) const MAX_POINTS: u64 = crate::groom::format::MAX_POINTS;

/// A frame that is written.
pub(crate) struct Frame<'a> {
    /// Its number in the film, from 0.
    pub number: u32,
    /// Time since the film's beginning \[s\].
    pub time: f64,
    /// Points \[m\], world space, strand after strand.
    pub points: &'a [Vec3],
    pub body: &'a BodyFrame,
}
