//! Contact of strands with solids, for both backends: solids over a step, the planes that points remember of them, and
//! the way of a point through a step.

pub(crate) mod contacts;
mod obstacles;
mod parts;
pub(crate) mod planes;
mod riders;
pub(crate) mod touch;
mod way;

pub(crate) use obstacles::Skins;

pub use obstacles::Obstacles;
