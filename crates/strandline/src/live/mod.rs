//! Hair that plays until it is told otherwise, for windows: nothing here makes its caller wait.

mod course;
mod desk;
mod messages;
mod recorder;
mod stage;

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;

pub use messages::{Command, News, Shown};

use desk::{Desk, Message};
use messages::Out;

use crate::{Error, Scene};

/// A scene that plays on threads of its own: one simulates, one draws [Chen2011 §5].
pub struct Live {
    commands: Option<Sender<Message>>,
    told: AtomicU64,
    out: Arc<Mutex<Out>>,
    thread: Option<JoinHandle<()>>,
}

impl Live {
    /// Starts the threads and loads a scene. `wake` is called when there is something new.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn new(scene: Scene, wake: impl Fn() + Send + 'static) -> Result<Self, Error> {
        let (commands, messages) = channel();
        let out = Arc::new(Mutex::new(Out::default()));
        let desk = Desk::new(messages, commands.clone(), out.clone(), Box::new(wake));
        let thread = std::thread::Builder::new()
            .name("drawing".to_owned())
            .spawn(move || desk.run())
            .map_err(Error::Thread)?;
        let live = Self { commands: Some(commands), told: AtomicU64::new(0), out, thread: Some(thread) };
        live.tell(Command::Load(Box::new(scene)));
        Ok(live)
    }

    /// Tells it something; never waits. Returns the command's number: pictures that were drawn after it was
    /// heard have at least this [`Shown::heard`].
    pub fn tell(&self, command: Command) -> u64 {
        // Without a thread there is nobody to tell: its last words are in the news.
        let _ = self.commands.as_ref().map(|commands| commands.send(Message::Command(command)));
        self.told.fetch_add(1, Ordering::Relaxed) + 1
    }

    /// The newest picture, if there is one that was not taken yet.
    pub fn take_shown(&self) -> Option<Shown> {
        self.out().shown.take()
    }

    /// What happened since the last call.
    pub fn take_news(&self) -> Vec<News> {
        self.out().news.drain(..).collect()
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
