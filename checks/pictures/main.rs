//! pictures

mod coverage;
mod flip;
mod golden;
mod grooms;
mod opacity;
mod screen;
mod shading;
mod tessellation;
