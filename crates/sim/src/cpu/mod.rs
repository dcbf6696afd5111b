//! The stages in plain Rust, public so that checks can run each alone.

pub mod obstacles;

pub use obstacles::Obstacles;
