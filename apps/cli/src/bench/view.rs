//! The thesis's table 5 beside ours: frames per second by viewing distance and picture size, with the
//! simulation running beside [Chen2011 table 5].

use std::time::Instant;

use glam::Vec3;
use serde::Serialize;
use strandline::{
    Backend, Camera, Event, PictureSettings, Player, Scene,
    device::Gpu,
    look::{FrameReport, LevelOfDetail},
};

use super::gpu::Device;
use crate::output::{print_line, print_part};
use crate::progress::Progress;
use crate::statistics::{Collector, Times, median};

/// Viewing distances: from the camera to the middle of the hair \[m\].
const DISTANCES: [f32; 6] = [0.2, 0.4, 0.6, 1.0, 1.5, 3.0];
/// Sizes of the picture \[pixel\], and the thesis's frames per second at each distance.
const SIZES: [(u32, u32, [f64; 6]); 4] = [
    (800, 600, [25.0, 44.0, 63.0, 98.0, 136.1, 136.1]),
    (1024, 712, [20.6, 40.2, 59.6, 93.2, 136.1, 136.1]),
    (1152, 802, [18.3, 36.9, 56.1, 88.7, 136.1, 136.1]),
    (1280, 968, [15.9, 31.9, 50.9, 83.2, 136.1, 136.1]),
];
/// Frames of a row; on a software adapter; in a short run.
const FRAMES: [u32; 3] = [8, 2, 1];
/// Aims for a current GPU at 1280x968: follow strands, most ms per picture, most MB on the device.
const PROMISED: [(u32, f64, f64); 2] = [(16, 4.0, 200.0), (43, 10.0, 200.0)];

#[derive(Debug, Serialize)]
pub struct Results {
    backends: Vec<OnBackend>,
    /// Empty if no GPU was measured.
    promised: Vec<Promised>,
    /// The demo in its own look, on each backend.
    demo: Vec<InDemo>,
}

#[derive(Debug, Serialize)]
struct InDemo {
    backend: String,
    segments: usize,
    /// Sum of the stages.
    ms_per_picture: Times,
}

#[derive(Debug, Serialize)]
struct OnBackend {
    backend: String,
    rows: Vec<Row>,
}

#[derive(Debug, Serialize)]
struct Row {
    width: u32,
    height: u32,
    distance_m: f32,
    segments: usize,
    /// Pictures, the next frame being simulated beside, by the host's clock.
    frames_per_second: f64,
    thesis_frames_per_second: f64,
    ms_per_picture: Times,
}

#[derive(Debug, Serialize)]
struct Promised {
    segments: usize,
    most_ms: f64,
    most_mb: f64,
    /// Sum of the stages by the device's clock.
    ms_per_picture: Times,
    /// Of all buffers and textures, those of the simulation among them.
    device_mb: f64,
}

pub fn run(device: Option<&Device>, quick: bool) -> anyhow::Result<Results> {
    let mut backends = vec![on_backend(None, quick)?];
    let mut promised = Vec::new();
    let mut demo = vec![in_demo(None, quick)?];
    if let Some(device) = device {
        demo.push(in_demo(Some(&device.gpu), quick)?);
        backends.push(on_backend(Some(&device.gpu), quick)?);
        for (follow_strands, most_ms, most_mb) in PROMISED {
            promised.push(promise(&device.gpu, follow_strands, most_ms, most_mb)?);
        }
    }
    Ok(Results { backends, promised, demo })
}

/// A scene while it moves: a frame is simulated while the one before is drawn.
struct View {
    player: Player,
    middle: Vec3,
}

impl View {
    fn of_thesis(gpu: Option<&Gpu>, follow_strands: u32, level: LevelOfDetail) -> anyhow::Result<Self> {
        let mut scene = Scene::thesis();
        scene.look.follow_strands = follow_strands;
        scene.level_of_detail = level;
        Self::new(gpu, scene)
    }

    fn new(gpu: Option<&Gpu>, mut scene: Scene) -> anyhow::Result<Self> {
        // The most that a film may have: it is over when enough is seen.
        scene.film.frames = 1_000_000;
        scene.film.frames_per_second = 60.0;
        let backend = gpu.map_or(Backend::Cpu, |gpu| Backend::Gpu(Some(gpu.adapter().index)));
        let player = Player::new(&scene, backend, true)?;
        let guides = player.guides();
        let points = (0..guides.strand_count())
            .flat_map(|strand| (0..guides.points_per_strand()).map(move |p| guides.position(strand, p)));
        let (low, high) =
            points.fold((Vec3::MAX, Vec3::MIN), |(low, high), point| (low.min(point), high.max(point)));
        Ok(Self { player, middle: 0.5 * (low + high) })
    }

    /// Seconds until the next picture, and its cost.
    fn frame(&mut self) -> anyhow::Result<(f64, FrameReport)> {
        let begin = Instant::now();
        loop {
            match self.player.next() {
                Some(Ok(Event::Drawn { report, .. })) => return Ok((begin.elapsed().as_secs_f64(), report)),
                Some(event) => drop(event?),
                None => anyhow::bail!("the film ended"),
            }
        }
    }

    /// Segments, and cost of pictures.
    fn measured(&mut self, pictures: usize) -> anyhow::Result<(usize, Times)> {
        let (mut costs, mut segments) = (Collector::default(), 0);
        for _ in 0..pictures {
            let (_, report) = self.frame()?;
            costs.add(&report.seconds);
            segments = report.segments;
        }
        Ok((segments, costs.times()))
    }

    /// Looks from between front and side, as far from the middle of the hair.
    fn look_from(&mut self, distance: f32) {
        let camera = Camera::three_quarter();
        let way = (camera.position - camera.target).normalize();
        let position = self.middle + way * distance;
        self.player.set_camera(Camera { position, target: self.middle, ..camera });
    }
}

fn on_backend(gpu: Option<&Gpu>, quick: bool) -> anyhow::Result<OnBackend> {
    let mut view = View::of_thesis(gpu, 16, LevelOfDetail::thesis())?;
    let software = gpu.is_some_and(|gpu| gpu.adapter().software);
    let frames = FRAMES[if quick { 2 } else { usize::from(software) }];
    let backend = view.player.drawn_on();
    let mut rows = Vec::new();
    let mut progress = Progress::new((SIZES.len() * DISTANCES.len()) as u64, "views", false);
    for (width, height, thesis) in SIZES {
        view.player.set_picture(&PictureSettings::sized(width, height))?;
        for (distance_m, thesis_frames_per_second) in DISTANCES.into_iter().zip(thesis) {
            view.look_from(distance_m);
            // The first makes room and compiles.
            view.frame()?;
            let (mut seconds, mut pictures, mut segments) = (Vec::new(), Collector::default(), 0);
            for _ in 0..frames {
                let (taken, report) = view.frame()?;
                seconds.push(taken);
                pictures.add(&report.seconds);
                segments = report.segments;
            }
            let frames_per_second = 1.0 / median(&seconds);
            let ms_per_picture = pictures.times();
            rows.push(Row {
                width,
                height,
                distance_m,
                segments,
                frames_per_second,
                thesis_frames_per_second,
                ms_per_picture,
            });
            progress.reached(rows.len() as u64);
        }
    }
    drop(progress);
    let measured = OnBackend { backend, rows };
    print(&measured);
    Ok(measured)
}

fn print(measured: &OnBackend) {
    print_line!("\nTable 5: frames per second by distance [m], on {}", measured.backend);
    print_part!("{:<24}", "");
    DISTANCES.iter().for_each(|distance| print_part!("{distance:>9.1}"));
    print_line!();
    for ((width, height, thesis), rows) in SIZES.into_iter().zip(measured.rows.chunks(DISTANCES.len())) {
        row(&format!("{width}x{height}, ours"), rows.iter().map(|row| row.frames_per_second));
        row(&format!("{width}x{height}, thesis"), thesis.into_iter());
    }
    let first = measured.rows.iter().take(DISTANCES.len());
    print_part!("{:<24}", "segments drawn");
    first.for_each(|row| print_part!("{:>9}", row.segments));
    print_line!();
    print_line!(
        "detail falls from 0.2 m on (LevelOfDetail::thesis), by segments and by follow strands; the thesis's by segments"
    );
}

fn row(name: &str, values: impl Iterator<Item = f64>) {
    print_part!("{name:<24}");
    values.for_each(|value| print_part!("{value:>9.1}"));
    print_line!();
}

/// A picture of 1280x968 with two shadow lights, by the device's own clock.
fn promise(gpu: &Gpu, follow_strands: u32, most_ms: f64, most_mb: f64) -> anyhow::Result<Promised> {
    let mut view = View::of_thesis(Some(gpu), follow_strands, LevelOfDetail::full())?;
    view.player.set_picture(&PictureSettings::sized(1280, 968))?;
    view.look_from(1.0);
    view.frame()?;
    let (segments, ms_per_picture) = view.measured(if gpu.adapter().software { 2 } else { 20 })?;
    let device_mb = view.player.gpu().map_or(0.0, |gpu| gpu.memory_used() as f64 * 1e-6);
    print_line!("\n{segments} segments, two shadow lights, 1280x968, 2x2 samples, on {}", gpu.adapter());
    print_line!(
        "a picture {:>10.3} ms, at most {most_ms} ms promised of a current GPU",
        ms_per_picture.median
    );
    print_stages(&ms_per_picture);
    print_line!("on the device {device_mb:>6.0} MB, at most {most_mb} MB");
    Ok(Promised { segments, most_ms, most_mb, ms_per_picture, device_mb })
}

/// A picture of the demo in its own look and size.
fn in_demo(gpu: Option<&Gpu>, quick: bool) -> anyhow::Result<InDemo> {
    let mut view = View::new(gpu, Scene::demo())?;
    view.frame()?;
    let few = quick || gpu.is_some_and(|gpu| gpu.adapter().software);
    let (segments, ms_per_picture) = view.measured(if few { 1 } else { 8 })?;
    let backend = gpu.map_or("cpu".to_owned(), |gpu| gpu.adapter().to_string());
    print_line!("\nthe demo in its own look, {segments} segments, on {backend}");
    print_line!("a picture {:>10.3} ms", ms_per_picture.median);
    print_stages(&ms_per_picture);
    Ok(InDemo { backend, segments, ms_per_picture })
}

fn print_stages(times: &Times) {
    for (name, time) in times.stages.iter() {
        print_line!("  {name:<15}{time:>10.3} ms");
    }
}
