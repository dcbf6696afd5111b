//! Files of the head's motion, and what is said of them.

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
