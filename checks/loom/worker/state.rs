//! The object of the work, seen from outside between two jobs.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex};

use crate::explore::explore;
use crate::pages::{Page, Shared};
use crate::worker::{Work, Worker};

/// Counts its jobs.
struct Counter(Shared);

impl Work for Counter {
    type Job = ();
    type Done = ();

    fn run(&mut self, (): ()) {
        self.0.write(self.0.read() + 1);
    }
}

#[test]
fn it_is_seen_before_a_job_or_after_it_and_never_in_between() {
    let seen = Arc::new(Mutex::new(BTreeSet::new()));
    let kept = seen.clone();
    explore(move || {
        let mut worker = Worker::new(Counter(Shared::blank())).unwrap();
        worker.start(()).unwrap();
        worker.start(()).unwrap();
        let first = worker.work().0.read();
        worker.finish().unwrap();
        let second = worker.work().0.read();
        worker.finish().unwrap();
        assert_eq!(worker.work().0.read(), 2);
        kept.lock().unwrap().insert([first, second]);
    });
    let possible = [[0, 1], [0, 2], [1, 1], [1, 2], [2, 2]];
    assert!(seen.lock().unwrap().iter().eq(&possible), "{seen:?}");
}

/// The same look past the lock finds the job half done.
#[test]
#[should_panic = "a torn page"]
fn past_the_lock_it_is_seen_in_between() {
    explore(|| {
        let count = Shared::blank();
        let mut worker = Worker::new(Counter(count.clone())).unwrap();
        worker.start(()).unwrap();
        count.read();
    });
}
