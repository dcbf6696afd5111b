//! `strandline render` and the demo: a scene becomes pictures.

use std::path::{Path, PathBuf};

use serde::Serialize;
use strandline::file::counted;
use strandline::mesh::Placement;
use strandline::{
    Backend, Cache, Error, Event, Player, Scene,
    file::{Film, PictureFiles},
    scene::{CameraKeyframe, Interpolation, MotionName},
};

use crate::arguments::{Inputs, RenderOptions, Usage};
use crate::interrupt::{Stoppable, Stopped};
use crate::non_finite::NonFinite;
use crate::output::{self, print_line};
use crate::progress::{LOADING, Progress, Waiting};
use crate::statistics::{Collector, Times};

/// Output of `render --json`.
#[derive(Debug, Serialize)]
struct RenderReport {
    backend: String,
    render_backend: String,
    frames: usize,
    /// Placement of groom and body, and the confidence in it.
    placement: Placement,
    follow_strands: usize,
    segments: usize,
    /// Pictures that were drawn while the next frame was simulated, all but the last; `None` for a film of one.
    ms_per_frame_beside_simulation: Option<Times>,
    /// The last picture, beside which nothing is simulated.
    ms_of_frame_alone: Times,
    #[serde(flatten)]
    non_finite: NonFinite,
    files: Vec<PathBuf>,
}

/// Pictures of the demo without a window, and how many a second.
const DEMO_PICTURES: u32 = 12;
const DEMO_RATE: f32 = 3.0;

/// The demo, into out/demo.
pub fn demo() -> anyhow::Result<()> {
    let mut scene = Scene::demo();
    (scene.film.frames, scene.film.frames_per_second) = (DEMO_PICTURES, DEMO_RATE);
    let folder = Path::new("out/demo");
    print_line!(
        "strandline demo: a head of {} hair shakes for {:.0} s; `strandline --help` shows what else there is",
        scene.style.style.name(),
        scene.film.frames as f32 / scene.film.frames_per_second
    );
    print_line!(
        "draws {} pictures of {} x {} into {}, in about a minute on two cores; ctrl C ends it",
        scene.film.frames,
        scene.picture.width,
        scene.picture.height,
        folder.display()
    );
    film(&scene, None, folder, false)
}

/// A scene as the command line names it.
pub fn render(options: &RenderOptions) -> anyhow::Result<()> {
    let cache = options.cache.as_deref().map(Cache::open).transpose()?;
    let mut scene = match &cache {
        Some(cache) => options.inputs.scene_of(cache)?,
        None => options.inputs.scene()?,
    };
    if let Some((width, height)) = options.size {
        (scene.picture.width, scene.picture.height) = (width, height);
    }
    if let Some(frames) = options.turntable {
        turn(&mut scene, frames, &options.inputs);
    }
    if let Some(path) = options.out.as_deref().filter(|path| has_ending(path, "png")) {
        return files(&scene, cache, path, options.inputs.json);
    }
    if let Some(path) = options.out.as_deref().filter(|path| has_ending(path, "exr")) {
        scene.picture.layers = true;
        if matches!(scene.devices.pictures, Backend::Gpu(_)) {
            output::note(
                "a GPU keeps light as half floats and depth to 0.1 mm; without its name the CPU draws",
            );
        } else {
            scene.devices.pictures = Backend::Cpu;
        }
        return files(&scene, cache, path, options.inputs.json);
    }
    if let Some(path) = options.out.as_deref().filter(|path| !path.is_dir() && is_of_file(path)) {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let expected = "a .png or .exr file, or a folder for numbered pictures and a video";
        return Err(
            Usage(format!("--out is a .{ending} file, expected {expected}: {}", path.display())).into()
        );
    }
    let name = options.cache.as_deref().and_then(Path::file_stem).map(Path::new);
    let name = name.map_or_else(|| options.inputs.name().into(), Path::to_owned);
    let folder = options.out.clone().unwrap_or_else(|| Path::new("out").join(name));
    film(&scene, cache, &folder, options.inputs.json)
}

/// Lets the camera go around once in a number of frames, so that the film begins again where it ends.
fn turn(scene: &mut Scene, frames: u32, inputs: &Inputs) {
    let seconds = |frames: f64| frames / f64::from(scene.film.frames_per_second);
    // The first frame is a frame after the beginning, or at it where hair begins in a pose.
    let begin = scene.film.start + seconds(f64::from(u8::from(scene.groom.pose.is_none())));
    let interpolation = Some(Interpolation::Linear);
    let first = CameraKeyframe { time: begin, interpolation, ..CameraKeyframe::default() };
    let last = CameraKeyframe { time: begin + seconds(f64::from(frames)), turn: 360.0, ..first };
    scene.camera.keyframes = vec![first, last];
    if inputs.frames.is_none() {
        scene.film.frames = frames;
    }
    if inputs.motion.is_none() {
        scene.set_motion(MotionName::Still);
    }
}

/// Endings of pictures, videos and scenes that nobody gives a folder.
const OF_FILES: [&str; 22] = [
    "jpg", "jpeg", "gif", "webp", "tif", "tiff", "bmp", "tga", "hdr", "avif", "jxl", "svg", "pdf", "mp4",
    "mov", "avi", "mkv", "webm", "npz", "usda", "hair", "toml",
];

/// True for a name that can only be that of a file.
fn is_of_file(path: &Path) -> bool {
    OF_FILES.iter().any(|ending| has_ending(path, ending))
}

fn has_ending(path: &Path, wanted: &str) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(wanted))
}

/// Player of a scene, or of a cache of it.
fn player(scene: &Scene, cache: Option<Cache>) -> Result<Player, Error> {
    match cache {
        Some(cache) => Player::showing(scene, scene.devices, cache),
        None => Player::new(scene, scene.devices, true),
    }
}

/// Writes a .png or .exr file, or a file per frame with its number before the ending.
fn files(scene: &Scene, cache: Option<Cache>, path: &Path, json: bool) -> anyhow::Result<()> {
    let waiting = Waiting::begin(LOADING);
    let mut player = player(scene, cache)?;
    drop(waiting);
    player.notes().iter().for_each(|note| output::note(note));
    let stoppable = Stoppable::begin();
    let mut film = PictureFiles::new(path, player.frames())?;
    let non_finite = play_files(&mut player, &mut film, has_ending(path, "exr"), &stoppable, json);
    if non_finite.is_err() && !film.is_empty() {
        output::note(&format!(
            "the {} whole: {}",
            counted(film.len(), "file already written is", "files already written are"),
            path.display()
        ));
    }
    let (files, notes) = film.finish();
    let non_finite = non_finite?;
    stoppable.finish();
    notes.iter().for_each(|note| output::note(note));
    if json {
        output::program(&format!(
            "{}\n",
            serde_json::json!({ "frames": files.len(), "placement": player.placement(), "files": files })
        ));
    } else {
        let last = files.last().map_or(path, PathBuf::as_path);
        print_line!("wrote {}: look at {}", counted(files.len(), "file", "files"), last.display());
    }
    Ok(non_finite.outcome()?)
}

fn play_files(
    player: &mut Player,
    film: &mut PictureFiles,
    layers: bool,
    stoppable: &Stoppable,
    quiet: bool,
) -> anyhow::Result<NonFinite> {
    let frames = u64::from(player.frames());
    let mut progress = Progress::new(frames, "frames", quiet);
    let mut non_finite = NonFinite::default();
    while let Some(event) = player.next() {
        match event? {
            Event::Note(note) => progress.note(&note),
            Event::Stepped(report) => {
                let note = non_finite.add(&report, player.frames_done());
                note.into_iter().for_each(|note| progress.note(&note));
            }
            Event::Drawn { report, .. } if layers => {
                report.layers.iter().try_for_each(|layers| film.add_layers(layers))?;
            }
            Event::Drawn { picture, .. } => film.add(&picture)?,
        }
        let done = u64::from(player.frames_done());
        progress.reached(done);
        if done < frames {
            stoppable.check(done, frames, "frames")?;
        }
    }
    Ok(non_finite)
}

fn film(scene: &Scene, cache: Option<Cache>, folder: &Path, json: bool) -> anyhow::Result<()> {
    let every = cache.as_ref().map_or(1, Cache::every);
    let source = cache.as_ref().map(|cache| cache.path().display().to_string());
    let waiting = Waiting::begin(LOADING);
    let mut player = player(scene, cache)?;
    drop(waiting);
    for note in player.notes() {
        output::note(note);
    }
    // A request to stop waits until the film is closed.
    let stoppable = Stoppable::begin();
    let mut film = Film::new(folder, player.frames(), scene.film.frames_per_second / every as f32)?;
    let mut drawn = PictureCosts::default();
    if let Err(error) = play(&mut player, &mut film, &mut drawn, &stoppable, json) {
        return Err(stopped_early(film, folder, error));
    }
    let written = film.finish()?;
    stoppable.finish();
    for note in &written.notes {
        output::note(note);
    }
    let PictureCosts { beside, alone, strands, segments, non_finite } = drawn;
    let report = RenderReport {
        backend: source.unwrap_or_else(|| player.simulated_on()),
        render_backend: player.drawn_on(),
        frames: beside.len() + alone.len(),
        placement: player.placement(),
        follow_strands: strands,
        segments,
        ms_per_frame_beside_simulation: (beside.len() > 0).then(|| beside.times()),
        ms_of_frame_alone: alone.times(),
        non_finite,
        files: written.files,
    };
    if json {
        output::program(&format!("{}\n", serde_json::to_string(&report)?));
    } else {
        print(&report, folder);
    }
    report.non_finite.outcome()?;
    if written.video_failed { Err(NoVideo.into()) } else { Ok(()) }
}

/// Costs and contents of the drawn pictures.
#[derive(Default)]
struct PictureCosts {
    /// Pictures that were drawn while the next frame was simulated, and the last one.
    beside: Collector,
    alone: Collector,
    strands: usize,
    segments: usize,
    non_finite: NonFinite,
}

fn play(
    player: &mut Player,
    film: &mut Film,
    drawn: &mut PictureCosts,
    stoppable: &Stoppable,
    quiet: bool,
) -> anyhow::Result<()> {
    let mut progress = Progress::new(u64::from(player.frames()), "frames", quiet);
    while let Some(event) = player.next() {
        match event? {
            Event::Note(note) => progress.note(&note),
            Event::Stepped(report) => {
                let note = drawn.non_finite.add(&report, player.frames_done());
                note.into_iter().for_each(|note| progress.note(&note));
            }
            Event::Drawn { frame, picture, report } => {
                film.add(&picture)?;
                let times = if frame + 1 < player.frames() { &mut drawn.beside } else { &mut drawn.alone };
                times.add(&report.seconds);
                (drawn.strands, drawn.segments) = (report.strands, report.segments);
            }
        }
        let (done, frames) = (u64::from(player.frames_done()), u64::from(player.frames()));
        progress.reached(done);
        if done < frames {
            stoppable.check(done, frames, "frames")?;
        }
    }
    Ok(())
}

/// Closes a film that failed, and reports its files.
fn stopped_early(film: Film, folder: &Path, error: anyhow::Error) -> anyhow::Error {
    let frames = film.len();
    let notes = if error.is::<Stopped>() {
        film.stop_early().map_or_else(|error| vec![error.to_string()], |left| left.notes)
    } else {
        film.give_up()
    };
    notes.iter().for_each(|note| output::note(note));
    if frames > 0 {
        output::note(&format!(
            "the {} whole: {}",
            counted(frames, "frame already written is", "frames already written are"),
            folder.display()
        ));
    }
    error
}

/// Pictures are there, but no video.
#[derive(Debug, thiserror::Error)]
#[error("ffmpeg made no video; frames and contact sheet are whole")]
pub struct NoVideo;

fn print(report: &RenderReport, folder: &Path) {
    print_line!(
        "{} of {}, {}, drawn on {}, simulated on {}",
        counted(report.frames, "picture", "pictures"),
        counted(report.follow_strands, "strand", "strands"),
        counted(report.segments, "segment", "segments"),
        report.render_backend,
        report.backend
    );
    let alone = &report.ms_of_frame_alone;
    match &report.ms_per_frame_beside_simulation {
        Some(beside) => print_line!(
            "a picture takes {:.0} ms while the next frame is simulated (95 of 100 at most {:.0} ms), {:.0} ms alone (the last one)",
            beside.median,
            beside.p95,
            alone.median
        ),
        None => print_line!("the picture takes {:.0} ms", alone.median),
    }
    for (name, time) in alone.stages.iter() {
        let beside = report.ms_per_frame_beside_simulation.as_ref();
        let beside =
            beside.map_or(String::new(), |times| format!("{:>10.1} ms beside", times.stages.sum(&[name])));
        print_line!("  {name:<15}{time:>8.1} ms alone{beside}");
    }
    let last = report.files.last().map_or(folder, PathBuf::as_path);
    let files = counted(report.files.len(), "file", "files");
    print_line!("wrote {files} to {}: look at {}", folder.display(), last.display());
}
