//! Strands as they are drawn: guides as smooth curves, strands grown about them, strands that guides carry.

pub mod bind;
pub mod growth;
pub mod interpolate;
mod noise;
mod outside;
pub mod tessellate;

pub use outside::keep_outside;
