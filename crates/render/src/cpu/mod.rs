//! The stages in plain Rust, public so that checks can run each alone.

pub mod strands;

pub use strands::Strands;
