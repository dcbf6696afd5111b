//! pictures

mod grooms;
mod tessellation;
