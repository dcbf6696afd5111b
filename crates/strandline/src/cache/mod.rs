//! Hair that moved, as a file: the moving cache, text USD, and one groom file a frame. docs/cache.md is the page
//! for users.
//!
//! An `Out` writes frames during a run, [`Cache`] reads a moving cache. Strands and attributes that leave are
//! chosen in `shape` alone; every writer takes them from there.

pub(crate) mod drawn;
mod files;
pub(crate) mod kept;
mod meta;
mod out;
mod read;
pub(crate) mod relative;
mod shape;
mod store;
#[cfg(test)]
mod tests;
mod usd;
mod usd_text;

pub use out::{Out, OutSettings, Written};
pub use read::{Cache, check_cache};
pub(crate) use shape::Leaving;
pub use shape::{Target, What};

use glam::Vec3;

use crate::body::BodyFrame;

/// A frame that is written.
pub(crate) struct CacheFrame<'a> {
    /// Its number in the film, from 0.
    pub number: u32,
    /// Time since the film's beginning \[s\].
    pub time: f64,
    /// Points \[m\], world space, strand after strand.
    pub points: &'a [Vec3],
    pub body: &'a BodyFrame,
}
