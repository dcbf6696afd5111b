//! pictures

mod coverage;
mod golden;
mod grooms;
mod opacity;
mod screen;
mod shading;
mod tessellation;
