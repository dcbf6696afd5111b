//! `strandline render` and the demo: a scene becomes pictures.

use std::path::{Path, PathBuf};

use serde::Serialize;
use strandline::{Event, Film, Player, Scene};

use crate::arguments::RenderOptions;
use crate::non_finite::NonFinite;
use crate::progress::Progress;
use crate::statistics::{Collector, Times};

/// What `render --json` prints.
#[derive(Debug, Serialize)]
struct RenderReport {
    backend: String,
    render_backend: String,
    frames: usize,
    follow_strands: usize,
    segments: usize,
    /// Pictures that were drawn while the next frame was simulated, all but the last; none of a film of one.
    ms_per_frame_beside_simulation: Option<Times>,
    /// The last picture, beside which nothing is simulated.
    ms_of_frame_alone: Times,
    #[serde(flatten)]
    non_finite: NonFinite,
    files: Vec<PathBuf>,
}

/// The demo, into out/demo.
pub fn demo() -> anyhow::Result<()> {
    let scene = Scene::demo();
    println!(
        "strandline demo: a head of {} hair shakes for {:.0} s; `strandline --help` shows what else there is",
        scene.style.style.name(),
        f64::from(scene.film.frames) / f64::from(scene.film.frames_per_second)
    );
    film(&scene, Path::new("out/demo"), false)
}

/// A scene as the command line names it.
pub fn render(options: &RenderOptions) -> anyhow::Result<()> {
    let mut scene = options.inputs.scene()?;
    if let Some((width, height)) = options.size {
        (scene.picture.width, scene.picture.height) = (width, height);
    }
    let folder = options.out.clone().unwrap_or_else(|| Path::new("out").join(options.inputs.name()));
    film(&scene, &folder, options.inputs.json)
}

fn film(scene: &Scene, folder: &Path, json: bool) -> anyhow::Result<()> {
    let mut player = Player::new(scene, scene.devices, true)?;
    for note in player.notes() {
        eprintln!("note: {note}");
    }
    let mut film = Film::new(folder, player.frames(), scene.film.frames_per_second)?;
    let (mut beside, mut alone) = (Collector::default(), Collector::default());
    let (mut strands, mut segments, mut non_finite) = (0, 0, NonFinite::default());
    let mut progress = Progress::new(u64::from(player.frames()), "frames", json);
    while let Some(event) = player.next() {
        match event? {
            Event::Note(note) => progress.note(&note),
            Event::Stepped(report) => {
                let note = non_finite.add(&report, player.frames_done());
                note.into_iter().for_each(|note| progress.note(&note));
            }
            Event::Drawn { frame, picture, report } => {
                film.add(&picture)?;
                let times = if frame + 1 < player.frames() { &mut beside } else { &mut alone };
                times.add(&report.seconds);
                (strands, segments) = (report.strands, report.segments);
            }
        }
        progress.reached(u64::from(player.frames_done()));
    }
    drop(progress);
    let written = film.finish()?;
    for note in &written.notes {
        eprintln!("note: {note}");
    }
    let report = RenderReport {
        backend: player.simulated_on(),
        render_backend: player.drawn_on(),
        frames: beside.len() + alone.len(),
        follow_strands: strands,
        segments,
        ms_per_frame_beside_simulation: (beside.len() > 0).then(|| beside.times()),
        ms_of_frame_alone: alone.times(),
        non_finite,
        files: written.files,
    };
    if json {
        println!("{}", serde_json::to_string(&report)?);
    } else {
        print(&report, folder);
    }
    Ok(report.non_finite.outcome()?)
}

fn print(report: &RenderReport, folder: &Path) {
    println!(
        "{} pictures of {} strands, {} segments, drawn on {}, simulated on {}",
        report.frames, report.follow_strands, report.segments, report.render_backend, report.backend
    );
    let alone = &report.ms_of_frame_alone;
    match &report.ms_per_frame_beside_simulation {
        Some(beside) => println!(
            "a picture takes {:.0} ms while the next frame is simulated (95 of 100 at most {:.0} ms), {:.0} ms alone (the last one)",
            beside.median, beside.p95, alone.median
        ),
        None => println!("the picture takes {:.0} ms", alone.median),
    }
    for (name, time) in alone.stages.iter() {
        let beside = report.ms_per_frame_beside_simulation.as_ref();
        let beside =
            beside.map_or(String::new(), |times| format!("{:>10.1} ms beside", times.stages.sum(&[name])));
        println!("  {name:<15}{time:>8.1} ms alone{beside}");
    }
    let last = report.files.last().map_or(folder, PathBuf::as_path);
    println!("wrote {} files to {}: look at {}", report.files.len(), folder.display(), last.display());
}
