//! A head shaken at 20 g and 5 Hz: a minute of it, or `STRANDLINE_SHAKEN_HOURS=24 cargo test --release
//! -p strandline --test shaken -- --nocapture`.

use std::f64::consts::TAU;

use strandline::{Backend, Hair, Pose, Prepared, Scene};

/// Shakes in a second, and how far to each side \[m\]: 20 times 9.81 m/s^2 at the turning points.
const RATE: f64 = 5.0;
const REACH: f64 = 20.0 * 9.81 / (TAU * RATE * TAU * RATE);
/// Frames in a second.
const FRAMES: f64 = 60.0;
/// Seconds when the environment says nothing else.
const SECONDS: f64 = 60.0;

fn scene() -> Scene {
    let mut scene = Scene::demo();
    scene.style.strand_count = 8;
    scene.body.spacing = 0.01;
    scene.simulation.volume.cells = [12; 3];
    (scene.devices.simulation, scene.devices.pictures) = (Backend::Cpu, Backend::Cpu);
    scene
}

/// Memory that is resident now \[KiB\]; none where the system does not tell.
fn memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    line.split_whitespace().next()?.parse().ok()
}

#[test]
fn shaken_hair_stays_finite_in_length_and_in_memory() {
    let hours = std::env::var("STRANDLINE_SHAKEN_HOURS").ok();
    let seconds = hours.as_ref().map_or(SECONDS, |hours| 3600.0 * hours.parse::<f64>().unwrap());
    let scene = scene();
    let mut hair = Hair::from_scene(&scene, Prepared::new(&scene).unwrap(), scene.devices).unwrap();
    let at = |time: f64| Pose {
        translation: glam::Vec3::X * (REACH * (TAU * RATE * time).sin()) as f32,
        ..Pose::IDENTITY
    };
    let (frames, mut steps, mut worst, mut early) = ((seconds * FRAMES) as u64, 0, 0.0_f32, None);
    for frame in 0..frames {
        let pose = |share: f32| at((frame as f64 + f64::from(share)) / FRAMES);
        for report in hair.step_along(1.0 / FRAMES, pose).unwrap() {
            assert_eq!(report.non_finite, 0, "after {steps} steps");
            worst = worst.max(report.stretch_max);
            steps += 1;
        }
        if frame == frames / 10 {
            early = memory();
        }
    }
    // The length pass ends every step: what is left is rounding, some 1e-6 in ten hours' worth of steps.
    assert!(worst < 1e-4, "{worst}");
    assert!(steps >= frames, "{steps} steps in {frames} frames");
    if let (Some(early), Some(late)) = (early, memory()) {
        // A state has one size: what may be added is the allocator's, a few pages a thread.
        assert!(late < early + 4096, "{early} KiB became {late} KiB");
        if hours.is_some() {
            #[allow(clippy::print_stderr)] // figures that were asked for
            {
                eprintln!("{steps} steps, stretch {worst:e} at most, {early} KiB then {late} KiB");
            }
        }
    }
}
