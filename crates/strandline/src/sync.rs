//! What threads meet by, in one place, so that `checks/loom` can put primitives that it controls in the
//! place of the standard library's.

pub(crate) use std::sync::mpsc::{Receiver, Sender, channel};
pub(crate) use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
pub(crate) use std::thread;
