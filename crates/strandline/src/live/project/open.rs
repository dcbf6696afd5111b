//! Opening of a project.

use std::path::Path;
use std::sync::Arc;

use super::{
    notes::{self, Room},
    sums,
};
use crate::{
    Error, Scene,
    body::BodyFrame,
    cache::kept::{FrameNote, KeptFile, MarkNote},
    groom::block_count,
    live::timeline::{KeptFrame, Points, Timeline},
    session::{Bookmark, Executor, Session, Weather, resuming},
    sim::{Clock, StepReport},
    snapshot::{Snapshot, arrays::check_memory},
};

/// Time \[s\] between a frame and its state that is more than a slow machine loses.
const MOST_APART: f64 = 10.0;

/// Fills a timeline with the kept frames that a scene names, and brings the simulation to the last of them. Returns notes
/// for a person, and true where frames were read; else the reason is among the notes.
pub fn open<E: Executor>(
    scene: &Scene,
    session: &mut Session<E>,
    timeline: &mut Timeline,
) -> (bool, Vec<String>) {
    let Some(file) = &scene.timeline.frames else { return (false, Vec::new()) };
    let path = scene.path(file);
    match restore(&path, scene, session, timeline) {
        Ok(notes) => (true, notes),
        Err(error) => (false, vec![format!("kept frames are left out: {error}")]),
    }
}

fn restore<E: Executor>(
    path: &Path,
    scene: &Scene,
    session: &mut Session<E>,
    timeline: &mut Timeline,
) -> Result<Vec<String>, Error> {
    let refuse = |found: String| Error::cache(path, found);
    let guides = session.view().guides();
    let shape = [guides.strand_count(), guides.points_per_strand()];
    let mut file = KeptFile::open(path, shape)?;
    check_same(&file, path, scene)?;
    if file.meta.rest != sums::of_rest(session) {
        return Err(refuse(
            "they are of hair or a body of another shape at rest, play to simulate them".to_owned(),
        ));
    }
    if file.meta.origin.map(f32::from_bits) != session.origin().to_array() {
        return Err(refuse("frames about another origin, expected that of the scene".to_owned()));
    }
    let mut notes = fill(&mut file, session, timeline, shape).map_err(refuse)?;
    let direction = file.meta.direction;
    let times = [f64::from_bits(direction.begun), f64::from_bits(direction.offset)];
    if times.iter().any(|time| !(time.abs() < 1e9)) {
        return Err(refuse("times of the motion that are none, expected seconds".to_owned()));
    }
    let last = timeline.bounds()[2];
    let (bookmark, tasks) =
        timeline.way_to(last).ok_or_else(|| refuse("no state before its last frame".to_owned()))?;
    session.go_on((bookmark, tasks), (times, direction.begins))?;
    timeline.playhead = timeline.nearest(file.meta.shown);
    notes.push(format!("{} kept frames are read: they need not be simulated again", file.count));
    Ok(notes)
}

/// Checks that the hair of a scene moves as it did when the frames were made.
fn check_same(file: &KeptFile, path: &Path, scene: &Scene) -> Result<(), Error> {
    let former = Scene::parse(&file.meta.scene, &format!("{} (in it)", path.display()))?;
    let mut differ = resuming::moving(&former, scene);
    differ.extend(sums::changed(&file.meta.files, &sums::of(scene)));
    if differ.is_empty() {
        return Ok(());
    }
    let found =
        format!("they are of other hair or another motion, play to simulate them: {}", differ.join(", "));
    Err(Error::cache(path, found))
}

/// Fills the timeline.
fn fill<E: Executor>(
    file: &mut KeptFile,
    session: &mut Session<E>,
    timeline: &mut Timeline,
    shape: [usize; 2],
) -> Result<Vec<String>, String> {
    let scenes = scenes_of(&file.meta.scenes)?;
    let mut marks = marks_of(file, &scenes, session)?;
    let mut weathers: Vec<Option<Arc<Weather>>> = vec![None; scenes.len()];
    let room = Room {
        strands: shape[0],
        blocks: block_count(shape[0]) * shape[1],
        rate: f64::from(session.scene().film.frames_per_second),
    };
    let [first, kept] = [file.meta.first, file.meta.kept];
    let origin = session.origin();
    let (mut notes, mut before) = (Vec::new(), None);
    timeline.empty(first, kept);
    for (number, note) in (first..).zip(file.meta.frames.clone()) {
        let bookmark = marks.iter_mut().find(|(frame, _)| *frame == number).and_then(|(_, mark)| mark.take());
        let mut weather = |index: usize| {
            if let Some(weather) = &weathers[index] {
                return Ok(weather.clone());
            }
            let (motion, wind) = (scenes[index].motion.clone(), scenes[index].wind.clone());
            let made = session.weather_of(motion, wind).map_err(|error| error.to_string())?;
            Ok(weathers[index].insert(made).clone())
        };
        let tasks = note.tasks.as_ref().filter(|_| number > first);
        let made =
            tasks.map(|tasks| notes::tasks(tasks, &scenes, before, &room, &mut weather)).transpose()?;
        if made.is_none() && bookmark.is_none() {
            return Err(format!("frame {number} without a way to it, expected tasks or a state"));
        }
        let ended = made.as_ref().map(|(_, live)| live.until);
        let reached = bookmark.as_ref().map(|mark| mark.clock.time());
        if let (Some(ended), Some(reached)) = (ended, reached)
            && !((reached - ended).abs() < MOST_APART)
        {
            return Err(format!("frame {number} ends at {ended} s, its state is at {reached} s"));
        }
        before = ended.or(reached);
        let reports = reports_of(&note);
        let mut frame =
            KeptFrame { points: None, body: BodyFrame::REST, origin, time: 0.0, made, bookmark, reports };
        if let Some(row) = number.checked_sub(kept) {
            let (time, body, points) = file.frame(row as usize)?;
            (frame.time, frame.body) = (time, session.recognized(body));
            frame.points = Some(Arc::new(Points::Memory(points)));
        }
        notes.extend(timeline.push(frame));
    }
    Ok(notes)
}

fn scenes_of(texts: &[String]) -> Result<Vec<Scene>, String> {
    let read = |text: &String| Scene::parse(text, "kept frames").map_err(|error| error.to_string());
    texts.iter().map(read).collect()
}

type Marks = Vec<(u32, Option<Arc<Bookmark>>)>;

/// States, whose memory is counted as they are read.
fn marks_of<E: Executor>(
    file: &mut KeptFile,
    scenes: &[Scene],
    session: &mut Session<E>,
) -> Result<Marks, String> {
    let (mut marks, mut bytes) = (Vec::new(), 0_u64);
    for (index, note) in file.meta.marks.clone().into_iter().enumerate() {
        let Snapshot { state, bodies, .. } = file.mark(index)?;
        let [before, now, end] = bodies.map(|body| session.recognized(body));
        let (clock, settings) = (clock_of(&note)?, scenes[note.scene].simulation.clone());
        if clock.time_step() != Clock::new(settings.time_step).time_step() {
            return Err(format!(
                "a clock of steps of {} s, expected {} s",
                clock.time_step(),
                settings.time_step
            ));
        }
        let (share, passed) = (f32::from_bits(note.share), f64::from_bits(note.passed));
        if !(0.0..=1.0).contains(&share) || !(passed.abs() < 1e9) {
            return Err(format!("a state with {passed} s and the share {share}, expected times"));
        }
        let mark = Bookmark {
            state,
            settings,
            clock,
            share,
            exact: note.is_exact.then(|| end.clone()),
            bodies: [before, now],
            end,
            passed,
        };
        bytes += mark.bytes();
        check_memory("states", bytes, 1)?;
        marks.push((note.frame, Some(Arc::new(mark))));
    }
    Ok(marks)
}

fn clock_of(note: &MarkNote) -> Result<Clock, String> {
    let (times, steps) = (note.clock.0.map(f64::from_bits), note.clock.1);
    Clock::of_numbers(times, steps)
        .ok_or_else(|| format!("a clock of {times:?} s and {steps} steps, expected one"))
}

fn reports_of(note: &FrameNote) -> Vec<StepReport> {
    let report = |(numbers, non_finite): &([u32; 3], u64)| {
        let [stretch_mean, stretch_max, penetration_max] = numbers.map(f32::from_bits);
        let non_finite = *non_finite as usize;
        StepReport { stretch_mean, stretch_max, penetration_max, non_finite, ..StepReport::default() }
    };
    note.steps.iter().map(report).collect()
}
