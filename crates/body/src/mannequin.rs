//! The built-in bust: its proportions, its field, and its skin as triangles.

mod ear;
mod field;
mod model;
mod proportions;
mod shape;
mod surface;

pub use model::Mannequin;
