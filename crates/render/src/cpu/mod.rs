//! The stages in plain Rust, public so that checks can run each alone.

pub mod draw;
pub(crate) mod fast_math;
mod lanes;
pub mod resolve;
pub mod scatter;
pub mod shade;
pub mod shadow;
pub mod strands;

pub use draw::samples::Samples;
pub use draw::{Draw, DrawInput};
pub use resolve::{Resolve, resolve_linear};
pub use scatter::light_grid::LightGrid;
pub use scatter::mixture::OwnColors;
pub use scatter::occlusion::Occlusion;
pub(crate) use shade::Scheuermann;
pub(crate) use shade::radiances::Found;
pub use shade::radiances::{Radiances, Seen, Shading};
pub use shade::shade;
pub use shade::shade_chiang::{Lit, Scattering};
pub use shadow::layer_colors::layer_colors;
pub use shadow::opacity_depth::opacity_depth;
pub use shadow::opacity_layers::opacity_layers;
pub use shadow::{ShadowBody, ShadowMap, Shadows};
pub use strands::interpolate::interpolate;
pub use strands::tessellate::{Curves, tessellate};
pub use strands::{Strands, keep_outside};
