//! Parallel loops: those of rayon, with threads that stay awake between short ones. A browser page has no threads: there the
//! same loops are plain ones, without the code that would share them; results are the same to the bit.

#[cfg(any(test, target_family = "wasm"))]
mod serial;
#[cfg(not(target_family = "wasm"))]
mod threads;

#[cfg(target_family = "wasm")]
pub use serial::{Pool, awake, current_num_threads, join, prelude};
#[cfg(not(target_family = "wasm"))]
pub use threads::{Pool, awake, current_num_threads, join, prelude};
