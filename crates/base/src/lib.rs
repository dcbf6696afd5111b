//! The base of every other crate: files that are whole or absent, inputs that are plain files, folders that one
//! run writes at a time, arrays in a zip that grow during a run, vectors of eight strands, poses, random numbers,
//! clocks, parallel loops, text that is safe to print, the settings table. It knows no hair and no GPU, and
//! imports no other crate of the project.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods))] // tests may use inexact math

pub mod cache;
mod file_problem;
mod folder_lock;
mod growing_file;
mod invalidates;
mod lanes;
pub mod math;
pub mod memory;
pub mod npz;
pub mod par;
mod plain_file;
pub mod ply;
mod pose;
mod printable;
pub mod random;
pub mod real;
mod recent;
mod setting;
mod setting_fields;
mod setting_macro;
mod setting_values;
mod stopwatch;
mod tally;
mod temporary;
mod text;
pub mod vec3x8;
mod whole_file;

pub use file_problem::FileProblem;
pub use folder_lock::FolderLock;
pub use growing_file::{GrowingFile, refuse_busy};
pub use invalidates::Invalidates;
pub use lanes::{
    LANES, LaneArray, LaneSet, Lanes, Vec3Lanes, block_count, fill_lanes, in_strand_order, lane_place,
};
pub use plain_file::{open_plain, read_plain};
pub use pose::Pose;
pub use printable::printable;
pub use random::Random;
pub use recent::Recent;
pub use setting::{
    Group, Items, Key, Kind, Overrides, Row, SettingError, Table, Value, Word, number, plain_name,
};
pub use setting_fields::FieldName;
pub use stopwatch::{Stopwatch, timed};
pub use tally::Tally;
pub use temporary::{Abandoned, abandon_unfinished};
pub use text::{counted, utf8_text, whole_lines};
pub use whole_file::WholeFile;
