//! Hair that plays on threads of its own, for windows: nothing here makes its caller wait.

mod clock;
mod drawing_thread;
mod export;
mod films;
mod keeping;
mod loaded;
mod messages;
mod overlaid;
mod overlay;
mod playing;
mod project;
mod recorder;
mod timeline;

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;

pub use clock::LiveClock;
pub use messages::{Command, LiveEvent, LoadStage, Shown};
pub use overlaid::{Overlaid, Overlay};
pub use timeline::{Pace, TimelineShown};

use drawing_thread::{DrawingThread, Message};
use messages::Out;

use crate::{Error, Scene};

/// A scene that plays on threads of its own: one simulates, one draws [Chen2011 §5].
pub struct Live {
    commands: Option<Sender<Message>>,
    sent: AtomicU64,
    out: Arc<Mutex<Out>>,
    thread: Option<JoinHandle<()>>,
}

impl Live {
    /// Starts the threads and loads a scene. `wake` is called when there is something new.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn new(scene: Scene, wake: impl Fn() + Send + 'static) -> Result<Self, Error> {
        Self::with_clock(scene, wake, LiveClock::default())
    }

    /// As [`Live::new`], by a clock of its own: see [`LiveClock::manual`].
    ///
    /// # Errors
    /// As [`Live::new`].
    pub fn with_clock(
        scene: Scene,
        wake: impl Fn() + Send + 'static,
        clock: LiveClock,
    ) -> Result<Self, Error> {
        let (commands, messages) = channel();
        let out = Arc::new(Mutex::new(Out::default()));
        let drawing = DrawingThread::new(messages, commands.clone(), out.clone(), Box::new(wake), clock);
        let thread = std::thread::Builder::new()
            .name("drawing".to_owned())
            .spawn(move || drawing.run())
            .map_err(Error::Thread)?;
        let live = Self { commands: Some(commands), sent: AtomicU64::new(0), out, thread: Some(thread) };
        live.send(Command::Load(Box::new(scene)));
        Ok(live)
    }

    /// Sends a command; never waits. Returns its number: pictures that were drawn after it have at least this
    /// [`Shown::drawn_after_command`].
    pub fn send(&self, command: impl Into<Command>) -> u64 {
        // Without a thread it is lost: the last event says why.
        let _ = self.commands.as_ref().map(|commands| commands.send(Message::Command(command.into())));
        self.sent.fetch_add(1, Ordering::Relaxed) + 1
    }

    /// Waits until all work is done that does not wait for time: no scene is loading, nothing plays or changes. The last
    /// picture can be taken then.
    pub fn wait_idle(&self) {
        let (idler, idle) = channel();
        let sent = self.commands.as_ref().is_some_and(|commands| commands.send(Message::Idle(idler)).is_ok());
        if sent {
            // Without an answer the thread has ended, and nothing is left either.
            let _ = idle.recv();
        }
    }

    /// The newest picture, if there is one that was not taken yet.
    pub fn take_shown(&self) -> Option<Shown> {
        self.out().shown.take()
    }

    /// Events since the last call, in order.
    pub fn take_events(&self) -> Vec<LiveEvent> {
        self.out().events.drain(..).collect()
    }

    fn out(&self) -> std::sync::MutexGuard<'_, Out> {
        self.out.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        // The thread holds a sender too, so that it does not end by itself.
        if let Some(commands) = self.commands.take() {
            let _ = commands.send(Message::End);
        }
        let _ = self.thread.take().map(JoinHandle::join);
    }
}
