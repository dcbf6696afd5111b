//! docs/limits.md has the limits of inputs as the code has them.

use strandline::{
    Scene, format, look::surroundings::Panorama, low_level::render::memory::MAX_LIGHTS, scene,
    settings::Group,
};

/// Most items of a list, by its key.
fn most(list: &str) -> f64 {
    Scene::TABLE.row(list).unwrap().range.unwrap()[1]
}

#[test]
fn the_limits_of_inputs_are_documented() {
    let text = include_str!("../../../../../docs/limits.md").replace(',', "");
    for words in [
        format!(
            "| scene | {} MiB {MAX_LIGHTS} `lights` {} `colliders` {} `groom.parts` {} `body.parts` {} of `look.group` \
             {} `simulation.groups` |",
            scene::MAX_FILE_BYTES >> 20,
            Scene::MAX_COLLIDERS,
            most("groom.parts"),
            most("body.parts"),
            most("look.group"),
            most("simulation.groups"),
        ),
        format!(
            "| {} MiB {} strands {} points of a strand {} points |",
            format::MAX_FILE_BYTES >> 20,
            format::MAX_STRANDS,
            format::MAX_POINTS_PER_STRAND,
            format::MAX_POINTS
        ),
        format!(
            "| surroundings (.hdr .exr) | {} MiB {} pixels |",
            Panorama::MAX_BYTES >> 20,
            Panorama::MAX_PIXELS
        ),
        format!(
            "| map of colours or widths (.png) | {} MiB {} pixels a side |",
            Scene::MAX_MAP_BYTES >> 20,
            Scene::MAX_MAP_SIDE
        ),
    ] {
        assert!(text.contains(&words), "`{words}` is missing");
    }
}
