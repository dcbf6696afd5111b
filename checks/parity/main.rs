//! Every stage of the GPU backend against its twin in plain Rust.

mod between;
mod bound;
mod channels;
mod chiang;
mod contact;
mod depth;
mod draw;
mod heads;
mod host;
mod painted;
#[path = "../../crates/body/tests/body/painted_file.rs"]
mod painted_file;
mod picture;
mod pieces;
mod rods;
mod shaders;
mod shelter;
mod simulator;
mod skin;
mod strands;
mod volume;
mod whole;
