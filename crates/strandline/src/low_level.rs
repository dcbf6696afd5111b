//! Everything beneath the names of the crate: its parts, and the crates below it. They serve
//! checks, tests, fuzz targets and the Python package; they may change with any version.

pub use strandline_base as base;
pub use strandline_body as body;
pub use strandline_gpu as gpu;
pub use strandline_groom as groom;
pub use strandline_render as render;
pub use strandline_sim as sim;

pub use crate::body::Motion;
pub use crate::cache::check_cache;
pub use crate::prepare::read_map;
pub use crate::snapshot::files::check_pose;
pub use crate::strands::attributes::check_attributes;
pub use crate::strands::bound::BoundStrands;
pub use crate::strands::tags::Tags;
