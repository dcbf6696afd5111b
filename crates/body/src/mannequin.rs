//! The built-in bust: its proportions, its field, and its skin as triangles.

mod ear;
mod eye;
mod eyeball;
mod field;
mod figure;
mod model;
mod paint;
mod person;
mod proportions;
mod refine;
mod shape;
mod surface;

pub use model::Mannequin;
pub use person::{Build, Eyes};
