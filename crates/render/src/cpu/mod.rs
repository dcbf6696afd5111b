//! The stages in plain Rust, public so that checks can run each alone.

mod fast_math;
pub mod interpolate;
mod lanes;
mod noise;
pub mod opacity_depth;
pub mod opacity_layers;
pub mod shadow;
mod shadow_body;
mod shadow_hair;
pub mod strands;
pub mod tessellate;

pub use interpolate::interpolate;
pub use opacity_depth::{ShadowBody, opacity_depth};
pub use opacity_layers::opacity_layers;
pub use shadow::{ShadowMap, Shadows};
pub use strands::Strands;
pub use tessellate::{Curves, tessellate};
