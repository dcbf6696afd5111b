//! What is drawn: its shape, its light, and whole pictures.

mod clump;
mod coverage;
mod drawn;
mod fibre;
mod golden;
mod grooms;
mod light;
mod linear;
mod opacity;
mod screen;
mod shading;
mod stillness;
mod terms;
mod tessellation;
