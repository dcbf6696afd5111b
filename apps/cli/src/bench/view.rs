//! The thesis's table 5 beside ours: frames per second by viewing distance and picture size, with the
//! simulation running beside [Chen2011 §6].

use std::time::Instant;

use serde::Serialize;
use strandline::{
    Backend, Camera, Hair, Pose, Prepared, Scene,
    gpu::Gpu,
    render::{LevelOfDetail, PictureSettings},
};

use super::gpu::Device;
use crate::progress::Progress;
use crate::statistics::{Collector, Times, median};

/// Viewing distances: from the camera to the middle of the hair \[m\].
const DISTANCES: [f32; 6] = [0.2, 0.4, 0.6, 1.0, 1.5, 3.0];
/// Sizes of the picture \[pixel\], and the thesis's frames per second where it is known to us.
const SIZES: [(u32, u32, Option<[f64; 6]>); 4] = [
    (800, 600, Some([25.0, 44.0, 63.0, 98.0, 136.1, 136.1])),
    (1024, 712, None),
    (1152, 802, None),
    (1280, 968, Some([15.9, 31.9, 50.9, 83.2, 136.1, 136.1])),
];
/// Frames of a row; on a software adapter; in a short run.
const FRAMES: [u32; 3] = [8, 2, 1];
/// What is promised of a current GPU at 1280x968: follow strands, most ms a picture, most MB on the device.
const PROMISED: [(u32, f64, f64); 2] = [(16, 4.0, 200.0), (43, 10.0, 200.0)];

#[derive(Debug, Serialize)]
pub struct Results {
    backends: Vec<OnBackend>,
    /// None when no GPU was measured.
    promised: Vec<Promised>,
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
    /// Step and picture, one after the other, by the host's clock.
    frames_per_second: f64,
    ms_per_picture: Times,
}

#[derive(Debug, Serialize)]
struct Promised {
    segments: usize,
    most_ms: f64,
    ms_per_picture: Times,
    /// Of all buffers and textures, those of the simulation among them.
    device_mb: f64,
}

pub fn run(device: Option<&Device>, quick: bool) -> anyhow::Result<Results> {
    let mut backends = vec![on_backend(None, quick)?];
    let mut promised = Vec::new();
    if let Some(device) = device {
        backends.push(on_backend(Some(&device.gpu), quick)?);
        for (follow_strands, most_ms, most_mb) in PROMISED {
            promised.push(promise(&device.gpu, follow_strands, most_ms, most_mb)?);
        }
    }
    Ok(Results { backends, promised })
}

/// The thesis's scene while it moves.
struct View {
    hair: Hair,
    scene: Scene,
    /// Pose of the head at a time \[s\].
    pose: Box<dyn Fn(f64) -> Pose>,
    time: f64,
}

impl View {
    fn new(gpu: Option<&Gpu>, follow_strands: u32) -> anyhow::Result<Self> {
        let mut scene = Scene::thesis();
        scene.look.follow_strands = follow_strands;
        let prepared = Prepared::new(&scene)?;
        let (motion, pivot) = (prepared.motion.clone(), prepared.pivot);
        let pose = Box::new(move |time| motion.pose(time, pivot));
        let backend = gpu.map_or(Backend::Cpu, |gpu| Backend::Gpu(Some(gpu.adapter().index)));
        let mut hair = Hair::from_scene(&scene, prepared, backend)?;
        hair.level_of_detail = LevelOfDetail::default();
        Ok(Self { hair, scene, pose, time: 0.0 })
    }

    /// Seconds of a step and a picture, and what the picture cost.
    fn frame(&mut self, camera: &Camera) -> anyhow::Result<(f64, strandline::render::FrameReport)> {
        let begin = Instant::now();
        self.time += 1.0 / 60.0;
        self.hair.step(1.0 / 60.0, &(self.pose)(self.time))?;
        let (_, report) = self.hair.picture_with_report(camera, &self.scene.look)?;
        Ok((begin.elapsed().as_secs_f64(), report))
    }

    /// The scene's camera, as far from the middle of the hair.
    fn camera(&self, distance: f32) -> Camera {
        let camera = Camera::three_quarter();
        let middle = 0.5 * (self.hair.bounds().min + self.hair.bounds().max);
        let way = (camera.position - camera.target).normalize();
        Camera { position: middle + way * distance, target: middle, ..camera }
    }
}

fn on_backend(gpu: Option<&Gpu>, quick: bool) -> anyhow::Result<OnBackend> {
    let mut view = View::new(gpu, 16)?;
    let software = gpu.is_some_and(|gpu| gpu.adapter().software);
    let frames = FRAMES[if quick { 2 } else { usize::from(software) }];
    let backend = view.hair.drawn_on();
    let mut rows = Vec::new();
    let mut progress = Progress::new((SIZES.len() * DISTANCES.len()) as u64, "views", false);
    for (width, height, _) in SIZES {
        view.hair.set_picture(&PictureSettings::sized(width, height))?;
        for distance_m in DISTANCES {
            let camera = view.camera(distance_m);
            // The first makes room and compiles.
            view.frame(&camera)?;
            let (mut seconds, mut pictures, mut segments) = (Vec::new(), Collector::default(), 0);
            for _ in 0..frames {
                let (taken, report) = view.frame(&camera)?;
                seconds.push(taken);
                pictures.add(&report.seconds);
                segments = report.segments;
            }
            let frames_per_second = 1.0 / median(&seconds);
            let ms_per_picture = pictures.times();
            rows.push(Row { width, height, distance_m, segments, frames_per_second, ms_per_picture });
            progress.reached(rows.len() as u64);
        }
    }
    drop(progress);
    let measured = OnBackend { backend, rows };
    print(&measured);
    Ok(measured)
}

fn print(measured: &OnBackend) {
    println!("\nTable 5: frames per second by distance [m], step and picture, on {}", measured.backend);
    print!("{:<24}", "");
    DISTANCES.iter().for_each(|distance| print!("{distance:>9.1}"));
    println!();
    for ((width, height, thesis), rows) in SIZES.into_iter().zip(measured.rows.chunks(DISTANCES.len())) {
        row(&format!("{width}x{height}, ours"), rows.iter().map(|row| row.frames_per_second));
        if let Some(thesis) = thesis {
            row(&format!("{width}x{height}, thesis"), thesis.into_iter());
        }
    }
    let first = measured.rows.iter().take(DISTANCES.len());
    print!("{:<24}", "segments drawn");
    first.for_each(|row| print!("{:>9}", row.segments));
    println!();
}

fn row(name: &str, values: impl Iterator<Item = f64>) {
    print!("{name:<24}");
    values.for_each(|value| print!("{value:>9.1}"));
    println!();
}

/// A picture of 1280x968 with two shadow lights, by the device's own clock.
fn promise(gpu: &Gpu, follow_strands: u32, most_ms: f64, most_mb: f64) -> anyhow::Result<Promised> {
    let mut view = View::new(Some(gpu), follow_strands)?;
    view.hair.level_of_detail = LevelOfDetail::full();
    view.hair.set_picture(&PictureSettings::sized(1280, 968))?;
    let camera = view.camera(1.0);
    view.frame(&camera)?;
    let (mut pictures, mut segments) = (Collector::default(), 0);
    for _ in 0..if gpu.adapter().software { 2 } else { 20 } {
        let (_, report) = view.frame(&camera)?;
        pictures.add(&report.seconds);
        segments = report.segments;
    }
    let device_mb = view.hair.gpu().map_or(0.0, |gpu| gpu.memory_used() as f64 * 1e-6);
    let ms_per_picture = pictures.times();
    println!("\n{segments} segments, two shadow lights, 1280x968, 2x2 samples, on {}", gpu.adapter());
    println!("a picture {:>10.3} ms, at most {most_ms} ms promised of a current GPU", ms_per_picture.median);
    for (name, time) in ms_per_picture.stages.iter() {
        println!("  {name:<15}{time:>10.3} ms");
    }
    println!("on the device {device_mb:>6.0} MB, at most {most_mb} MB");
    Ok(Promised { segments, most_ms, ms_per_picture, device_mb })
}
