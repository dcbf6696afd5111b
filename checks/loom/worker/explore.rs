//! Walks through the orders of a model.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Runs a model once for each order in which its threads can take turns. `--nocapture` tells how many.
///
/// # Panics
/// The model panics in one of them, comes to a standstill, leaves something behind, or has but one. A
/// standstill of several threads ends the whole run, without a thread to clear up.
#[allow(clippy::print_stdout)] // it tells how much was explored
pub(crate) fn explore(model: impl Fn() + Send + Sync + 'static) {
    let orders = Arc::new(AtomicUsize::new(0));
    let count = orders.clone();
    loom::model(move || {
        count.fetch_add(1, Relaxed);
        model();
    });
    let orders = orders.load(Relaxed);
    println!("{orders} orders");
    assert!(orders > 1, "nothing happened at the same time");
}
