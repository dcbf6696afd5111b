//! Pages that show when two threads use them at once.

use std::sync::Arc;

use loom::cell::Cell;
use loom::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// Something that a number is written on, twice.
pub(crate) trait Page: Send + 'static {
    fn blank() -> Self;
    fn write(&self, number: u64);
    fn lines(&self) -> [u64; 2];

    /// The number that is written on it.
    fn read(&self) -> u64 {
        let [first, last] = self.lines();
        assert_eq!(first, last, "a torn page");
        first
    }
}

/// A page that moves with its job; loom refuses an access that is not ordered after another thread's.
pub(crate) struct Moved([Cell<u64>; 2]);

impl Page for Moved {
    fn blank() -> Self {
        Self([Cell::new(0), Cell::new(0)])
    }

    fn write(&self, number: u64) {
        self.0.iter().for_each(|line| line.set(number));
    }

    fn lines(&self) -> [u64; 2] {
        self.0.each_ref().map(Cell::get)
    }
}

/// A page that both sides can reach at any time, as memory of a device; used at once it is torn.
#[derive(Clone)]
pub(crate) struct Shared(Arc<[AtomicU64; 2]>);

impl Page for Shared {
    fn blank() -> Self {
        Self(Arc::new([AtomicU64::new(0), AtomicU64::new(0)]))
    }

    fn write(&self, number: u64) {
        self.0.iter().for_each(|line| line.store(number, Relaxed));
    }

    fn lines(&self) -> [u64; 2] {
        self.0.each_ref().map(|line| line.load(Relaxed))
    }
}

mod tests {
    use std::rc::Rc;

    use super::*;
    use crate::explore::explore;

    /// Lets two threads write one page at once. (loom's threads are not held to `Send`.)
    fn write_twice<P: Page>() {
        explore(|| {
            let page = Rc::new(P::blank());
            let other = page.clone();
            let thread = loom::thread::spawn(move || other.write(2));
            page.write(1);
            thread.join().unwrap();
            page.read();
        });
    }

    #[test]
    #[should_panic = "Causality violation"]
    fn two_at_once_on_a_moved_page_are_refused() {
        write_twice::<Moved>();
    }

    #[test]
    #[should_panic = "a torn page"]
    fn two_at_once_tear_a_shared_page() {
        write_twice::<Shared>();
    }
}
