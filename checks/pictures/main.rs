//! pictures

mod coverage;
mod golden;
mod grooms;
mod opacity;
mod screen;
mod shading;
mod stillness;
mod tessellation;
