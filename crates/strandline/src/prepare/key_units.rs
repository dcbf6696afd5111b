//! Notes on keyframes whose values are probably in other units than those of their settings.

use glam::Vec3;

use crate::{
    Scene,
    body::{Interpolation, RecordedMotion},
    scene::{KeyframeSection, MotionName},
};

/// Speeds \[m/s\] of a head, and of a solid or a camera, that few films have between two keys more than a way \[m\] apart: a
/// rider is slower than the first.
const OF_HEADS: f64 = 25.0;
const OF_OTHERS: f64 = 45.0;
const LEAST: f32 = 1.0;
/// Largest angle \[radian\] that a person writes for a turn.
const WHOLE_TURN: f32 = 7.0;
/// Part \[radian\] of a turn that a person means, 15 degrees, and how near \[radian\] a rounded one is to whole numbers of it.
const PART: f32 = std::f32::consts::PI / 12.0;
const ROUNDED: f32 = 4e-3;

/// Values of a key: the time \[s\], the displacement \[m\], the angles \[degrees\], whether it is a jump, and whether it is
/// held until the next one.
struct Values {
    time: f64,
    translation: Vec3,
    angles: Vec<f32>,
    is_cut: bool,
    is_held: bool,
}

/// Names keys that are probably in centimetres or radians: those of the head, of solids and of the camera.
pub(super) fn notes(scene: &Scene) -> Vec<String> {
    let (mut notes, way) = (Vec::new(), scene.motion.interpolation);
    if scene.motion.name == MotionName::Keyframes {
        notes.extend(of_keys(
            "motion.keyframes",
            ("the head", OF_HEADS),
            &poses(&scene.motion.keyframes, way),
        ));
    }
    for (index, solid) in scene.colliders.iter().enumerate() {
        let list = format!("colliders[{index}].keyframes");
        notes.extend(of_keys(&list, ("the solid", OF_OTHERS), &poses(solid.keyframes(), way)));
    }
    let views = scene.camera.keyframes.iter().map(|key| Values {
        time: key.time,
        translation: key.translation,
        // A window keeps views to any part of a degree.
        angles: Vec::new(),
        is_cut: key.cut,
        is_held: key.interpolation == Some(Interpolation::Hold),
    });
    notes.extend(of_keys("camera.keyframes", ("the camera", OF_OTHERS), &views.collect::<Vec<_>>()));
    notes
}

/// The note on the motion of a file that is probably in centimetres, where the head follows it.
pub(super) fn of_file(scene: &Scene, recorded: Option<&RecordedMotion>) -> Option<String> {
    let recorded = recorded.filter(|_| scene.motion.name == MotionName::File);
    let (way, seconds) = recorded.and_then(RecordedMotion::far_way)?;
    let (way, seconds) = ((1e3 * way).round() / 1e3, (1e3 * seconds).round() / 1e3);
    Some(format!(
        "motion.file moves the head by {way} m in {seconds} s, again and again: motion.scale is {} m, and of a file in \
         centimetres it is 0.01 m",
        scene.motion.scale
    ))
}

/// Values of poses, given the way from pose to pose where one does not name its own.
fn poses(keys: &[KeyframeSection], way: Interpolation) -> Vec<Values> {
    let values = |key: &KeyframeSection| Values {
        time: key.time,
        translation: key.translation,
        angles: key.rotation.to_array().into(),
        is_cut: key.cut,
        is_held: key.interpolation.unwrap_or(way) == Interpolation::Hold,
    };
    keys.iter().map(values).collect()
}

/// Notes on the keys of a list, given the name of what they move and how fast it may be \[m/s\].
fn of_keys(list: &str, (moved, fastest): (&str, f64), keys: &[Values]) -> Vec<String> {
    let translation = far_key(keys, fastest).map(|(index, way, time)| {
        let (way, time) = ((1e3 * way).round() / 1e3, (1e3 * time).round() / 1e3);
        format!(
            "{list}[{index}].translation moves {moved} by {way} m in {time} s: translations are in metres, and {way} cm \
             would be {}",
            way / 100.0
        )
    });
    let rotation = largest_angle(keys).map(|(index, angle)| {
        format!(
            "{list}[{index}].rotation has {angle} degrees, the most of all keys: angles are in degrees, and {angle} radians \
             would be {:.0}",
            angle.to_degrees()
        )
    });
    translation.into_iter().chain(rotation).collect()
}

/// The first key to which the way from the one before is too fast for metres: its index, the way \[m\] and its time \[s\].
fn far_key(keys: &[Values], fastest: f64) -> Option<(usize, f32, f64)> {
    let pairs = keys.windows(2).enumerate().filter(|(_, pair)| !(pair[0].is_held || pair[1].is_cut));
    let ways = pairs.map(|(index, pair)| {
        (index + 1, pair[1].translation.distance(pair[0].translation), pair[1].time - pair[0].time)
    });
    let mut far = ways.filter(|(_, way, time)| *way > LEAST && f64::from(*way) > fastest * time);
    far.next()
}

/// The largest angle \[degrees\] and the index of its key, where it is a part of a turn that a person writes in radians.
fn largest_angle(keys: &[Values]) -> Option<(usize, f32)> {
    let of_key = |key: &Values| key.angles.iter().fold(0.0_f32, |most, angle| most.max(angle.abs()));
    let (index, most) = keys.iter().map(of_key).enumerate().max_by(|one, two| one.1.total_cmp(&two.1))?;
    let parts = (most / PART).round();
    let is_part = parts > 0.0 && (most - parts * PART).abs() < ROUNDED;
    (is_part && most < WHOLE_TURN).then_some((index, most))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{CameraKeyframe, ColliderSection, SphereSection};

    fn key(time: f64, translation: Vec3, rotation: Vec3) -> KeyframeSection {
        KeyframeSection { time, translation, rotation, ..KeyframeSection::default() }
    }

    fn notes_on(keys: Vec<KeyframeSection>) -> Vec<String> {
        let mut scene = Scene::default();
        (scene.motion.name, scene.motion.keyframes) = (MotionName::Keyframes, keys);
        notes(&scene)
    }

    #[test]
    fn keys_in_centimetres_are_named() {
        let moved = |ways: &[f32]| {
            let keys = ways.iter().enumerate();
            notes_on(keys.map(|(index, way)| key(0.5 * index as f64, way * Vec3::X, Vec3::ZERO)).collect())
        };
        let note = "motion.keyframes[2].translation moves the head by 30 m in 0.5 s: translations are in metres, and 30 cm \
                    would be 0.3";
        assert_eq!(moved(&[0.0, 2.0, 32.0, 4.0]), [note], "the first one that is far");
        // A person who runs, and one who runs far.
        assert_eq!(moved(&[0.0, 3.0, 6.0, 9.0]), Vec::<String>::new());
        // A rider, far away in the end.
        assert_eq!(moved(&[0.0, 7.0, 14.0, 21.0, 28.0]), Vec::<String>::new());
        let cut = KeyframeSection { cut: true, ..key(1.0, Vec3::X * 500.0, Vec3::ZERO) };
        assert_eq!(notes_on(vec![key(0.0, Vec3::ZERO, Vec3::ZERO), cut]), Vec::<String>::new(), "a jump");
        let hold = Some(Interpolation::Hold);
        let held = KeyframeSection { interpolation: hold, ..key(0.0, Vec3::ZERO, Vec3::ZERO) };
        assert_eq!(notes_on(vec![held, key(1.0, Vec3::X * 500.0, Vec3::ZERO)]), Vec::<String>::new(), "held");
        let shaken = vec![key(0.0, Vec3::ZERO, Vec3::ZERO), key(0.01, 0.1 * Vec3::X, Vec3::ZERO)];
        assert_eq!(notes_on(shaken), Vec::<String>::new());
    }

    #[test]
    fn keys_in_radians_are_named() {
        let turned = |angles: &[f32]| {
            let keys = angles.iter().enumerate();
            notes_on(keys.map(|(index, angle)| key(index as f64, Vec3::ZERO, angle * Vec3::Y)).collect())
        };
        let note = "motion.keyframes[1].rotation has 1.57 degrees, the most of all keys: angles are in degrees, and 1.57 radians \
                    would be 90";
        assert_eq!(turned(&[0.0, -1.57, 0.5]), [note]);
        assert_eq!(turned(&[0.0, 0.35, 4.71]).len(), 1);
        // Small turns that were recorded, or come of a hand in the window.
        let small = [&[1e-7, 0.0][..], &[1.2, -0.8], &[2.31, -3.87, 0.44], &[3.3]];
        let others = [&[0.0, 0.0][..], &[0.0, 1.57, 40.0], &[3.0, -3.0, 1.5], &[0.0, 720.0]];
        for angles in small.into_iter().chain(others) {
            assert_eq!(turned(angles), Vec::<String>::new(), "{angles:?}");
        }
    }

    #[test]
    fn keys_of_solids_and_cameras_are_named_and_unused_ones_are_not() {
        let keys = vec![key(0.0, Vec3::ZERO, Vec3::ZERO), key(1.0, 60.0 * Vec3::Z, 1.05 * Vec3::X)];
        let mut scene = Scene::default();
        scene.motion.keyframes.clone_from(&keys);
        assert_eq!(notes(&scene), Vec::<String>::new(), "the head shakes");
        scene.colliders =
            vec![ColliderSection::Sphere(SphereSection { keyframes: keys, ..SphereSection::default() })];
        let view = |time: f64, x: f32| CameraKeyframe {
            time,
            translation: x * Vec3::X,
            turn: 0.3,
            ..CameraKeyframe::default()
        };
        scene.camera.keyframes = vec![view(0.0, 0.0), view(1.0, 50.0)];
        let found = notes(&scene);
        assert!(found[0].starts_with("colliders[0].keyframes[1].translation moves the solid by 60 m in 1 s"));
        assert!(found[1].starts_with("colliders[0].keyframes[1].rotation has 1.05 degrees"), "{found:?}");
        assert!(
            found[2].starts_with("camera.keyframes[1].translation moves the camera by 50 m"),
            "{found:?}"
        );
        assert_eq!(found.len(), 3, "{found:?}");
    }
}
