//! Deep opacity maps \[Yuksel2008\], filled, and soft edges of shadows on skin.

mod body;
mod coarse_body;
mod hair;
pub mod layer_colors;
pub mod opacity_depth;
pub mod opacity_layers;
mod penumbra;
#[cfg(test)]
mod penumbra_tests;

pub use body::{Cuts, ShadowBody};
pub(crate) use coarse_body::CoarseBody;
