//! docs/limits.md has the limits of inputs as the code has them.

use strandline::{groom::format, render::surroundings::Panorama, scene};

#[test]
fn the_limits_of_inputs_are_documented() {
    let text = include_str!("../../../../docs/limits.md").replace(',', "");
    for words in [
        format!("| scene | {} MiB |", scene::MAX_FILE_BYTES >> 20),
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
    ] {
        assert!(text.contains(&words), "`{words}` is missing");
    }
}
