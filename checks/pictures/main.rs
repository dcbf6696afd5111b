//! Pictures: shape, light, and whole images.

mod clump;
mod colors;
mod coverage;
mod crown;
mod drawn;
mod fibre;
mod golden;
mod grooms;
mod light;
mod linear;
mod mixture;
mod motion;
mod moved;
mod opacity;
mod penumbra;
mod resolve;
mod round;
mod scalp;
mod screen;
mod shading;
mod shares;
mod stillness;
mod surroundings;
mod terms;
mod tessellation;
mod traced;
