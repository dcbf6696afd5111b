//! Light that hair and skin scatter, and the ambient light that hair hides.

pub(crate) mod light_grid;
pub(crate) mod occlude;
