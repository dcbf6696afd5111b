//! The drawing thread.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use super::clock::{Deadline, LiveClock};
use super::loaded::Loaded;
use super::messages::{Command, LiveEvent, Out, Shown};
use super::playing::{Drafts, Playing, changes_cost, of_size};
use super::recorder::Recorder;
use super::timeline::Range;
use crate::{
    Error, ErrorKind, Scene, Sources, Written,
    film::FilmFiles,
    prepare::Unbrushed,
    render::{FrameReport, Picture},
    session::{Change, Event},
};

/// A message to the drawing thread.
pub(super) enum Message {
    Command(Command),
    /// The scene of the load with this number.
    Loaded(u64, Result<Box<Loaded>, Error>),
    /// The stage of a load, and the hair as far as it is there.
    Loading(Box<LiveEvent>),
    /// The film with this number is over.
    Recorded(u64, Result<FilmFiles, Error>),
    /// A share of a project is written, or all of it.
    Saving(f32),
    SavedProject(Result<PathBuf, Error>),
    /// Kept frames are written.
    Exported(Result<Written, Error>),
    /// Somebody waits until nothing is left to do.
    Idle(Sender<()>),
    /// A clock that stood still was moved on.
    Advanced,
    /// Nobody looks any more.
    End,
}

/// The drawing thread.
pub(super) struct DrawingThread {
    messages: Receiver<Message>,
    pub(super) own: Sender<Message>,
    out: Arc<Mutex<Out>>,
    wake: Box<dyn Fn() + Send>,
    clock: LiveClock,
    /// The last scene that was loaded, before its strokes.
    unbrushed: Arc<Mutex<Option<Arc<Unbrushed>>>>,
}

impl DrawingThread {
    pub fn new(
        messages: Receiver<Message>,
        own: Sender<Message>,
        out: Arc<Mutex<Out>>,
        wake: Box<dyn Fn() + Send>,
        clock: LiveClock,
    ) -> Self {
        let advanced = own.clone();
        // After the end no thread receives it.
        clock.on_advance(move || drop(advanced.send(Message::Advanced)));
        Self { messages, own, out, wake, clock, unbrushed: Arc::default() }
    }

    pub fn run(self) {
        let mut playing = Playing::START;
        let played = catch_unwind(AssertUnwindSafe(|| self.play(&mut playing)));
        if played.is_err() {
            self.emit(Error::WorkerGone.into());
            self.emit(LiveEvent::Paused);
        }
        // Films under way are finished.
        playing.finishing.extend(playing.recorder.take().map(Recorder::finish));
        for film in playing.finishing {
            let _ = film.join();
        }
    }

    fn play(&self, playing: &mut Playing) {
        loop {
            let deadline = self.clock.after(playing.patience(self.clock.now()));
            if playing.is_idle() {
                // The caller that waits may be gone.
                for idler in playing.idlers.drain(..) {
                    let _ = idler.send(());
                }
            }
            let mut next = self.next(&deadline);
            // Nothing happened for a moment: what was drawn simpler is drawn in full.
            let rests = next.is_err() && !playing.playing && playing.steps == 0;
            let mut full = rests && playing.draft && !playing.stale;
            playing.stale |= full;
            loop {
                match next {
                    Ok(Message::End) | Err(RecvTimeoutError::Disconnected) => return,
                    Ok(message) => {
                        full = false;
                        self.receive(playing, message);
                    }
                    Err(RecvTimeoutError::Timeout) => break,
                }
                next = self.next(&self.clock.after(Duration::ZERO));
            }
            let draft = playing.adapts && playing.slow && !full && playing.recorder.is_none();
            if let Err(error) = self.frame(playing, draft) {
                self.emit(error.into());
                self.emit(LiveEvent::Paused);
                // A frame that fails fails again: it waits for another command.
                (playing.playing, playing.steps, playing.stale, playing.draft) = (false, 0, false, false);
            }
        }
    }

    fn next(&self, deadline: &Deadline) -> Result<Message, RecvTimeoutError> {
        self.clock.receive(&self.messages, deadline, |message| matches!(message, Message::Advanced))
    }

    fn receive(&self, playing: &mut Playing, message: Message) {
        let command = match message {
            Message::Command(command) => command,
            Message::Loaded(load, loaded) => return self.take_scene(playing, load, loaded),
            Message::Loading(stage) => return self.emit(*stage),
            Message::Recorded(film, files) => return self.tell_film(playing, film, files),
            Message::Exported(written) => {
                return self.emit(written.map_or_else(LiveEvent::from, LiveEvent::Exported));
            }
            Message::Saving(share) => return self.emit(LiveEvent::Saving(share)),
            Message::SavedProject(saved) => {
                return self.emit(saved.map_or_else(LiveEvent::from, LiveEvent::Saved));
            }
            Message::Idle(idler) => return playing.idlers.push(idler),
            Message::Advanced | Message::End => return,
        };
        playing.received += 1;
        match command {
            Command::Load(scene) => self.load(playing, scene, Box::default()),
            Command::LoadSources(scene, sources) => self.load(playing, scene, sources),
            // Steps that were asked for before are among those it plays.
            Command::Play(true) => playing.play(self.clock.now()),
            Command::Play(false) => playing.playing = false,
            Command::Step => playing.steps += u32::from(!playing.playing),
            Command::Adapt(adapts) => playing.adapts = adapts,
            Command::Overlay(overlay) => (playing.overlay, playing.stale) = (overlay, true),
            Command::Save(scene, load, path) => self.save(playing, *scene, load, path),
            Command::SaveProject(scene, load, folder) => self.save_project(playing, *scene, load, &folder),
            Command::Record(folder) => self.record(playing, &folder),
            Command::StopRecording => playing.finishing.extend(playing.recorder.take().map(Recorder::finish)),
            Command::Change(change) => self.change(playing, change),
            Command::Touch(rays) => {
                let touched = playing.scene.as_ref().and_then(|loaded| loaded.session.touch(rays));
                self.emit(LiveEvent::Touched(touched));
            }
            Command::Seek(frame) => self.seek(playing, frame),
            Command::Range(marks, loops) => {
                playing.set_range(|range| (range.marks, range.loops) = (marks, loops))
            }
            Command::Pace(pace) => playing.set_range(|range| range.pace = pace),
            Command::Export(scene, settings, frames) => self.export(playing, *scene, &settings, frames),
        }
    }

    fn change(&self, playing: &mut Playing, change: Change) {
        if matches!(change, Change::Reset) {
            // Steps before it lead to nothing.
            playing.steps = 0;
        }
        playing.stale = true;
        playing.tried &= !changes_cost(&change);
        let fixed = playing.recorder.is_some();
        let Some(loaded) = playing.scene.as_deref_mut() else { return };
        let change = if fixed { of_size(change, loaded.session.settings()) } else { change };
        if let Err(error) = loaded.change(change) {
            self.emit(error.into());
        }
    }

    fn take_scene(&self, playing: &mut Playing, load: u64, loaded: Result<Box<Loaded>, Error>) {
        playing.loading -= 1;
        match loaded {
            // Another scene was asked for since.
            _ if load != playing.load => {}
            Ok(mut loaded) => {
                let Loaded { session, notes, timeline, .. } = &mut *loaded;
                timeline.range = Range { due: self.clock.now(), ..playing.range };
                let (camera, bounds) = (*session.camera_at_rest(), session.view().bounds());
                let scene = Box::new(session.scene().clone());
                self.emit(LiveEvent::Loaded(load, scene, camera, bounds, notes.clone()));
                if let (Some(old), Some(_)) = (&playing.scene, &playing.recorder) {
                    let picture = of_size(Change::Picture(session.settings()), old.session.settings());
                    if let Err(error) = session.change(picture) {
                        self.emit(error.into());
                    }
                }
                // The time of one is known once it is drawn: the first is there sooner when simple.
                (playing.stale, playing.tried) = (true, false);
                playing.drafts = Drafts::START;
                playing.slow = session.view().gpu().is_none();
                (playing.scene, playing.loaded) = (Some(loaded), load);
                (playing.step, playing.is_frame) = (None, false);
            }
            Err(error) => self.emit(LiveEvent::NotLoaded(load, error.kind(), error.to_string())),
        }
    }

    /// Loads on a thread of its own, so that what plays continues.
    fn load(&self, playing: &mut Playing, scene: Box<Scene>, sources: Box<Sources>) {
        playing.load = playing.received;
        playing.loading += 1;
        let (own, number, unbrushed) = (self.own.clone(), playing.load, self.unbrushed.clone());
        let job = move || {
            let tell = |stage, hair| {
                drop(own.send(Message::Loading(Box::new(LiveEvent::Loading(number, stage, hair)))))
            };
            let mut kept = unbrushed.lock().unwrap_or_else(PoisonError::into_inner).clone();
            let loaded = catch_unwind(AssertUnwindSafe(|| Loaded::new(&scene, &sources, &mut kept, &tell)))
                .unwrap_or(Err(Error::WorkerGone))
                .map(Box::new);
            *unbrushed.lock().unwrap_or_else(PoisonError::into_inner) = kept;
            // Nobody waits for it any more when the window is closed.
            let _ = own.send(Message::Loaded(number, loaded));
        };
        if let Err(error) = std::thread::Builder::new().name("loading".to_owned()).spawn(job) {
            playing.loading -= 1;
            let error = Error::Thread(error);
            self.emit(LiveEvent::NotLoaded(number, error.kind(), error.to_string()));
        }
    }

    /// Shows a kept frame, after all that the simulation has begun.
    fn seek(&self, playing: &mut Playing, frame: u32) {
        playing.steps = 0;
        let caught_up = self.catch_up(playing);
        playing.is_frame = false;
        let Some(loaded) = &mut playing.scene else { return };
        let shown = caught_up.and_then(|()| loaded.show(loaded.timeline.nearest(frame)));
        loaded.timeline.range.due = self.clock.now();
        playing.stale = true;
        if let Err(error) = shown {
            self.emit(error.into());
        }
    }

    /// Saves a scene, with the hair as the commands before this one left it.
    fn save(&self, playing: &mut Playing, scene: Scene, load: u64, path: PathBuf) {
        if let Err(error) = self.catch_up(playing).and_then(|()| self.make_steps(playing)) {
            // The last good state is still there.
            self.emit(error.into());
        }
        let Some(loaded) = self.loaded_of(playing, load) else { return };
        self.emit(match loaded.save(scene, &path) {
            Ok(()) => LiveEvent::Saved(path),
            Err(error) => error.into(),
        });
    }

    /// The scene that plays, if it comes from a load; else tells that it is not saved.
    pub(super) fn loaded_of<'a>(&self, playing: &'a mut Playing, load: u64) -> Option<&'a mut Loaded> {
        let is_there = playing.scene.is_some();
        if is_there && playing.loaded == load {
            return playing.scene.as_deref_mut();
        }
        let why = match is_there {
            true => "not saved, as another scene has just come: save again",
            false => "there is no hair to save yet",
        };
        self.emit(LiveEvent::Error(ErrorKind::Other, why.to_owned()));
        None
    }

    /// Waits for all that the simulation has begun.
    pub(super) fn catch_up(&self, playing: &mut Playing) -> Result<(), Error> {
        while playing.scene.as_ref().is_some_and(|loaded| loaded.session.started() > 0) {
            playing.stale = true;
            self.take(playing)?;
        }
        Ok(())
    }

    /// Makes the steps that were asked for, without pictures between them unless they are recorded.
    pub(super) fn make_steps(&self, playing: &mut Playing) -> Result<(), Error> {
        while playing.steps > 0 && playing.scene.is_some() {
            if playing.recorder.is_some() {
                self.frame(playing, false)?;
                continue;
            }
            playing.steps -= 1;
            let Some(loaded) = &mut playing.scene else { break };
            loaded.advance(playing.received, self.clock.now())?;
            self.catch_up(playing)?;
        }
        Ok(())
    }

    /// Simulates and draws one frame, as far as there is anything to do.
    fn frame(&self, playing: &mut Playing, draft: bool) -> Result<(), Error> {
        let Some(loaded) = &mut playing.scene else { return Ok(()) };
        let now = self.clock.now();
        let is_due = playing.steps > 0 || loaded.timeline.range.wait(now).is_zero();
        let moves = (playing.playing || playing.steps > 0) && !playing.is_frame;
        if moves && is_due && loaded.session.started() == 0 {
            let shows = loaded.advance(playing.received, now)?;
            (playing.is_frame, playing.stale) = (playing.is_frame | shows, playing.stale | shows);
            playing.steps = playing.steps.saturating_sub(1);
        }
        // A frame that is there before its time waits for it.
        if is_due || !playing.playing || loaded.session.started() != 1 || loaded.timeline.under_way.is_none()
        {
            self.catch_up(playing)?;
        }
        let is_frame = std::mem::take(&mut playing.is_frame);
        let Some(loaded) = playing.scene.as_mut().filter(|_| playing.stale) else { return Ok(()) };
        if playing.playing {
            loaded.prepare(playing.received)?;
        }
        let simpler = draft.then_some(playing.drafts.now);
        let (drawn, seconds) = self.clock.timed(|| loaded.session.draw(simpler));
        drawn?;
        (playing.stale, playing.draft) = (false, draft);
        self.pass_on(playing, is_frame);
        playing.judge(seconds, draft);
        Ok(())
    }

    /// Takes a result of the simulation: a setting that was refused is reported, a device that failed ends it.
    fn take(&self, playing: &mut Playing) -> Result<(), Error> {
        let Some(loaded) = &mut playing.scene else { return Ok(()) };
        match loaded.take(self.clock.now()) {
            Ok((is_frame, note)) => {
                playing.is_frame |= is_frame;
                note.into_iter().for_each(|note| self.emit(LiveEvent::Note(note)));
            }
            Err(Error::Sim(error)) if error.gpu().is_none() => self.emit(Error::from(error).into()),
            Err(error) => return Err(error),
        }
        self.pass_on(playing, false);
        Ok(())
    }

    /// Passes on what the session emitted: a picture, which is recorded where it is a frame.
    fn pass_on(&self, playing: &mut Playing, is_frame: bool) {
        while let Some(event) = playing.scene.as_mut().and_then(|loaded| loaded.session.next_event()) {
            match event {
                Event::Note(note) => self.emit(LiveEvent::Note(note)),
                Event::Stepped(report) => playing.step = Some(report),
                Event::Drawn { picture, report, .. } => {
                    if let Some(recorder) = playing.recorder.as_mut().filter(|_| is_frame) {
                        recorder.add(&picture);
                    }
                    self.show(playing, picture, report);
                }
            }
        }
    }

    fn show(&self, playing: &mut Playing, picture: Picture, drawing: FrameReport) {
        let Some(loaded) = playing.scene.as_deref_mut() else { return };
        let overlaid = playing.overlay.map(|overlay| loaded.overlaid(overlay)).transpose();
        let overlaid = overlaid.unwrap_or_else(|error| {
            self.emit(error.into());
            None
        });
        let session = &loaded.session;
        playing.frame += 1;
        let shown = Shown {
            picture,
            frame: playing.frame,
            drawn_after_command: playing.received,
            simulated_after_command: session.simulated_after(),
            draft: playing.draft,
            recorded: playing.recorder.as_ref().map(|recorder| recorder.frames),
            camera: Some(*session.view().camera()),
            follows_camera: session.follows_camera(),
            timeline: loaded.timeline.shown(loaded.rate(), session.motion_offset()),
            overlaid: overlaid.map(Arc::new),
            drawing,
            step: playing.step.take(),
            grabbed: session.grabbed(),
            stiffening: session.stiffening(),
            places: [session.simulated_on().to_owned(), session.view().drawn_on()],
        };
        let mut out = self.out.lock().unwrap_or_else(PoisonError::into_inner);
        // A step that was not seen is still reported.
        let unseen = out.shown.take().and_then(|old| old.step);
        out.shown = Some(Shown { step: shown.step.clone().or(unseen), ..shown });
        drop(out);
        (self.wake)();
    }

    pub(super) fn emit(&self, event: LiveEvent) {
        self.out.lock().unwrap_or_else(PoisonError::into_inner).events.push_back(event);
        (self.wake)();
    }
}
