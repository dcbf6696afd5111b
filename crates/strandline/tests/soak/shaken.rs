//! A head shaken at 20 g and 5 Hz: 20 s of it, a minute in the long form, or as many hours as `bench/soak.sh` asks for.
#![allow(clippy::disallowed_methods)] // compared values may be rounded

use std::f64::consts::TAU;

use strandline::{Backend, Hair, Pose, Scene, settings::StrandMethod};

/// Shakes in a second, and how far to each side \[m\]: 20 times 9.81 m/s^2 at the turning points.
const RATE: f64 = 5.0;
const REACH: f64 = 20.0 * 9.81 / (TAU * RATE * TAU * RATE);
/// Frames in a second.
const FRAMES: f64 = 60.0;

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

/// Shakes hair and looks at every step; with hours asked for it prints what it saw.
fn shake(method: StrandMethod, seconds: f64) {
    let _alone = super::alone();
    let hours = std::env::var("STRANDLINE_SHAKEN_HOURS").ok();
    let seconds = hours.as_ref().map_or(seconds, |hours| 3600.0 * hours.parse::<f64>().unwrap());
    let mut scene = scene();
    scene.simulation.strands.method = method;
    let mut hair = Hair::open(&scene).unwrap();
    let at = |time: f64| Pose {
        translation: glam::Vec3::X * (REACH * (TAU * RATE * time).sin()) as f32,
        ..Pose::IDENTITY
    };
    let frames = (seconds * FRAMES) as u64;
    let (mut steps, mut worst, mut early, mut non_finite) = (0, 0.0_f32, None, 0);
    for frame in 0..frames {
        let pose = |share: f32| at((frame as f64 + f64::from(share)) / FRAMES);
        for report in hair.step_along(1.0 / FRAMES, pose).unwrap() {
            non_finite += report.non_finite;
            worst = worst.max(report.stretch_max);
            steps += 1;
        }
        if frame == frames / 10 {
            early = memory();
        }
        if hours.is_some() && (frame + 1) % (frames / 24).max(1) == 0 {
            say(&format!(
                "{method:?}: {:.2} h, {steps} steps, {non_finite} points not finite, stretch {worst:.1e} at most, {} KiB",
                (frame + 1) as f64 / FRAMES / 3600.0,
                memory().unwrap_or(0)
            ));
        }
    }
    assert_eq!(non_finite, 0, "points that were not finite in {steps} steps");
    // The length pass ends every step: what is left is rounding, some 1e-6 in ten hours' worth of steps.
    assert!(worst < 1e-4, "{worst}");
    assert!(steps >= frames, "{steps} steps in {frames} frames");
    if let (Some(early), Some(late)) = (early, memory()) {
        // A state has one size: what may be added is the allocator's, a few pages a thread.
        assert!(late < early + 4096, "{early} KiB became {late} KiB");
    }
}

#[allow(clippy::print_stderr)] // figures that were asked for
fn say(line: &str) {
    eprintln!("{line}");
}

#[test]
fn shaken_hair_stays_finite_in_length_and_in_memory() {
    shake(StrandMethod::Constrain, if super::in_full() { 60.0 } else { 20.0 });
}

#[test]
fn shaken_rods_stay_finite_in_length_and_in_memory() {
    shake(StrandMethod::Rods, 6.0);
}
