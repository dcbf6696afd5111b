//! Hair in a browser page: what a worker of the page runs. [`Page`] is plain Rust and tested without a browser; in a
//! WebAssembly module it is the class `Engine` of the page's script.

#![deny(unsafe_code)]

pub mod bits;
#[cfg(all(target_family = "wasm", feature = "gpu"))]
mod device;
mod dropped;
#[cfg(target_family = "wasm")]
mod exports;
mod limits;
mod own;
mod page;

pub use page::Page;
