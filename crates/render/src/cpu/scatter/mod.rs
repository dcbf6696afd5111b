//! Light that hair and skin scatter, and the ambient light that hair hides.

mod light_carry;
pub mod light_grid;
mod light_scale;
pub mod light_scene;
mod light_sums;
pub(crate) mod mixture;
pub mod occlusion;
