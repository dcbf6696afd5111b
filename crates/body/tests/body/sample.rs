//! The sample bust that ships.

use strandline_body::Mesh;

#[test]
fn the_sample_is_small_and_has_its_clips() {
    let path = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/bust.glb"));
    let bytes = std::fs::metadata(path).unwrap().len();
    assert!(bytes < 300_000, "{bytes} bytes");
    assert_eq!(Mesh::clip_names(path).unwrap(), ["nod", "look", "shrug", "smile"]);
}
