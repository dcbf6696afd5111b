/// Threads of their own for the loops of one piece of work, beside those that all others share.
#[derive(Debug)]
pub struct Pool(Option<rayon::ThreadPool>);

impl Pool {
    /// As many threads as the machine has cores, of a name. Where the system gives none the work shares those of all.
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
