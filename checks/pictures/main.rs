//! pictures

mod grooms;
mod opacity;
mod shading;
mod tessellation;
