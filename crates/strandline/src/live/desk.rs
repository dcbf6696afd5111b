//! The drawing thread.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use strandline_base::Stopwatch;

use super::course::{Course, changes_cost, of_size};
use super::messages::{Command, FRAME, News, Out, Shown};
use super::recorder::Recorder;
use super::stage::Stage;
use crate::{Error, FilmFiles, Scene, sim::StepReport, worker::Gone};

/// What the drawing thread is told.
pub(super) enum Message {
    Command(Command),
    /// The scene of the load with this number.
    Loaded(u64, Result<Box<Stage>, Error>),
    /// The film with this number is over.
    Recorded(u64, Result<FilmFiles, Error>),
    /// Nobody looks any more.
    End,
}

/// The drawing thread.
pub(super) struct Desk {
    messages: Receiver<Message>,
    own: Sender<Message>,
    out: Arc<Mutex<Out>>,
    wake: Box<dyn Fn() + Send>,
}

impl Desk {
    pub fn new(
        messages: Receiver<Message>,
        own: Sender<Message>,
        out: Arc<Mutex<Out>>,
        wake: Box<dyn Fn() + Send>,
    ) -> Self {
        Self { messages, own, out, wake }
    }

    pub fn run(self) {
        let mut course = Course::START;
        let played = catch_unwind(AssertUnwindSafe(|| self.play(&mut course)));
        if played.is_err() {
            self.say(News::Error(Error::WorkerGone.to_string()));
            self.say(News::Paused);
        }
        // Films under way are finished.
        course.finishing.extend(course.recorder.take().map(Recorder::finish));
        for film in course.finishing {
            let _ = film.join();
        }
    }

    fn play(&self, course: &mut Course) {
        loop {
            let mut next = self.messages.recv_timeout(course.patience());
            // Nothing happened for a moment: what was drawn simpler is drawn in full.
            let rests = next.is_err() && !course.playing && course.steps == 0;
            let mut full = rests && course.draft && !course.stale;
            course.stale |= full;
            loop {
                match next {
                    Ok(Message::End) | Err(RecvTimeoutError::Disconnected) => return,
                    Ok(message) => {
                        full = false;
                        self.hear(course, message);
                    }
                    Err(RecvTimeoutError::Timeout) => break,
                }
                next = self.messages.recv_timeout(Duration::ZERO);
            }
            let draft = course.adapts && course.slow && !full && course.recorder.is_none();
            if let Err(error) = self.frame(course, draft) {
                self.say(News::Error(error.to_string()));
                self.say(News::Paused);
                // What fails now fails again: it waits to be told something else.
                (course.playing, course.steps, course.stale, course.draft) = (false, 0, false, false);
            }
        }
    }

    fn hear(&self, course: &mut Course, message: Message) {
        let command = match message {
            Message::Command(command) => command,
            Message::Loaded(load, stage) => return self.take_stage(course, load, stage),
            Message::Recorded(film, files) => return self.tell_film(course, film, files),
            Message::End => return,
        };
        course.heard += 1;
        match command {
            Command::Load(scene) => {
                course.load = course.heard;
                self.load(scene, course.load);
            }
            // Steps that were asked for before are among those it plays.
            Command::Play(true) => (course.playing, course.steps) = (true, 0),
            Command::Play(false) => course.playing = false,
            Command::Step => course.steps += u32::from(!course.playing),
            Command::Adapt(adapts) => course.adapts = adapts,
            Command::Save(scene, load, path) => self.save(course, *scene, load, path),
            Command::Record(folder) => self.record(course, &folder),
            Command::StopRecording => course.finishing.extend(course.recorder.take().map(Recorder::finish)),
            other => {
                if matches!(other, Command::Reset) {
                    // Steps before it lead to nothing.
                    course.steps = 0;
                }
                course.stale = true;
                course.tried &= !changes_cost(&other);
                let fixed = course.recorder.is_some();
                let Some(stage) = &mut course.stage else { return };
                let other = if fixed { of_size(other, stage.picture()) } else { other };
                self.change(stage, other);
            }
        }
    }

    fn change(&self, stage: &mut Stage, command: Command) {
        if let Err(error) = stage.change(command) {
            self.say(News::Error(error.to_string()));
        }
    }

    fn take_stage(&self, course: &mut Course, load: u64, loaded: Result<Box<Stage>, Error>) {
        match loaded {
            // Another scene was asked for since.
            _ if load != course.load => {}
            Ok(mut stage) => {
                let Stage { scene, camera, bounds, notes, .. } = &*stage;
                self.say(News::Loaded(load, scene.clone(), *camera, *bounds, notes.clone()));
                if let (Some(old), Some(_)) = (&course.stage, &course.recorder) {
                    let picture = Command::Picture(stage.picture());
                    self.change(&mut stage, of_size(picture, old.picture()));
                }
                // Until one is drawn nobody knows how long it takes: the first is there sooner when simple.
                (course.stale, course.tried) = (true, false);
                course.slow = stage.studio.painter.gpu().is_none();
                (course.stage, course.staged) = (Some(stage), load);
                (course.step, course.is_frame) = (None, false);
            }
            Err(error) => self.say(News::NotLoaded(load, error.to_string())),
        }
    }

    /// Loads on a thread of its own, so that what plays goes on.
    fn load(&self, scene: Box<Scene>, number: u64) {
        let own = self.own.clone();
        let job = move || {
            let loaded = catch_unwind(|| Stage::new(&scene)).unwrap_or(Err(Error::WorkerGone)).map(Box::new);
            // Nobody waits for it any more when the window is closed.
            let _ = own.send(Message::Loaded(number, loaded));
        };
        if let Err(error) = std::thread::Builder::new().name("loading".to_owned()).spawn(job) {
            self.say(News::NotLoaded(number, Error::Thread(error).to_string()));
        }
    }

    fn record(&self, course: &mut Course, folder: &Path) {
        if course.recorder.is_some() {
            return;
        }
        let own = self.own.clone();
        course.film += 1;
        let film = course.film;
        let done = move |files| {
            let _ = own.send(Message::Recorded(film, files));
        };
        match Recorder::new(folder, (1.0 / FRAME) as f32, done) {
            Ok(recorder) => course.recorder = Some(recorder),
            Err(error) => {
                self.say(News::Error(error.to_string()));
                self.say(News::Recorded);
            }
        }
    }

    fn tell_film(&self, course: &mut Course, number: u64, film: Result<FilmFiles, Error>) {
        course.finishing.retain(|thread| !thread.is_finished());
        match film {
            Ok(film) => {
                let files = film.files.last().map(|path| format!("wrote {}", path.display()));
                film.notes.into_iter().chain(files).for_each(|note| self.say(News::Note(note)));
            }
            Err(error) => {
                if number == course.film {
                    // It may have ended by itself.
                    course.finishing.extend(course.recorder.take().map(Recorder::finish));
                }
                self.say(News::Error(error.to_string()));
            }
        }
        self.say(News::Recorded);
    }

    /// Saves a scene, with the hair as the commands before this one left it.
    fn save(&self, course: &mut Course, scene: Scene, load: u64, path: PathBuf) {
        if let Err(error) = self.catch_up(course).and_then(|()| self.make_steps(course)) {
            // The last good state is still there.
            self.say(News::Error(error.to_string()));
        }
        self.say(match &course.stage {
            Some(stage) if course.staged == load => match stage.save(scene, &path) {
                Ok(()) => News::Saved(path),
                Err(error) => News::Error(error.to_string()),
            },
            Some(_) => News::Error("not saved, as another scene has just come: save again".to_owned()),
            None => News::Error("there is no hair to save yet".to_owned()),
        });
    }

    /// Waits for all that the simulation has begun.
    fn catch_up(&self, course: &mut Course) -> Result<(), Error> {
        let Some(stage) = &mut course.stage else { return Ok(()) };
        while stage.worker.started() > 0 {
            course.stale = true;
            let (step, is_frame) = self.take(stage)?;
            course.step = step.or(course.step.take());
            course.is_frame |= is_frame;
        }
        Ok(())
    }

    /// Makes the steps that were asked for, without pictures between them unless they are recorded.
    fn make_steps(&self, course: &mut Course) -> Result<(), Error> {
        while course.steps > 0 && course.stage.is_some() {
            if course.recorder.is_some() {
                self.frame(course, false)?;
                continue;
            }
            course.steps -= 1;
            let Some(stage) = &mut course.stage else { break };
            stage.start(course.heard).map_err(|Gone| Error::WorkerGone)?;
            self.catch_up(course)?;
        }
        Ok(())
    }

    /// Simulates and draws one frame, as far as there is anything to do.
    fn frame(&self, course: &mut Course, draft: bool) -> Result<(), Error> {
        let Some(stage) = &mut course.stage else { return Ok(()) };
        let moves = (course.playing || course.steps > 0) && !course.is_frame;
        if moves && stage.worker.started() == 0 {
            stage.start(course.heard).map_err(|Gone| Error::WorkerGone)?;
            course.steps = course.steps.saturating_sub(1);
        }
        self.catch_up(course)?;
        let (step, is_frame) = (course.step.take(), std::mem::take(&mut course.is_frame));
        let Some(stage) = course.stage.as_mut().filter(|_| course.stale) else { return Ok(()) };
        if course.playing {
            stage.start(course.heard).map_err(|Gone| Error::WorkerGone)?;
        }
        let watch = Stopwatch::start();
        let (picture, drawing) = stage.draw(draft)?;
        std::mem::take(&mut stage.studio.painter.notes)
            .into_iter()
            .for_each(|note| self.say(News::Note(note)));
        let seconds = watch.seconds();
        if let Some(recorder) = course.recorder.as_mut().filter(|_| is_frame) {
            recorder.add(&picture);
        }
        (course.stale, course.draft) = (false, draft);
        course.frame += 1;
        self.show(Shown {
            picture,
            frame: course.frame,
            heard: course.heard,
            felt: stage.felt,
            draft,
            recorded: course.recorder.as_ref().map(|recorder| recorder.frames),
            drawing,
            step,
            grabbed: stage.grabbed,
            places: [stage.simulated_on.clone(), stage.studio.painter.drawn_on()],
        });
        course.judge(seconds, draft);
        Ok(())
    }

    /// Takes a result of the simulation: a setting that was refused is told, a device that failed ends it.
    fn take(&self, stage: &mut Stage) -> Result<(Option<StepReport>, bool), Error> {
        let (reports, notes, is_frame) = stage.take().map_err(|Gone| Error::WorkerGone)?;
        notes.into_iter().for_each(|note| self.say(News::Note(note)));
        match reports {
            Ok(mut reports) => Ok((reports.pop(), is_frame)),
            Err(error) if error.gpu().is_none() => {
                self.say(News::Error(error.to_string()));
                Ok((None, false))
            }
            Err(error) => Err(error.into()),
        }
    }

    fn say(&self, news: News) {
        self.out.lock().unwrap_or_else(PoisonError::into_inner).news.push_back(news);
        (self.wake)();
    }

    fn show(&self, shown: Shown) {
        let mut out = self.out.lock().unwrap_or_else(PoisonError::into_inner);
        // A step that nobody saw is still told.
        let unseen = out.shown.take().and_then(|old| old.step);
        out.shown = Some(Shown { step: shown.step.clone().or(unseen), ..shown });
        drop(out);
        (self.wake)();
    }
}
