//! The stages in plain Rust, public so that checks can run each alone.

pub mod interpolate;
mod lanes;
mod noise;
pub mod strands;
pub mod tessellate;

pub use interpolate::interpolate;
pub use strands::Strands;
pub use tessellate::{Curves, tessellate};
