//! Shared helpers of the checks.

#![forbid(unsafe_code)]

mod depths;
pub mod flip;
mod grooms;
mod rig;

use std::sync::OnceLock;

pub use depths::Depths;
pub use grooms::{ponytail, ponytail_on, reference, sintel};
pub use rig::{On, Rig, in_full};
use strandline_gpu::Gpu;

/// The adapter that the checks of the GPU backend run on, any that there is; they share its device.
/// Without one they print a note and check nothing, or fail if `STRANDLINE_REQUIRE_GPU` is 1.
///
/// # Panics
/// There is no adapter, or it does not start, and one is required.
pub fn gpu() -> Option<Gpu> {
    static SHARED: OnceLock<Option<Gpu>> = OnceLock::new();
    SHARED.get_or_init(open).clone()
}

/// As [`gpu`], for checks that take a software adapter long: it is theirs where [`in_full`] says so, and a line tells that
/// they were left out where not. Laws that hold on the CPU and stage by stage hold there too: these are laws of whole scenes.
///
/// # Panics
/// As [`gpu`].
pub fn gpu_in_full() -> Option<Gpu> {
    let found = gpu()?;
    if found.adapter().software && !in_full() {
        grooms::left_to_long();
        return None;
    }
    Some(found)
}

/// As [`gpu`], with a device of its own: for checks that spoil it.
///
/// # Panics
/// As [`gpu`].
pub fn own_gpu() -> Option<Gpu> {
    open()
}

#[allow(clippy::print_stderr)] // it says what is not tested
fn open() -> Option<Gpu> {
    match Gpu::any() {
        Ok(gpu) => Some(gpu),
        Err(error) => {
            let required = std::env::var_os("STRANDLINE_REQUIRE_GPU").is_some_and(|value| value == "1");
            assert!(!required, "STRANDLINE_REQUIRE_GPU is 1, but {error}");
            eprintln!("not tested on a GPU: {error}");
            None
        }
    }
}
