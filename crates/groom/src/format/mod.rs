//! Readers and writers of groom files: one module per format, listed in [`FORMATS`].
//!
//! Readers work on bytes in memory, check every size in 64-bit arithmetic before they allocate,
//! and never allocate more than a small multiple of their input.

mod attribute;
pub mod bin;
mod bytes;
mod chosen;
mod cleaning;
pub mod data;
mod ends;
mod fitted;
pub mod hair;
mod headerless;
mod joining;
mod load;
pub mod npy;
pub mod npz;
pub mod obj;
pub mod ply;
pub mod project;
mod registry;
mod report;
mod rows;
mod save;
mod sieve;
mod sound;
pub mod tfx;
mod tfx_text;
mod unit;
pub mod usda;

pub use attribute::Attribute;
pub use chosen::Chosen;
pub use cleaning::Cleaning;
pub use ends::{RootEnd, from_tip_note};
pub use fitted::Fitted;
pub use load::{LoadOptions, Loaded, Scale, Up, load, load_all, prepare, sieved};
pub use registry::{FORMATS, Format, Read, Reader, Write, endings};
pub use report::{Counts, GroupOf, Lengths, Report};
pub use save::{Saved, save};
pub use unit::{GROOMS, UNITS, unit_alone};

/// Most strands that a reader accepts.
pub const MAX_STRANDS: u64 = 8_000_000;
/// Most points of a strand.
pub const MAX_POINTS_PER_STRAND: u64 = 4096;
/// Most points of all strands.
pub const MAX_POINTS: u64 = 256 << 20;
/// Largest file \[byte\].
pub const MAX_FILE_BYTES: u64 = 4 << 30;
/// Coordinates lie within this distance of 0, in the file's units.
pub const MAX_COORDINATE: f32 = 1e7;
/// Diameter of a human hair \[m\], for files that name none.
pub const HAIR_WIDTH: f32 = 8e-5;

/// The contents of a file before bad strands are sieved out; units and axes of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Parsed {
    /// Name and version of the format.
    pub format: &'static str,
    /// The strands, bad ones among them.
    pub groom: crate::Groom,
    /// Notes on what was odd but could be read.
    pub problems: Vec<String>,
}
