//! Saving of a project.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;

use strandline_base::WholeFile;

use super::{FRAMES, notes::Scenes, sums};
use crate::{
    Error, Scene,
    body::BodyFrame,
    cache::{
        kept::{self, DirectionNote, FrameNote, MarkNote, Meta},
        relative,
    },
    live::timeline::{KeptFrame, Points, Timeline},
    scene::PROJECT_SCENE,
    session::{Bookmark, Executor, Session, Simulation},
    sim::StepReport,
    snapshot::Snapshot,
};

/// Most bytes of the states in a file.
const MOST_MARKS: u64 = 64 << 20;

/// A project that is written.
struct Project {
    folder: PathBuf,
    scene: Scene,
    meta: Meta,
    marks: Vec<Snapshot>,
    bodies: Vec<BodyFrame>,
    frames: Vec<(f64, Arc<Points>)>,
}

/// Writes a scene and the kept frames of its timeline to a folder, on a thread of its own; `tell` receives the share that is
/// written.
///
/// # Errors
/// The GPU failed; the folder cannot be made; the system gives no thread.
pub fn save<E: Executor>(
    (session, timeline): (&mut Session<E>, &Timeline),
    mut scene: Scene,
    folder: &Path,
    tell: impl Fn(f32) + Send + 'static,
    done: impl FnOnce(Result<PathBuf, Error>) + Send + 'static,
) -> Result<JoinHandle<()>, Error> {
    check_place(folder)?;
    std::fs::create_dir_all(folder).map_err(Error::save("the project", folder))?;
    scene.timeline.frames = None;
    let mut scenes = Scenes::default();
    let tasks = |frame: &KeptFrame| frame.made.as_ref().and_then(|made| scenes.notes(made));
    let tasks: Vec<_> = timeline.up_to_date().map(tasks).collect();
    let [first, ..] = timeline.bounds();
    let alone = |number: u32| tasks.get((number - first) as usize).is_none_or(Option::is_none);
    let marks = marks_of(session, timeline, alone)?;
    let origin = session.origin();
    let mut meta = meta_of(session, timeline);
    meta.origin = origin.to_array().map(f32::to_bits);
    meta.marks = marks.iter().map(|(frame, mark)| note_of(*frame, mark, &mut scenes)).collect();
    let (mut bodies, mut frames) = (Vec::new(), Vec::new());
    for (frame, tasks) in timeline.up_to_date().zip(tasks) {
        let steps = frame.reports.iter().map(step_of).collect();
        meta.frames.push(FrameNote { sum: 0, tasks, steps });
        if let Some(points) = &frame.points {
            bodies.push(frame.body.clone());
            frames.push((frame.time, points.clone()));
        }
    }
    meta.scenes = scenes.texts;
    let marks = marks.iter().map(|(frame, mark)| Snapshot {
        frame: *frame,
        time: mark.clock.time(),
        state: mark.state.clone(),
        bodies: [mark.bodies[0].clone(), mark.bodies[1].clone(), mark.end.clone()],
        origin,
    });
    let (marks, folder) = (marks.collect(), folder.to_owned());
    let project = Project { folder, scene, meta, marks, bodies, frames };
    let write = move || done(project.write(tell));
    std::thread::Builder::new().name("saving".to_owned()).spawn(write).map_err(Error::Thread)
}

/// Refuses a folder with files that are none of a project.
fn check_place(folder: &Path) -> Result<(), Error> {
    let (scene, frames) = (folder.join(PROJECT_SCENE), folder.join(FRAMES));
    let names_frames = |scene: Scene| scene.timeline.frames.as_deref() == Some(Path::new(FRAMES));
    let is_project = || Scene::load(&scene).is_ok_and(names_frames);
    if (!scene.exists() && !frames.exists()) || is_project() {
        return Ok(());
    }
    let taken = io::Error::new(
        io::ErrorKind::AlreadyExists,
        format!("it holds {PROJECT_SCENE} or {FRAMES} that are of no project: choose another folder"),
    );
    Err(Error::save("the project", folder)(taken))
}

/// Metadata without frames and marks.
fn meta_of<E: Executor>(session: &Session<E>, timeline: &Timeline) -> Meta {
    let [first, kept, good] = timeline.bounds();
    let guides = session.view().guides();
    let ([begun, offset], begins) = session.motion_times();
    Meta {
        strands: guides.strand_count() as u32,
        points: guides.points_per_strand() as u32,
        first,
        kept,
        shown: timeline.playhead.min(good),
        rest: sums::of_rest(session),
        direction: DirectionNote { begun: begun.to_bits(), offset: offset.to_bits(), begins },
        ..Meta::default()
    }
}

/// States of the project: those of the timeline, and that of the last frame where the simulation is there. `alone` tells
/// the frames to which nothing else leads.
fn marks_of<E: Executor>(
    session: &mut Session<E>,
    timeline: &Timeline,
    alone: impl Fn(u32) -> bool,
) -> Result<Vec<(u32, Arc<Bookmark>)>, Error> {
    let [first, _, good] = timeline.bounds();
    let numbered = (first..).zip(timeline.up_to_date());
    let mut marks: Vec<(u32, Arc<Bookmark>)> =
        numbered.filter_map(|(number, frame)| Some((number, frame.bookmark.clone()?))).collect();
    let is_there = timeline.at == good && session.grabbed() == 0;
    if is_there && marks.last().is_none_or(|(last, _)| *last != good) {
        marks.push((good, Arc::new(session.with(Simulation::bookmark)?)));
    }
    let bytes = |marks: &[(u32, Arc<Bookmark>)]| marks.iter().map(|(_, mark)| mark.bytes()).sum::<u64>();
    while marks.len() > 2 && bytes(&marks) > MOST_MARKS {
        // Every second goes; the first and the last stay.
        let last = marks.len() - 1;
        let stays = |(index, mark): &(usize, &(u32, _))| index % 2 == 0 || *index == last || alone(mark.0);
        let thinned: Vec<_> = marks.iter().enumerate().filter(stays).map(|(_, mark)| mark.clone()).collect();
        if thinned.len() == marks.len() {
            break;
        }
        marks = thinned;
    }
    Ok(marks)
}

fn note_of(frame: u32, mark: &Bookmark, scenes: &mut Scenes) -> MarkNote {
    let (times, steps) = mark.clock.numbers();
    MarkNote {
        frame,
        scene: scenes.of_settings(&mark.settings),
        clock: (times.map(f64::to_bits), steps),
        share: mark.share.to_bits(),
        passed: mark.passed.to_bits(),
        is_exact: mark.exact.is_some(),
    }
}

fn step_of(step: &StepReport) -> ([u32; 3], u64) {
    let numbers = [step.stretch_mean, step.stretch_max, step.penetration_max];
    (numbers.map(f32::to_bits), step.non_finite as u64)
}

impl Project {
    /// Writes both files under temporary names, then renames the frames and the scene that names them.
    fn write(self, tell: impl Fn(f32)) -> Result<PathBuf, Error> {
        let Self { folder, scene, mut meta, marks, bodies, frames } = self;
        let (place, path) = (folder.join(FRAMES), folder.join(PROJECT_SCENE));
        let mut moved = relative::from(&path, &scene);
        moved.timeline.frames = Some(FRAMES.into());
        meta.scene = moved.to_toml();
        meta.files = sums::of(&scene);
        let count = frames.len().max(1);
        let points = |row: usize| {
            let (time, points) = frames.get(row).ok_or(io::ErrorKind::NotFound)?;
            points.read().map(|points| (*time, points))
        };
        let part = |row: usize| {
            if row.is_multiple_of(count.div_ceil(50)) {
                tell(row as f32 / count as f32);
            }
        };
        let text = meta.scene.clone();
        let written = WholeFile::write(&path, |file| io::Write::write_all(file, text.as_bytes()))
            .map_err(Error::save("the scene", &path))?;
        kept::write(&place, meta, &marks, &bodies, points, part)
            .map_err(Error::save("the kept frames", &place))?;
        written.keep().map_err(Error::save("the scene", &path))?;
        Ok(folder)
    }
}
