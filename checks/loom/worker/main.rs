//! All orders in which the two workers can take turns.
//!
//! The file under test is `crates/strandline/src/session/worker.rs` itself; only the primitives that it takes from
//! `crate::sync` are others here, made of loom's. The lock is not looked through after a panic: loom's cannot
//! be taken then. The crate's own tests do that on real threads.

mod channel;
mod explore;
mod pages;
mod protocol;
mod state;
mod sync;
mod thread;
#[path = "../../../crates/strandline/src/session/worker.rs"]
mod worker;
