//! Parallel loops of rayon's threads, which stay awake between short ones.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

pub use rayon::{current_num_threads, join, prelude};

/// A thread pool for the loops of one piece of work, beside the pool that all others share.
#[derive(Debug)]
pub struct Pool(Option<rayon::ThreadPool>);

impl Pool {
    /// One thread per core of the machine, with a name. Work runs on the shared pool where the system gives no
    /// threads.
    pub fn new(name: &'static str) -> Self {
        Self(rayon::ThreadPoolBuilder::new().thread_name(move |_| name.to_owned()).build().ok())
    }

    /// Runs work whose parallel loops use these threads.
    pub fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.0 {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }
}

/// Rounds in which an idle thread looks for work without a pause, then with a yield before each, until it sleeps.
const ROUNDS_AT_ONCE: u32 = 64;
const ROUNDS: u32 = 2048;

/// Keeps worker threads spinning between the short parallel loops of a piece of work; threads that sleep between them
/// are late for the next loop. A thread that finds nothing for about a millisecond sleeps until a loop wakes it. Idle
/// threads never delay completion.
pub fn awake<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    // On a thread of the pool.
    rayon::scope(|_| {
        let done = Done::default();
        if rayon::current_num_threads() > 1 {
            let (own, done) = (rayon::current_thread_index(), done.0.clone());
            rayon::spawn_broadcast(move |context| {
                if Some(context.index()) != own {
                    wait(&done);
                }
            });
        }
        work()
    })
}

/// Takes part in the loops of other threads until the work is done.
fn wait(done: &AtomicBool) {
    let mut round = 0;
    while round < ROUNDS && !done.load(Ordering::Relaxed) {
        match rayon::yield_now() {
            Some(rayon::Yield::Executed) => round = 0,
            _ if round < ROUNDS_AT_ONCE => std::hint::spin_loop(),
            _ => std::thread::yield_now(),
        }
        round += 1;
    }
}

/// Marks the work as done when dropped, also by a panic.
#[derive(Default)]
struct Done(Arc<AtomicBool>);

impl Drop for Done {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::{awake, prelude::*};

    #[test]
    fn loops_of_awake_threads_give_the_same_results() {
        let sums = || -> Vec<u32> {
            let sum = |last: u32| (0..last).into_par_iter().with_min_len(1).sum();
            (0..200).map(sum).collect()
        };
        for threads in [1, 2, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            assert_eq!(pool.install(|| awake(sums)), sums());
            // Nested calls, and work that panics.
            assert_eq!(pool.install(|| awake(|| awake(sums).len())), 200);
            let fails = || pool.install(|| awake(|| panic!("of the test")));
            assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(fails)).is_err());
            assert_eq!(pool.install(|| awake(sums)), sums());
        }
        assert_eq!(awake(sums), sums());
    }
}
