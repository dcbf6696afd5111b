//! The three words of the protocol, start, finish and hand back, and its end.

use std::marker::PhantomData;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use crate::explore::explore;
use crate::pages::{Moved, Page, Shared};
use crate::thread::Asked;
use crate::worker::{Gone, Work, Worker};

/// Numbers pages, from 1 on.
struct Writer<P> {
    last: u64,
    /// 1 and the number of pages, once it has ended.
    ended: Arc<AtomicU64>,
    pages: PhantomData<P>,
}

enum Order<P> {
    Write(P),
    Panic,
}

impl<P: Page> Work for Writer<P> {
    type Job = Order<P>;
    type Done = P;

    fn run(&mut self, order: Order<P>) -> P {
        let Order::Write(page) = order else { resume_unwind(Box::new(Asked)) };
        self.last += 1;
        page.write(self.last);
        page
    }
}

impl<P> Drop for Writer<P> {
    fn drop(&mut self) {
        self.ended.store(1 + self.last, Relaxed);
    }
}

/// A writer at work, and a number that tells its end.
fn writer<P: Page>() -> (Worker<Writer<P>>, Arc<AtomicU64>) {
    let ended = Arc::new(AtomicU64::new(0));
    let writer = Writer { last: 0, ended: ended.clone(), pages: PhantomData };
    (Worker::new(writer).unwrap(), ended)
}

/// Ends a worker and looks whether its thread has let go of everything.
fn end<P: Page>(worker: Worker<Writer<P>>, ended: &AtomicU64) {
    drop(worker);
    assert!(ended.load(Relaxed) > 0, "the thread continues");
}

#[test]
fn jobs_started_ahead_come_back_whole_and_in_order() {
    explore(|| {
        let (mut worker, ended) = writer::<Moved>();
        for started in 1..=2 {
            worker.start(Order::Write(Page::blank())).unwrap();
            assert_eq!(worker.started(), started);
        }
        for number in 1..=2 {
            let page = worker.finish().unwrap();
            assert_eq!(page.read(), number);
            page.write(0); // it is ours again
        }
        assert_eq!(worker.started(), 0);
        end(worker, &ended);
    });
}

#[test]
fn a_page_is_read_while_the_next_is_written() {
    explore(|| {
        let (mut worker, ended) = writer::<Shared>();
        let pages = [Shared::blank(), Shared::blank()];
        let next = |worker: &mut Worker<_>, number: usize| {
            worker.start(Order::Write(pages[number % 2].clone())).unwrap();
        };
        next(&mut worker, 1);
        for number in 1..=3 {
            worker.finish().unwrap();
            if number < 3 {
                next(&mut worker, number + 1);
            }
            assert_eq!(pages[number % 2].read(), number as u64);
        }
        end(worker, &ended);
    });
}

#[test]
fn it_ends_whatever_was_not_finished() {
    for (started, finished) in [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)] {
        explore(move || {
            let (mut worker, ended) = writer::<Moved>();
            for _ in 0..started {
                worker.start(Order::Write(Page::blank())).unwrap();
            }
            for number in 1..=finished {
                assert_eq!(worker.finish().unwrap().read(), number);
            }
            end(worker, &ended);
        });
    }
}

#[test]
fn a_panic_is_reported_and_it_ends_all_the_same() {
    explore(|| {
        let (mut worker, ended) = writer::<Moved>();
        worker.start(Order::Write(Page::blank())).unwrap();
        worker.start(Order::Panic).unwrap();
        assert_eq!(worker.finish().unwrap().read(), 1);
        // The thread may still take a job on its way out; its result never comes.
        let _ = worker.start(Order::Write(Page::blank()));
        assert_eq!(worker.finish().err(), Some(Gone));
        assert_eq!(worker.finish().err(), Some(Gone));
        end(worker, &ended);
    });
}

#[test]
fn a_job_that_waits_is_not_begun_when_it_ends() {
    let least = Arc::new(AtomicU64::new(u64::MAX));
    let seen = least.clone();
    explore(move || {
        let (mut worker, ended) = writer::<Moved>();
        for _ in 0..2 {
            worker.start(Order::Write(Page::blank())).unwrap();
        }
        end(worker, &ended);
        seen.fetch_min(ended.load(Relaxed) - 1, Relaxed);
    });
    // The first may be under way; there is an order in which the second one waits.
    assert_eq!(least.load(Relaxed), 1);
}

/// The second model without its waiting.
#[test]
#[should_panic = "a torn page"]
fn a_page_that_is_not_waited_for_is_torn() {
    explore(|| {
        let (mut worker, _) = writer::<Shared>();
        let page = Shared::blank();
        worker.start(Order::Write(page.clone())).unwrap();
        page.read();
    });
}
