//! Strands of a scene beyond the groom: bound strands, attributes, bodies.

pub(crate) mod attributes;
pub(crate) mod bodies;
pub(crate) mod bound;
pub(crate) mod tags;
