//! Grooms of artists: time to the first picture, cost of moving strands that are bound to
//! guides, and how fast hair that moved is written.

use std::f32::consts::PI;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::Context;
use glam::Vec3;
use serde::Serialize;
use strandline::{Backend, Event, Groom, OutSettings, Player, Scene};

use super::gpu::Device;
use super::machine::peak_memory_mb_of;
use crate::arguments::BenchOptions;
use crate::output::print_line;
use crate::statistics::median;

/// Strands of a fur, on an animal of two metres; in a short run.
const FUR: [usize; 2] = [48_000, 2000];
/// Strands that are drawn and simulated; in a short run.
const BOUND: [[u32; 2]; 2] = [[100_000, 2000], [2000, 100]];
/// Frames of which the median is taken; in a short run.
const FRAMES: [u32; 2] = [12, 3];
/// Frames that are written; in a short run.
const WRITTEN: [u32; 2] = [240, 12];
/// Bounds: seconds and MB to the first picture and its segments, ms per frame of bound strands, MB per
/// second.
const MOST: (f64, f64, usize, f64, f64) = (5.0, 500.0, 2_500_000, 60.0, 100.0);

#[derive(Debug, Serialize)]
pub struct Results {
    first_pictures: Vec<First>,
    bound: Vec<Bound>,
    written: Vec<Written>,
}

/// A program's run from a groom and a body to one picture, without kept files of earlier runs.
#[derive(Debug, Serialize)]
struct First {
    groom: String,
    seconds: f64,
    /// `None` if the system does not report it.
    peak_memory_mb: Option<f64>,
    segments: usize,
}

/// Cost of placing bound strands in a frame.
#[derive(Debug, Serialize)]
struct Bound {
    on: String,
    strands: u32,
    guides: usize,
    ms: f64,
}

#[derive(Debug, Serialize)]
struct Written {
    ending: &'static str,
    frames: usize,
    points: usize,
    megabytes: f64,
    megabytes_per_second: f64,
}

pub fn run(device: Option<&Device>, options: &BenchOptions) -> anyhow::Result<Results> {
    let quick = usize::from(options.quick);
    let folder = tempfile::tempdir().context("no room for temporary files")?;
    let (seconds, megabytes, segments, ms, rate) = MOST;
    print_line!("\nfrom two files to a picture{:>20}{:>12}{:>14}", "seconds", "MB", "segments");
    let mut first_pictures = Vec::new();
    let [fur, animal] = furry(FUR[quick], folder.path())?;
    let own = options.groom.iter().map(|groom| (groom.as_path(), options.body.as_deref(), &[][..]));
    let made = (fur.as_path(), Some(animal.as_path()), &UPRIGHT[..]);
    for (groom, body, placed) in own.chain([made]) {
        let first = first(groom, body, placed, folder.path())?;
        let memory = first.peak_memory_mb.map_or("unknown".to_owned(), |mb| format!("{mb:.0}"));
        print_line!("{:<27}{:>20.2}{memory:>12}{:>14}", first.groom, first.seconds, first.segments);
        first_pictures.push(first);
    }
    print_line!("{:<27}{seconds:>20.2}{megabytes:>12.0}{segments:>14}", "at most");
    print_line!("\nbound strands of 16 points{:>21}{:>12}{:>14}", "guides", "strands", "ms a frame");
    let gpu = device.map(|device| Backend::Gpu(Some(device.gpu.adapter().index)));
    let mut bound = Vec::new();
    for pictures in std::iter::once(Backend::Cpu).chain(gpu) {
        let row = place(pictures, BOUND[quick], FRAMES[quick])?;
        print_line!("{:<37.37}{:>10}{:>12}{:>14.1}", row.on, row.guides, row.strands, row.ms);
        bound.push(row);
    }
    print_line!("{:<59}{ms:>14.1}", "at most, on the CPU");
    print_line!("\nmoving hair is written{:>25}{:>12}{:>14}", "frames", "MB", "MB a second");
    let mut written = Vec::new();
    for ending in ["npz", "usda"] {
        let row = write(ending, WRITTEN[quick], folder.path())?;
        print_line!(
            ".{ending:<36}{:>10}{:>12.1}{:>14.0}",
            row.frames,
            row.megabytes,
            row.megabytes_per_second
        );
        written.push(row);
    }
    print_line!("{:<59}{rate:>14.0}", "at least");
    Ok(Results { first_pictures, bound, written })
}

/// The animal is the same upside down, so that its fur has to be told.
const UPRIGHT: [&str; 2] = ["--up", "y"];

/// A fur of strands of 3 cm, and the animal under it: an ellipsoid of two metres.
fn furry(count: usize, folder: &Path) -> anyhow::Result<[PathBuf; 2]> {
    let half = Vec3::new(0.3, 0.35, 1.0);
    let mut fur = Groom::empty(6e-5);
    for strand in 0..count {
        // Points of a sphere, evenly [Vogel1979].
        let height = 1.0 - 2.0 * (strand as f32 + 0.5) / count as f32;
        let (sin, cos) = (strand as f32 * PI * (3.0 - 5.0_f32.sqrt())).sin_cos();
        let radius = (1.0 - height * height).sqrt();
        let on_sphere = Vec3::new(radius * cos, radius * sin, height);
        let normal = (on_sphere / half).normalize();
        // Towards the tail.
        let lean = (Vec3::Z - normal * normal.z) * 0.8;
        fur.push((0..8).map(|point| {
            let along = 0.03 * point as f32 / 7.0;
            on_sphere * half + (normal + lean * (along / 0.03)).normalize() * along
        }));
    }
    let paths = ["fur.hair", "animal.obj"].map(|name| folder.join(name));
    fur.save(&paths[0])?;
    std::fs::write(&paths[1], ellipsoid(half))?;
    Ok(paths)
}

/// The text of an .obj file.
fn ellipsoid(half: Vec3) -> String {
    let (around, along) = (96, 64);
    let mut text = String::new();
    for row in 0..=along {
        let (sin, cos) = (PI * row as f32 / along as f32).sin_cos();
        for column in 0..around {
            let (y, x) = (2.0 * PI * column as f32 / around as f32).sin_cos();
            let point = half * Vec3::new(sin * x, sin * y, cos);
            let _ = writeln!(text, "v {} {} {}", point.x, point.y, point.z);
        }
    }
    for row in 0..along {
        for column in 0..around {
            let corner = |row: usize, column: usize| 1 + row * around + column % around;
            let [a, b] = [column, column + 1].map(|column| corner(row, column));
            let [c, d] = [column + 1, column].map(|column| corner(row + 1, column));
            let _ = writeln!(text, "f {a} {d} {c}\nf {a} {c} {b}");
        }
    }
    text
}

/// Runs this program as an artist does, without kept files of earlier runs.
fn first(groom: &Path, body: Option<&Path>, placed: &[&str], folder: &Path) -> anyhow::Result<First> {
    let mut command = Command::new(std::env::current_exe()?);
    command
        .args(["render", "--frames", "1", "--json", "--backend", "cpu", "--out"])
        .arg(folder.join("first"));
    command.arg("--groom").arg(groom).args(placed);
    if let Some(body) = body {
        command.arg("--body").arg(body);
    }
    let begin = Instant::now();
    command.env("STRANDLINE_CACHE", "off").stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null());
    let mut child = command.spawn()?;
    let mut peak_memory_mb = None;
    while child.try_wait()?.is_none() {
        peak_memory_mb = peak_memory_mb_of(&child.id().to_string()).or(peak_memory_mb);
        std::thread::sleep(Duration::from_millis(5));
    }
    let seconds = begin.elapsed().as_secs_f64();
    let output = child.wait_with_output()?;
    anyhow::ensure!(output.status.success(), "`strandline render` failed with {}", groom.display());
    let report: serde_json::Value = serde_json::from_slice(&output.stdout)?;
    let segments = report["segments"].as_u64().unwrap_or_default() as usize;
    let name = groom.file_name().unwrap_or_default().to_string_lossy();
    Ok(First { groom: name.chars().take(26).collect(), seconds, peak_memory_mb, segments })
}

/// Plays grown hair most of which is bound, drawn small: placing does not ask how large a picture is.
fn place(pictures: Backend, [strands, guides]: [u32; 2], frames: u32) -> anyhow::Result<Bound> {
    let mut scene = Scene::demo();
    (scene.style.strand_count, scene.groom.bound, scene.groom.points_per_strand) =
        (guides as usize, Some(strands), 16);
    (scene.film.frames, scene.film.settle) = (frames + 1, 0.0);
    (scene.look.follow_strands, scene.picture.width, scene.picture.height) = (1, 64, 64);
    scene.look.dress(strandline::look::Preset::Thesis);
    // Curves of more points exceed a buffer of WebGPU's default limits.
    scene.level_of_detail.segments_per_span = 1;
    (scene.devices.simulation, scene.devices.pictures) = (Backend::Cpu, pictures);
    let mut player = Player::new(&scene, scene.devices, true)?;
    // Both at once would share the processor.
    player.set_overlap(false);
    let mut times = Vec::new();
    for event in player.by_ref() {
        if let Event::Drawn { report, .. } = event? {
            let own = report.seconds.iter().filter(|(stage, _)| *stage == "bind").map(|(_, seconds)| seconds);
            times.push(1e3 * own.sum::<f64>());
        }
    }
    // The first frame compiles and takes memory.
    let ms = median(&times[1..]);
    Ok(Bound { on: player.drawn_on(), strands, guides: player.guides().strand_count(), ms })
}

/// Writes 2,000 strands of 16 points; the time is that of writing alone.
fn write(ending: &'static str, frames: u32, folder: &Path) -> anyhow::Result<Written> {
    let mut scene = Scene::demo();
    (scene.style.strand_count, scene.groom.points_per_strand) = (2000, 16);
    (scene.film.frames, scene.film.settle) = (frames, 0.0);
    scene.film.frames_per_second = 120.0;
    scene.devices = Backend::Cpu.into();
    let mut player = Player::new(&scene, scene.devices, false)?;
    player.set_out(&OutSettings::new(folder.join(format!("moved.{ending}"))))?;
    player.by_ref().try_for_each(|event| event.map(drop))?;
    let written = player.close_out()?.context("a file was asked for")?;
    let megabytes = 1e-6 * written.bytes as f64;
    let megabytes_per_second = megabytes / written.time.as_secs_f64();
    Ok(Written { ending, frames: written.frames, points: written.points, megabytes, megabytes_per_second })
}

#[cfg(test)]
mod tests {
    use std::ffi::OsString;

    use super::*;

    #[test]
    fn the_fur_finds_its_place_on_the_animal() {
        let folder = tempfile::tempdir().unwrap();
        let [fur, animal] = furry(FUR[1].min(1000), folder.path()).unwrap();
        let [fur, animal] = [&fur, &animal].map(|path| path.to_str().unwrap());
        let plain =
            ["strandline", "sim", "--frames", "1", "--backend", "cpu", "--groom", fur, "--body", animal];
        let run = |more: &[&str]| crate::run_program(plain.iter().chain(more).map(OsString::from));
        assert_eq!([run(&UPRIGHT), run(&[])], [0, 1]);
    }
}
