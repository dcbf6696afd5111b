//! A channel as the standard library's, with one sender: loom's own never ends.
//!
//! Its lock orders a little more than the standard library promises, receiving before a later sending; all
//! orders in which the two may happen are explored all the same.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::mpsc::{RecvError, SendError};

use loom::sync::{Condvar, Mutex};

/// State shared by the two ends.
struct Shared<T> {
    state: Mutex<State<T>>,
    changed: Condvar,
}

struct State<T> {
    queue: VecDeque<T>,
    sender: bool,
    receiver: bool,
}

/// The end that things are put in at.
pub(crate) struct Sender<T>(Arc<Shared<T>>);

/// The end that they come out of, in order.
pub(crate) struct Receiver<T>(Arc<Shared<T>>);

/// Two ends of one channel.
pub(crate) fn channel<T>() -> (Sender<T>, Receiver<T>) {
    let state = State { queue: VecDeque::new(), sender: true, receiver: true };
    let shared = Arc::new(Shared { state: Mutex::new(state), changed: Condvar::new() });
    (Sender(shared.clone()), Receiver(shared))
}

impl<T> Sender<T> {
    /// Sends a value; returns it if the receiver is gone.
    pub fn send(&self, thing: T) -> Result<(), SendError<T>> {
        self.change(|state| {
            if !state.receiver {
                return Err(SendError(thing));
            }
            state.queue.push_back(thing);
            Ok(())
        })
    }

    /// Does something to the state and wakes the receiver.
    fn change<R>(&self, act: impl FnOnce(&mut State<T>) -> R) -> R {
        let result = act(&mut self.0.state.lock().unwrap());
        self.0.changed.notify_one();
        result
    }
}

impl<T> Receiver<T> {
    /// Waits for the oldest value; an error if there is none and the sender is gone.
    pub fn recv(&self) -> Result<T, RecvError> {
        let mut state = self.0.state.lock().unwrap();
        loop {
            if let Some(thing) = state.queue.pop_front() {
                return Ok(thing);
            }
            if !state.sender {
                return Err(RecvError);
            }
            state = self.0.changed.wait(state).unwrap();
        }
    }
}

impl<T> Iterator for Receiver<T> {
    type Item = T;

    fn next(&mut self) -> Option<T> {
        self.recv().ok()
    }
}

impl<T> Drop for Sender<T> {
    fn drop(&mut self) {
        self.change(|state| state.sender = false);
    }
}

impl<T> Drop for Receiver<T> {
    fn drop(&mut self) {
        let mut state = self.0.state.lock().unwrap();
        state.receiver = false;
        let left = std::mem::take(&mut state.queue);
        drop(state);
        // Without the lock: a thing may hold the other end of a channel.
        drop(left);
    }
}

mod tests {
    use std::mem::ManuallyDrop;

    use super::*;
    use crate::explore::explore;

    #[test]
    fn things_come_in_order_and_then_the_end() {
        explore(|| {
            let (sender, receiver) = channel();
            let thread = loom::thread::spawn(move || {
                for number in 0..2 {
                    sender.send(number).unwrap();
                }
            });
            assert_eq!([receiver.recv(), receiver.recv(), receiver.recv()], [Ok(0), Ok(1), Err(RecvError)]);
            thread.join().unwrap();
        });
    }

    #[test]
    fn what_nobody_receives_comes_back_or_is_dropped() {
        explore(|| {
            let (sender, receiver) = channel();
            let thing = Arc::new(());
            let thread = loom::thread::spawn(move || drop(receiver));
            let first = sender.send(thing.clone());
            thread.join().unwrap();
            assert_eq!(Arc::strong_count(&thing), 1 + usize::from(first.is_err()), "the channel keeps none");
            assert!(sender.send(thing).is_err());
        });
    }

    #[test]
    #[should_panic = "deadlock"]
    fn who_waits_for_nothing_waits_for_ever() {
        explore(|| {
            // At a standstill the ends of a channel cannot be dropped any more.
            let ends = ManuallyDrop::new(channel::<()>());
            let _ = ends.1.recv();
        });
    }
}
