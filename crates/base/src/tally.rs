//! Counts of work, which tests hold in place of times.

#[cfg(debug_assertions)]
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// A count of work that an object has done. Builds without debug assertions count nothing and give 0.
#[derive(Debug, Default)]
// A line of the cache of its own: what lies beside it is read by all threads.
#[cfg_attr(debug_assertions, repr(align(64)))]
pub struct Tally {
    #[cfg(debug_assertions)]
    count: AtomicU64,
}

impl Tally {
    /// Counts more.
    #[inline]
    pub fn add(&self, more: u64) {
        #[cfg(debug_assertions)]
        self.count.fetch_add(more, Relaxed);
        let _ = more;
    }

    /// The sum so far, of all threads.
    pub fn count(&self) -> u64 {
        #[cfg(debug_assertions)]
        return self.count.load(Relaxed);
        #[cfg(not(debug_assertions))]
        0
    }
}
