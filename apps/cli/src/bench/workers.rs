//! Two workers on one or two devices: cost of a frame if the next one is simulated while it is drawn,
//! against the sum and the greater of both [Chen2011 §5].

use std::time::Instant;

use serde::Serialize;
use strandline::{
    Backend, Devices, Event, Player, Scene,
    device::{Crossed, Gpu},
};

use super::gpu::Device;
use crate::output::print_line;
use crate::progress::Progress;
use crate::statistics::median;

/// Bytes of the times of a picture: two marks of 8 bytes for each of 32 stages.
const MARKS: u64 = 512;
/// Frames of a run; on a software adapter; in a short run.
const FRAMES: [u32; 3] = [60, 8, 3];

#[derive(Debug, Serialize)]
pub struct Results {
    pairs: Vec<Pair>,
}

/// Medians of one pair of devices \[ms\].
#[derive(Debug, Serialize)]
struct Pair {
    simulation: String,
    pictures: String,
    ms_to_simulate: f64,
    ms_to_draw: f64,
    ms_a_frame: f64,
    /// Over the sum of both, and over the greater of both.
    of_sum: f64,
    of_greater: f64,
    /// Counted transfer from the host to the GPUs per frame \[byte\]: points, if only pictures are drawn
    /// there.
    bytes_to_gpus: u64,
    /// And back: the picture; where it is simulated there reports, and every `simulation.checkpoint_every` steps the
    /// state.
    bytes_from_gpus: u64,
    /// Those without the picture.
    bytes_home: u64,
    /// Times in a frame that the host waits for a GPU, and those without the one for the picture.
    waits: f64,
    waits_beside_pictures: f64,
}

pub fn run(device: Option<&Device>, quick: bool) -> anyhow::Result<Results> {
    let mut chosen = vec![(Backend::Cpu, Backend::Cpu)];
    let mut frames = FRAMES[0];
    if let Some(device) = device {
        let gpu = Backend::Gpu(Some(device.gpu.adapter().index));
        chosen.extend([(Backend::Cpu, gpu), (gpu, Backend::Cpu), (gpu, gpu)]);
        let others = other_gpus(device);
        if others.is_empty() {
            print_line!(
                "no second GPU of this kind is here: simulating on one and drawing on another is left out"
            );
        }
        chosen.extend(others.into_iter().flat_map(|other| [(other, gpu), (gpu, other)]));
        frames = if device.adapter.software { FRAMES[1] } else { frames };
    }
    let frames = if quick { FRAMES[2] } else { frames };
    print_line!("\nTwo workers: the thesis's scene, medians of {frames} frames [ms]");
    print_line!(
        "{:<12}{:<12}{:>10}{:>10}{:>10}{:>10}{:>12}{:>14}{:>14}{:>12}{:>8}",
        "simulated",
        "drawn",
        "simulate",
        "draw",
        "frame",
        "of sum",
        "of greater",
        "bytes to GPU",
        "from GPU",
        "but picture",
        "waits"
    );
    let mut pairs = Vec::new();
    for (simulation, pictures) in chosen {
        let pair = measure(Devices { simulation, pictures }, frames)?;
        print_line!(
            "{:<12}{:<12}{:>10.2}{:>10.2}{:>10.2}{:>10.2}{:>12.2}{:>14}{:>14}{:>12}{:>8.1}",
            simulation.to_string(),
            pictures.to_string(),
            pair.ms_to_simulate,
            pair.ms_to_draw,
            pair.ms_a_frame,
            pair.of_sum,
            pair.of_greater,
            pair.bytes_to_gpus,
            pair.bytes_from_gpus,
            pair.bytes_home,
            pair.waits_beside_pictures
        );
        pairs.push(pair);
    }
    Ok(Results { pairs })
}

/// The other GPUs of a machine, hardware beside hardware and software beside software.
fn other_gpus(device: &Device) -> Vec<Backend> {
    let measured = device.gpu.adapter();
    let others = Gpu::list().into_iter();
    let others = others.filter(|other| other.index != measured.index && other.software == measured.software);
    others.map(|other| Backend::Gpu(Some(other.index))).collect()
}

fn measure(devices: Devices, frames: u32) -> anyhow::Result<Pair> {
    let alone = play(&Scene::thesis(), devices, frames, false)?;
    let both = play(&Scene::thesis(), devices, frames, true)?;
    let (ms_to_simulate, ms_to_draw) = (median(&alone.simulate), median(&alone.draw));
    let ms_a_frame = median(&both.frame);
    Ok(Pair {
        simulation: both.simulated_on,
        pictures: both.drawn_on,
        ms_to_simulate,
        ms_to_draw,
        ms_a_frame,
        of_sum: ms_a_frame / (ms_to_simulate + ms_to_draw),
        of_greater: ms_a_frame / ms_to_simulate.max(ms_to_draw),
        bytes_to_gpus: alone.crossed.to_device,
        bytes_from_gpus: alone.crossed.from_device,
        bytes_home: alone.crossed.from_device.saturating_sub(alone.picture_bytes),
        waits: alone.waits,
        waits_beside_pictures: (alone.waits - f64::from(u8::from(alone.picture_bytes > 0))).max(0.0),
    })
}

/// Times of every frame \[ms\], by the host's clock.
#[derive(Default)]
pub struct Run {
    pub simulate: Vec<f64>,
    pub draw: Vec<f64>,
    pub frame: Vec<f64>,
    pub simulated_on: String,
    pub drawn_on: String,
    /// Bytes of a frame, those of its picture where a GPU draws it, and waits for GPUs.
    crossed: Crossed,
    picture_bytes: u64,
    waits: f64,
}

/// Bytes that crossed to and from all devices so far.
fn crossed(gpus: &[Gpu]) -> Crossed {
    let mut sum = Crossed::default();
    for crossed in gpus.iter().map(Gpu::crossed) {
        sum.to_device += crossed.to_device;
        sum.from_device += crossed.from_device;
    }
    sum
}

/// Plays a scene at 60 frames a second; with `overlap` a frame is simulated while the one before is drawn.
pub fn play(scene: &Scene, devices: Devices, frames: u32, overlap: bool) -> anyhow::Result<Run> {
    let mut scene = scene.clone();
    // The first frame compiles and settles; it is left out.
    scene.film.frames = frames + 1;
    scene.film.frames_per_second = 60.0;
    let mut player = Player::new(&scene, devices, true)?;
    player.set_overlap(overlap);
    let mut run = Run { simulated_on: player.simulated_on(), drawn_on: player.drawn_on(), ..Run::default() };
    let what = if overlap { "frames, both at once" } else { "frames, one after the other" };
    let mut progress = Progress::new(u64::from(frames) + 1, what, false);
    let mut gpus: Vec<Gpu> = player.gpu().into_iter().chain(player.picture_gpu()).collect();
    gpus.dedup_by(|one, other| one.is_same(other));
    let waits = |gpus: &[Gpu]| gpus.iter().map(Gpu::waits).sum::<u64>();
    let (mut before, mut waits_before) = (Crossed::default(), 0);
    // Rows of a picture begin at whole 256 bytes; the times of its stages come with it.
    let row = (4 * u64::from(scene.picture.width)).next_multiple_of(256);
    run.picture_bytes = player.picture_gpu().map_or(0, |_| row * u64::from(scene.picture.height) + MARKS);
    let (mut last, mut simulated) = (Instant::now(), None);
    for event in player {
        match event? {
            Event::Note(note) => progress.note(&note),
            Event::Stepped(_) => simulated = simulated.or(Some(Instant::now())),
            Event::Drawn { frame, .. } => {
                let (now, between) = (Instant::now(), simulated.take().unwrap_or(last));
                if frame == 0 {
                    (before, waits_before) = (crossed(&gpus), waits(&gpus));
                } else {
                    let ms = |from: Instant, to: Instant| 1e3 * (to - from).as_secs_f64();
                    run.simulate.push(ms(last, between));
                    run.draw.push(ms(between, now));
                    run.frame.push(ms(last, now));
                }
                last = now;
                progress.reached(u64::from(frame) + 1);
            }
        }
    }
    let (after, frames) = (crossed(&gpus), u64::from(frames));
    run.crossed = Crossed {
        to_device: (after.to_device - before.to_device) / frames,
        from_device: (after.from_device - before.from_device) / frames,
    };
    run.waits = (waits(&gpus) - waits_before) as f64 / frames as f64;
    Ok(run)
}
