//! Strands of a scene beyond the groom: bound strands, attributes, poses.

pub(crate) mod attributes;
pub(crate) mod bodies;
pub(crate) mod bound;
pub(crate) mod hair_pose;
pub(crate) mod tags;
