//! Figures of hair that moves.

use glam::Vec3;
use strandline::{Camera, Look, Scene, Style, scene::MotionName};

use crate::setup::{Figure, Moving, Setup, bust};
use crate::strip::joined;

/// Pictures at times \[s\] that rise.
fn at_times(moving: &mut Moving, camera: &Camera, look: &Look, times: &[f64]) -> Figure {
    let mut pictures = Vec::new();
    for &time in times {
        moving.play_to(time)?;
        pictures.push(moving.hair.picture(camera, look)?);
    }
    Ok(joined(&pictures))
}

/// The thesis's scene: six times of a head shake.
pub fn head_shake(setup: &Setup) -> Figure {
    let mut moving = setup.settled(&Scene::thesis(), 196, 196)?;
    let camera = bust(Vec3::new(0.0, 0.1, 1.0));
    at_times(&mut moving, &camera, &Look::brown(), &[0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
}

fn long_hair(setup: &Setup, direction: Vec3) -> Figure {
    let mut moving = setup.settled(&setup.scene(Style::Long, MotionName::Shake), 236, 236)?;
    at_times(&mut moving, &bust(direction), &Look::brown(), &[0.0, 0.25, 0.5, 0.75, 1.0])
}

/// Long hair in a head shake, from the front.
pub fn front(setup: &Setup) -> Figure {
    long_hair(setup, Vec3::new(0.0, 0.1, 1.0))
}

/// The same from behind.
pub fn back(setup: &Setup) -> Figure {
    long_hair(setup, Vec3::new(0.0, 0.14, -1.0))
}

/// Hair whose length is changed while it hangs: one side shorter, the other longer than it was.
pub fn lengths(setup: &Setup) -> Figure {
    let mut moving = setup.settled(&setup.scene(Style::Long, MotionName::Still), 304, 304)?;
    let guides = moving.hair.guides();
    let sides: Vec<f32> =
        (0..guides.strand_count()).map(|strand| guides.position(strand, 0).x.signum()).collect();
    let camera = bust(Vec3::new(0.0, 0.1, 1.0));
    let mut pictures = Vec::new();
    for (time, change) in [(0.0, 0.0), (0.83, 0.25), (1.67, 0.5)] {
        let scales: Vec<f32> = sides.iter().map(|side| 1.0 + side * change).collect();
        moving.hair.set_length_scale(&scales)?;
        moving.play_to(time)?;
        pictures.push(moving.hair.picture(&camera, &Look::brown())?);
    }
    Ok(joined(&pictures))
}
