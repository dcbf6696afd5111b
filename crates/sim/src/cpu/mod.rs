//! The stages in plain Rust, public so that checks can run each alone.

pub mod advance;
pub mod constrain;
pub mod integrate;
pub mod obstacles;
pub mod pose_roots;

pub(crate) mod angles;
pub(crate) mod contacts;
pub(crate) mod length_pass;
pub(crate) mod lengths;
pub(crate) mod vec3x8;

pub use obstacles::Obstacles;
