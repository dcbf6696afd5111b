//! What is drawn: its shape, its light, and whole pictures.

mod clump;
mod coverage;
mod drawn;
mod golden;
mod grooms;
mod opacity;
mod screen;
mod shading;
mod stillness;
mod terms;
mod tessellation;
