//! Strands as they are drawn: guides tessellated, strands between them, strands that guides carry.

pub(crate) mod bind;
pub(crate) mod bound_solids;
pub(crate) mod device_points;
pub(crate) mod interpolate;
pub(crate) mod points;
pub(crate) mod tessellate;
