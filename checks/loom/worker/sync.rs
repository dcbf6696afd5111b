//! The primitives of `crates/strandline/src/session/sync.rs`, made of loom's.

pub(crate) use loom::sync::{Arc, Mutex, MutexGuard};
pub(crate) use std::sync::PoisonError;

pub(crate) use crate::channel::{Receiver, Sender, channel};
pub(crate) use crate::thread;
