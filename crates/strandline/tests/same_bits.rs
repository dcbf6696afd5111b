//! Every built-in scene has the bits that it had: step and picture, on the CPU, against `same_bits.txt`.
//!
//! A change that is not meant to change what comes out is held to it. One that is writes the file again
//! (`STRANDLINE_WRITE_BITS=1`) in a commit of its own that says why.

use std::fmt::Write;
use std::path::Path;

use strandline::{Backend, Devices, Event, Player, Scene, Style, scene::MotionName};

/// A scene, small: a few frames of few strands on a head that shakes.
fn small(mut scene: Scene) -> Scene {
    scene.style.strand_count = 96;
    scene.groom.bound = Some(0);
    scene.look.follow_strands = 16;
    scene.motion.name = MotionName::Shake;
    (scene.film.frames, scene.film.settle) = (3, 0.0);
    (scene.picture.width, scene.picture.height) = (96, 128);
    // Small pictures of all strands.
    scene.level_of_detail.by_pixel = false;
    scene
}

/// Scenes beside those of styles: strands of their own between guides, also on a skin that moves, and strands that
/// push each other apart.
fn others() -> [(String, Scene); 3] {
    let mut between = small(Scene::demo());
    (between.groom.bound, between.look.follow_strands) = (Some(480), 1);
    let mut skin = between.clone();
    skin.body.file = Some(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/bust.glb"));
    (skin.body.clip, skin.motion.name) = (Some("look".to_owned()), MotionName::Still);
    let mut contact = small(Scene::demo());
    contact.simulation.contact.enabled = true;
    [("between", between), ("skin", skin), ("contact", contact)].map(|(name, scene)| (name.to_owned(), scene))
}

/// Sums of the bits of the last step and of the last picture.
fn sums(scene: &Scene) -> [u32; 2] {
    let devices = Devices { simulation: Backend::Cpu, pictures: Backend::Cpu };
    let mut player = Player::new(scene, devices, true).unwrap();
    let mut last = None;
    for event in player.by_ref() {
        if let Event::Drawn { picture, .. } = event.unwrap() {
            last = Some(picture);
        }
    }
    let state = player.state().unwrap();
    let mut step = crc32fast::Hasher::new();
    for lanes in state.positions.iter().chain(&state.velocities) {
        for values in [lanes.x, lanes.y, lanes.z] {
            step.update(values.map(f32::to_le_bytes).as_flattened());
        }
    }
    [step.finalize(), crc32fast::hash(&last.unwrap().pixels)]
}

#[test]
fn built_in_scenes_have_the_bits_that_they_had() {
    let styled = |style: Style| {
        let mut scene = Scene::demo();
        scene.set_style(style);
        (format!("{style:?}").to_lowercase(), scene)
    };
    let thesis = [("thesis".to_string(), Scene::thesis())];
    let mut found = String::new();
    let small = Style::ALL.into_iter().map(styled).chain(thesis).map(|(name, scene)| (name, small(scene)));
    for (name, scene) in small.chain(others()) {
        let [step, picture] = sums(&scene);
        writeln!(found, "{name} {step:08x} {picture:08x}").unwrap();
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/same_bits.txt");
    if std::env::var_os("STRANDLINE_WRITE_BITS").is_some_and(|value| value == "1") {
        std::fs::write(&path, &found).unwrap();
    }
    let known = std::fs::read_to_string(&path).unwrap();
    assert!(found == known, "scene, step, picture: found\n{found}known\n{known}");
}
