//! Everything beneath the names of the crate: its parts, and the crates below it. They serve the program, the window,
//! checks and benches; they may change with any version.

pub use strandline_base as base;
pub use strandline_body as body;
pub use strandline_gpu as gpu;
pub use strandline_groom as groom;
pub use strandline_render as render;
pub use strandline_sim as sim;

pub use crate::attributes::check_attributes;
pub use crate::body::Motion;
pub use crate::bound::BoundStrands;
pub use crate::cache::{Cache, OutSettings, Target, What, Written, check_cache};
pub use crate::devices::Devices;
pub use crate::film::{FilmFiles, PictureFiles};
pub use crate::hair_pose::check_pose;
pub use crate::head::HeadMotion;
pub use crate::live::{Command, LiveClock, LiveEvent, Shown};
pub use crate::pick::Ray;
pub use crate::prepare::{Prepared, mesh_unit, read_map};
pub use crate::session::Change;
pub use crate::tags::Tags;
