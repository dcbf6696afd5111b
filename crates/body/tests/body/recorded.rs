//! Files of the head's motion, and what is said of them.

use std::path::Path;

use strandline_body::RecordedMotion;

#[test]
fn samples_in_centimetres_are_told_from_a_cut() {
    let read = |places: &[f32], scale: f64| {
        let frames: String = places.iter().map(|place| format!(" {place}")).collect();
        let text = format!(
            "HIERARCHY ROOT Head {{ OFFSET 0 0 0 CHANNELS 1 Xposition }} MOTION Frames: {} Frame Time: 0.04{frames}",
            places.len()
        );
        RecordedMotion::from_bvh(text.as_bytes(), "Head", scale).unwrap()
    };
    let walk = [0.0, 6.0, 12.0, 18.0];
    let (way, seconds) = read(&walk, 1.0).far_way().unwrap();
    assert!((way - 6.0).abs() < 1e-5 && (seconds - 0.04).abs() < 1e-9, "{way} m in {seconds} s");
    assert_eq!(read(&walk, 0.01).far_way(), None);
    assert_eq!(read(&[0.0, 0.06, 9.0, 9.06, 0.0], 1.0).far_way(), None, "two cuts");
}

#[test]
fn words_are_of_the_motion_of_the_head() {
    let bust = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/bust.glb");
    let notes = |joint: &str, clip| RecordedMotion::load_noted(&bust, joint, clip, 1.0).unwrap().1;
    let note = "motion.joint is `bust`, which the clip `nod` does not move: the head rests; nodes that move are `neck`, `head`";
    assert_eq!(notes("bust", None), [note]);
    assert!(notes("head", Some("look")).is_empty());
    let error = RecordedMotion::load(Path::new("absent.bvh"), "Head", None, 1.0).unwrap_err().to_string();
    assert!(error.starts_with("cannot read the motion of the head: ") && error.ends_with(": absent.bvh"));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rests.gltf");
    std::fs::write(&path, r#"{"asset":{"version":"2.0"},"nodes":[{"name":"Head"}]}"#).unwrap();
    for clip in [None, Some("nod")] {
        let error = RecordedMotion::load(&path, "Head", clip, 1.0).unwrap_err().to_string();
        assert!(error.starts_with("a file without clips, expected a motion of the head; export"), "{error}");
    }
    let path = folder.path().join("one.bvh");
    let text = "HIERARCHY ROOT Head { OFFSET 0 0 0 CHANNELS 1 Xposition } MOTION Frames: 1 Frame Time: 1 0";
    std::fs::write(&path, text).unwrap();
    let (_, notes) = RecordedMotion::load_noted(&path, "Head", Some("nod"), 1.0).unwrap();
    assert_eq!(notes, ["motion.clip is not used: a .bvh has one motion"]);
}
