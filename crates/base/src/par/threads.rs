use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

/// Threads of their own for the loops of one piece of work, beside those that all others share.
#[derive(Debug)]
pub struct Pool(Option<rayon::ThreadPool>);

impl Pool {
    /// As many named threads as the machine has cores. If the system provides none, the work shares those of all.
    pub fn new(name: &'static str) -> Self {
        Self(rayon::ThreadPoolBuilder::new().thread_name(move |_| name.to_owned()).build().ok())
    }

    /// Runs something whose parallel loops have these threads.
    pub fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.0 {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }
}

/// Rounds that a thread without work looks for some at once, then with the others let go first, until it sleeps.
const ROUNDS_AT_ONCE: u32 = 64;
const ROUNDS: u32 = 2048;

/// Runs work of many short parallel loops with the threads awake in between, which else sleep where one of them does
/// something alone and are late for the next loop. A thread that finds nothing for about a millisecond sleeps, and is
/// woken by loops alone from then on. Idle threads never delay completion.
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

/// Takes part in loops of others until a condition holds.
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

/// Says that something is done when it is dropped: when it panics, too.
#[derive(Default)]
struct Done(Arc<AtomicBool>);

impl Drop for Done {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}
