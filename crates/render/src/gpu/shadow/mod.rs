//! Deep opacity maps, and the box that they are fitted to.

pub(crate) mod fit;
pub(crate) mod opacity_depth;
pub(crate) mod opacity_layers;
