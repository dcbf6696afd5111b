//! The stages in plain Rust, public so that checks can run each alone.

mod body;
mod coverage;
pub mod draw;
mod fast_math;
pub mod fibre;
pub mod interpolate;
mod lanes;
mod noise;
pub mod occlusion;
pub mod opacity_depth;
pub mod opacity_layers;
mod projection;
pub mod resolve;
mod ribbons;
pub mod samples;
pub mod shade;
pub mod shadow;
mod shadow_body;
mod shadow_hair;
mod shadow_picture;
pub mod skin;
mod sort;
pub mod strands;
pub mod tessellate;
mod tiles;

pub use draw::{Draw, DrawInput};
pub use interpolate::interpolate;
pub use occlusion::Occlusion;
pub use opacity_depth::{ShadowBody, opacity_depth};
pub use opacity_layers::opacity_layers;
pub use resolve::{Resolve, resolve_linear};
pub use samples::Samples;
pub use shade::shade;
pub use shadow::{ShadowMap, Shadows};
pub use strands::Strands;
pub use tessellate::{Curves, tessellate};
