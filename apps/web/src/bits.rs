//! Bits of scenes on the CPU: a page and a native program print the same lines.

use strandline::{Backend, Error, Hair, Prepared, Scene, Style, scene::MotionName};

/// Names of the scenes: the demo, and small forms of every style.
pub const NAMES: [&str; 7] = ["demo", "bob", "curly", "long", "pixie", "ponytail", "wavy"];

/// Frames of the demo, which are 62 steps.
const DEMO_FRAMES: u32 = 31;

/// A line with the sums of the bits of a scene's last step and of its picture, after `name`. Frames beside the demo are
/// few, and so are their strands.
///
/// # Errors
/// A name that is not in [`NAMES`], or whatever the scene refuses.
pub fn line(name: &str) -> Result<String, Error> {
    let mut scene = Scene::demo();
    (scene.picture.width, scene.picture.height) = (96, 128);
    if name == "demo" {
        scene.film.frames = DEMO_FRAMES;
    } else {
        scene.set_style(name.parse::<Style>()?);
        scene.style.strand_count = 96;
        scene.motion.name = MotionName::Shake;
        (scene.film.frames, scene.film.settle) = (3, 0.0);
        scene.level_of_detail.by_pixel = false;
    }
    let [step, picture] = sums(&scene)?;
    Ok(format!("{name} {step:08x} {picture:08x}"))
}

/// Sums of the bits of the last step and of the picture after it.
fn sums(scene: &Scene) -> Result<[u32; 2], Error> {
    let mut hair = Hair::from_prepared(Prepared::new(scene)?, Backend::Cpu)?;
    for frame in 0..scene.film.frames {
        hair.play(frame)?;
    }
    let mut step = crc32fast::Hasher::new();
    let state = hair.state()?;
    for lanes in state.positions.iter().chain(&state.velocities) {
        for values in [lanes.x, lanes.y, lanes.z] {
            step.update(values.map(f32::to_le_bytes).as_flattened());
        }
    }
    let (camera, look) = (*hair.camera(), hair.look().clone());
    let picture = hair.picture(&camera, &look)?;
    Ok([step.finalize(), crc32fast::hash(&picture.pixels)])
}
