//! The thesis's tables 1 to 4 beside ours [Chen2011 §4.2.3, §6].

use strandline::{Backend, Devices, Event, Player, Scene, settings::Preconditioner};

use super::gpu::Device;
use super::measure::measure;
use super::thesis_results::{GpuGrid, Grid, Pictures, Results, Whole};
use super::{tables, workers};
use crate::progress::Progress;
use crate::statistics::{Collector, Times, median};

/// Cells along each side of the thesis's three grids.
const GRIDS: [u32; 3] = [16, 32, 64];
/// Frames per second of the thesis's whole system (table 2): simulated on the CPU and on a GPU, drawn on
/// another GPU in both.
const THESIS_FPS: [[f64; 2]; 3] = [[21.8, 96.2], [13.3, 86.5], [3.19, 37.7]];
/// Frames simulated for each grid; of a run with pictures that the CPU draws, that a software adapter draws,
/// that a GPU draws. In a short run.
const FRAMES: [u32; 2] = [120, 8];
const WITH_PICTURES: [[u32; 3]; 2] = [[15, 5, 120], [2, 2, 4]];

pub fn run(device: Option<&Device>, quick: bool) -> anyhow::Result<Results> {
    let pictures = WITH_PICTURES[usize::from(quick)];
    let mut scene = Scene::thesis();
    scene.film.frames = pictures[0] + 1;
    if quick {
        // A second of steps that are not shown would take longer than all that is.
        scene.film.settle = 0.0;
    }
    let (ms_beside_simulation, _) = draw(&scene, true)?;
    let (ms_alone, segments) = draw(&scene, false)?;
    let mut grids = Vec::new();
    for (cells, thesis_frames_per_second) in GRIDS.into_iter().zip(THESIS_FPS) {
        scene.film.frames = FRAMES[usize::from(quick)];
        scene.simulation.volume.cells = [cells; 3];
        scene.simulation.volume.preconditioner = Preconditioner::Mic0;
        let (mic0, ..) = measure(&scene, false, "frames")?;
        let whole_on_cpu = whole(&scene, Backend::Cpu.into(), pictures[0])?;
        scene.simulation.volume.preconditioner = Preconditioner::Jacobi;
        let (jacobi, ..) = measure(&scene, false, "frames")?;
        let gpu = device.map(|device| on_gpu(device, &mut scene, pictures)).transpose()?;
        grids.push(Grid { cells, mic0, jacobi, whole_on_cpu, gpu, thesis_frames_per_second });
    }
    let shares_percent = tables::shares(&grids[1].mic0);
    let gpu_shares_percent =
        grids[1].gpu.as_ref().map_or(Vec::new(), |gpu| tables::shares(&gpu.chebyshev.steps));
    let pictures_on_cpu = Pictures { ms_beside_simulation, ms_alone };
    let lengths_alone = device.map(|device| device.forms(quick)).transpose()?.unwrap_or_default();
    let results =
        Results { grids, pictures_on_cpu, segments, shares_percent, gpu_shares_percent, lengths_alone };
    tables::print(&results);
    Ok(results)
}

/// Draws the frames of a scene but the first, which settles and makes room: times and segments of a picture.
fn draw(scene: &Scene, overlap: bool) -> anyhow::Result<(Times, usize)> {
    let mut player = Player::new(scene, Backend::Cpu, true)?;
    player.set_overlap(overlap);
    let (mut pictures, mut segments) = (Collector::default(), 0);
    // No step runs beside the last picture.
    let drawn = 1..player.frames() - u32::from(overlap && player.frames() > 2);
    let mut progress = Progress::new(u64::from(player.frames()), "pictures", false);
    for event in player.by_ref() {
        if let Event::Drawn { frame, report, .. } = event? {
            if drawn.contains(&frame) {
                pictures.add(&report.seconds);
            }
            segments = report.segments;
            progress.reached(u64::from(frame) + 1);
        }
    }
    Ok((pictures.times(), segments))
}

fn whole(scene: &Scene, devices: Devices, frames: u32) -> anyhow::Result<Whole> {
    let run = workers::play(scene, devices, frames, true)?;
    let ms_per_frame = median(&run.frame);
    let frames_per_second = 1e3 / ms_per_frame;
    Ok(Whole {
        simulated_on: run.simulated_on,
        drawn_on: run.drawn_on,
        frames,
        ms_per_frame,
        frames_per_second,
    })
}

/// As the CPU left the scene: with Jacobi.
fn on_gpu(device: &Device, scene: &mut Scene, pictures: [u32; 3]) -> anyhow::Result<GpuGrid> {
    let jacobi = device.measure(scene, "frames")?;
    scene.simulation.volume.preconditioner = Preconditioner::Chebyshev;
    let chebyshev = device.measure(scene, "frames")?;
    let frames = pictures[if device.adapter.software { 1 } else { 2 }];
    let gpu = device.backend();
    let whole_on_gpu = whole(scene, gpu.into(), frames)?;
    scene.simulation.volume.preconditioner = Preconditioner::Mic0;
    let devices = Devices { simulation: Backend::Cpu, pictures: gpu };
    let whole_simulated_on_cpu = whole(scene, devices, frames)?;
    Ok(GpuGrid { chebyshev, jacobi, whole_simulated_on_cpu, whole: whole_on_gpu })
}
