//! A second worker: a thread that does one job after the other while this one does something else
//! [Chen2011 §5].
//!
//! The protocol has three words. *Start* hands a job over. *Finish* waits for its result. The inputs
//! of a job and its results move with it, so that neither side can touch what the other works on: to hand a
//! thing back with the next start is the *acknowledgement*.
//!
//! `checks/loom` compiles this very file with primitives of its own and walks through all orders in which
//! the two sides can take turns; hence `super::sync`.

use super::sync::thread::{Builder, JoinHandle};
use super::sync::{Arc, Mutex, MutexGuard, PoisonError, Receiver, Sender, channel};

/// Something that jobs are done on.
pub(crate) trait Work: Send + 'static {
    /// Input of a job.
    type Job: Send + 'static;
    /// Result of a job.
    type Done: Send + 'static;

    /// Does a job.
    fn run(&mut self, job: Self::Job) -> Self::Done;
}

/// The worker's thread has ended: a job panicked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Gone;

/// A thread and the object that its jobs work on.
pub(crate) struct Worker<W: Work> {
    work: Arc<Mutex<W>>,
    jobs: Option<Sender<W::Job>>,
    results: Option<Receiver<W::Done>>,
    thread: Option<JoinHandle<()>>,
    started: usize,
}

impl<W: Work> Worker<W> {
    /// Starts the thread.
    pub fn new(work: W) -> std::io::Result<Self> {
        let work = Arc::new(Mutex::new(work));
        let (jobs, waiting) = channel();
        let (done, results) = channel();
        let own = work.clone();
        let thread = Builder::new().name("simulation".to_owned()).spawn(move || {
            // Ends with the senders, or when the receiver of results is gone.
            while let Ok(job) = waiting.recv() {
                let result = lock(&own).run(job);
                if done.send(result).is_err() {
                    break;
                }
            }
        })?;
        Ok(Self { work, jobs: Some(jobs), results: Some(results), thread: Some(thread), started: 0 })
    }

    /// Hands a job over; it begins when those before it have ended.
    pub fn start(&mut self, job: W::Job) -> Result<(), Gone> {
        let sent = self.jobs.as_ref().is_some_and(|jobs| jobs.send(job).is_ok());
        if !sent {
            return Err(Gone);
        }
        self.started += 1;
        Ok(())
    }

    /// Jobs whose result was not taken yet.
    pub fn started(&self) -> usize {
        self.started
    }

    /// Waits for the oldest job that was started.
    pub fn finish(&mut self) -> Result<W::Done, Gone> {
        let result = self.results.as_ref().and_then(|results| results.recv().ok()).ok_or(Gone);
        // Nothing more comes from a thread that is gone.
        self.started = if result.is_ok() { self.started - 1 } else { 0 };
        let result = result?;
        Ok(result)
    }

    /// The worker's object between two jobs; waits for the one that runs.
    pub fn work(&self) -> MutexGuard<'_, W> {
        lock(&self.work)
    }
}

/// Data that a panic left is plain.
fn lock<W>(work: &Mutex<W>) -> MutexGuard<'_, W> {
    work.lock().unwrap_or_else(PoisonError::into_inner)
}

impl<W: Work> Drop for Worker<W> {
    fn drop(&mut self) {
        // The job that runs is waited for, and those behind it are not begun.
        drop((self.jobs.take(), self.results.take()));
        // A panic of the thread was reported as `Gone`.
        let _ = self.thread.take().map(JoinHandle::join);
    }
}
