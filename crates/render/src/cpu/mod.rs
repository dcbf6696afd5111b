//! The stages in plain Rust, public so that checks can run each alone.

mod channels;
pub mod draw;
mod frame;
mod renderer;
pub mod resolve;
pub mod scatter;
pub mod shade;
pub mod shadow;
pub mod strands;

pub use crate::strands::scalp::root_densities;
pub use draw::{Draw, DrawInput};
pub use renderer::Renderer;
pub use resolve::Resolve;
pub use scatter::light_grid::LightGrid;
pub use scatter::light_scene::SkinColor;
pub use scatter::occlusion::Occlusion;
pub(crate) use shade::Scheuermann;
pub(crate) use shade::radiances::LitRuns;
pub use shade::radiances::{LazyRadiances, Radiances, Shading};
pub use shade::shade;
pub use shade::shade_chiang::{Lit, Scattering};
pub(crate) use shadow::CoarseBody;
pub use shadow::layer_colors::layer_colors;
pub use shadow::opacity_depth::opacity_depth;
pub use shadow::opacity_layers::opacity_layers;
pub use shadow::{Cuts, ShadowBody};
pub use strands::growth::Growth;
pub use strands::interpolate::interpolate;
pub use strands::keep_outside;
pub use strands::tessellate::{Curves, tessellate};
