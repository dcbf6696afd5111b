//! The curve through keyframes: cubic Hermite pieces in translation and in the logarithm of rotation,
//! with the tangents of Catmull and Rom for uneven times.

use glam::{DQuat, DVec3, Vec3};
use serde::{Deserialize, Serialize};
use strandline_base::math;

use crate::{BodyError, Pose};

/// A pose at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Keyframe {
    /// Time \[s\].
    pub time: f64,
    /// The head's pose then.
    pub world_from_head: Pose,
}

/// Largest difference of a rotation from a unit quaternion; a larger one is an error, not rounding.
const UNIT_TOLERANCE: f32 = 1e-3;

/// The keyframes with unit rotations, or their error.
pub(crate) fn checked(mut keys: Vec<Keyframe>) -> Result<Vec<Keyframe>, BodyError> {
    if keys.is_empty() {
        return Err(BodyError::Value {
            what: "the list of keyframes",
            found: "empty".into(),
            expected: "at least one keyframe",
        });
    }
    let mut before = f64::NEG_INFINITY;
    for (index, key) in keys.iter_mut().enumerate() {
        let Pose { rotation, translation } = &mut key.world_from_head;
        let (found, expected) = if !key.time.is_finite() {
            (format!("the time {}", key.time), "a finite time [s]")
        } else if key.time <= before {
            (
                format!("the time {} s after one at {before} s", key.time),
                "times that rise from each to the next",
            )
        } else if !translation.is_finite() {
            (format!("the translation {translation}"), "three finite numbers [m]")
        } else if !rotation.is_finite() || (rotation.length() - 1.0).abs() > UNIT_TOLERANCE {
            (format!("the rotation {rotation}"), "a quaternion x, y, z, w of length 1")
        } else {
            before = key.time;
            *rotation = rotation.normalize();
            continue;
        };
        return Err(BodyError::Keyframe { index, found, expected });
    }
    Ok(keys)
}

/// The pose at a time; the first and the last are held outside.
pub(crate) fn pose(keys: &[Keyframe], time: f64, pivot: Vec3) -> Pose {
    let next = keys.partition_point(|key| key.time <= time);
    let (Some(first), Some(last)) = (keys.first(), keys.last()) else { return Pose::IDENTITY };
    if next == 0 {
        return first.world_from_head;
    }
    if next == keys.len() {
        return last.world_from_head;
    }
    let span = keys[next].time - keys[next - 1].time;
    let share = (time - keys[next - 1].time) / span;
    let start = Knot::new(keys, next - 1, pivot);
    let end = Knot::new(keys, next, pivot);
    let rotation = rotation_between(&start, &end, span, share).as_quat().normalize();
    let position = hermite([start.position, start.velocity * span, end.position, end.velocity * span], share);
    Pose { rotation, translation: position.as_vec3() - rotation * pivot }
}

/// A keyframe with the velocities with which the curve passes it.
struct Knot {
    /// Position of the pivot \[m\], world space.
    position: DVec3,
    velocity: DVec3,
    rotation: DQuat,
    /// Angular velocity \[rad/s\], head space.
    angular_velocity: DVec3,
}

impl Knot {
    fn new(keys: &[Keyframe], index: usize, pivot: Vec3) -> Self {
        let position = |index: usize| keys[index].world_from_head.point(pivot).as_dvec3();
        let rotation = |index: usize| keys[index].world_from_head.rotation.as_dquat().normalize();
        let (here, turned) = (position(index), rotation(index));
        let (mut velocity, mut angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
        // The first and the last are held, so the curve comes to rest there.
        if index > 0 && index + 1 < keys.len() {
            let before = keys[index].time - keys[index - 1].time;
            let after = keys[index + 1].time - keys[index].time;
            // The slope of the parabola through three points at uneven times.
            let slope = |arrive: DVec3, leave: DVec3| {
                (arrive * after / before + leave * before / after) / (before + after)
            };
            velocity = slope(here - position(index - 1), position(index + 1) - here);
            angular_velocity = slope(
                -logarithm(turned.conjugate() * rotation(index - 1)),
                logarithm(turned.conjugate() * rotation(index + 1)),
            );
        }
        Self { position: here, velocity, rotation: turned, angular_velocity }
    }
}

/// The Hermite curve in the rotation vector that leads from the start, on the shorter way.
fn rotation_between(start: &Knot, end: &Knot, span: f64, share: f64) -> DQuat {
    let whole = logarithm(start.rotation.conjugate() * end.rotation);
    let leave = start.angular_velocity * span;
    let arrive = vector_rate(whole, end.angular_velocity * span);
    start.rotation * math::rotation_by(hermite([DVec3::ZERO, leave, whole, arrive], share))
}

/// The cubic with given values and slopes (value, slope, value, slope) at 0 and 1.
fn hermite([start, leave, end, arrive]: [DVec3; 4], share: f64) -> DVec3 {
    let (t, t2) = (share, share * share);
    let t3 = t2 * t;
    start * (2.0 * t3 - 3.0 * t2 + 1.0)
        + leave * (t3 - 2.0 * t2 + t)
        + end * (3.0 * t2 - 2.0 * t3)
        + arrive * (t3 - t2)
}

/// The rotation vector \[rad\] of the shorter of the two ways.
fn logarithm(rotation: DQuat) -> DVec3 {
    let rotation = if rotation.w < 0.0 { -rotation } else { rotation };
    math::rotation_vector(rotation)
}

/// Rate of a rotation vector whose rotation turns with an angular velocity given in the rotated space: the
/// inverse right Jacobian of the rotation group. // [Sola2018 eq. 144]
fn vector_rate(vector: DVec3, angular_velocity: DVec3) -> DVec3 {
    let angle = vector.length();
    let once = vector.cross(angular_velocity);
    let twice = vector.cross(once);
    // (1 - a/2 cot a/2) / a^2, and its limit where that is 0 / 0.
    let share = if angle < 1e-4 {
        1.0 / 12.0
    } else {
        (1.0 - 0.5 * angle / math::tan(0.5 * angle)) / (angle * angle)
    };
    angular_velocity + once * 0.5 + twice * share
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;
    use crate::Motion;

    const PIVOT: Vec3 = Vec3::new(0.0, 1.4, 0.1);

    fn key(time: f64, axis: Vec3, degrees: f32, translation: Vec3) -> Keyframe {
        let rotation = Quat::from_axis_angle(axis.normalize(), degrees.to_radians());
        Keyframe { time, world_from_head: Pose { rotation, translation } }
    }

    /// Uneven times, rotations about many axes, one of them the long way round as written.
    fn path() -> Vec<Keyframe> {
        let mut keys = vec![
            key(0.5, Vec3::Y, 0.0, Vec3::ZERO),
            key(1.0, Vec3::Y, 80.0, Vec3::new(0.1, 0.0, 0.0)),
            key(1.7, Vec3::new(1.0, 2.0, 0.3), 120.0, Vec3::new(0.1, 0.2, -0.3)),
            key(2.0, Vec3::X, -60.0, Vec3::new(-0.2, 0.1, 0.0)),
            key(4.0, Vec3::Z, 30.0, Vec3::new(0.0, 0.0, 0.5)),
        ];
        keys[2].world_from_head.rotation = -keys[2].world_from_head.rotation;
        keys
    }

    #[test]
    fn the_curve_passes_through_its_keys() {
        let keys = path();
        let motion = Motion::keyframes(keys.clone()).unwrap();
        for key in &keys {
            for pivot in [Vec3::ZERO, PIVOT] {
                let pose = motion.pose(key.time, pivot);
                // Single precision: rotations of length 1, translations through a pivot at 1.4 m.
                assert!(pose.rotation.dot(key.world_from_head.rotation).abs() > 1.0 - 1e-6);
                assert!((pose.translation - key.world_from_head.translation).length() < 1e-6);
            }
        }
        assert_eq!(motion.pose(-1.0, PIVOT), keys[0].world_from_head);
        assert_eq!(motion.pose(9.0, PIVOT), motion.pose(4.0, PIVOT));
    }

    /// Velocity \[m/s\] of points of the head by one-sided differences before and after a time.
    fn velocities(keys: &[Keyframe], time: f64) -> [Vec3; 2] {
        let step = 2e-3;
        let at = |time: f64| pose(keys, time, PIVOT).point(PIVOT + Vec3::new(0.3, 0.4, 0.5));
        // The one-sided second-order difference, so that bends do not read as jumps.
        let one_sided = |h: f64| (at(time) * -1.5 + at(time + h) * 2.0 - at(time + 2.0 * h) * 0.5) / h as f32;
        [one_sided(-step), one_sided(step)]
    }

    #[test]
    fn velocity_is_continuous_at_the_keys() {
        let keys = checked(path()).unwrap();
        for key in &keys {
            let [before, after] = velocities(&keys, key.time);
            // Positions of 1.5 m rounded to 1.2e-7 over steps of 2 ms: 4e-4 m/s; the third derivative,
            // up to 500 m/s^3 here, times the step squared over three: 7e-4 m/s.
            assert!((before - after).length() < 5e-3, "at {} s: {before} {after}", key.time);
        }
        let inner = velocities(&keys, 1.0)[0].length();
        assert!(inner > 0.3, "the curve does not stop at its keys: {inner} m/s");
        assert!(velocities(&keys, 0.5)[1].length() < 5e-3 && velocities(&keys, 4.0)[0].length() < 5e-3);
    }

    #[test]
    fn even_turns_and_throws_are_kept_at_uneven_times() {
        // A parabola: the tangents are exact at the inner keys, so the cubic is it.
        let thrown = |time: f64| Vec3::new(0.1, 0.2, -0.3) * (time - 0.3 * time * time) as f32;
        let keys = [0.0, 1.0, 1.5, 3.0, 3.2, 4.0]
            .map(|time: f64| key(time, Vec3::Y, 40.0 * time as f32, thrown(time)));
        for i in 0..=44 {
            // From the second to the last but one key both tangents are the chord's: a straight line.
            let time = 1.0 + f64::from(i) * 0.05;
            let pose = pose(&keys, time, Vec3::ZERO);
            let expected = Quat::from_rotation_y((40.0 * time as f32).to_radians());
            assert!(pose.rotation.dot(expected).abs() > 1.0 - 1e-6, "{time}");
            // Single precision at 1 m.
            assert!((pose.translation - thrown(time)).length() < 1e-6, "{time}");
        }
    }

    #[test]
    fn the_sign_of_a_quaternion_does_not_matter() {
        let negated = path();
        let mut keys = negated.clone();
        keys[2].world_from_head.rotation = -keys[2].world_from_head.rotation;
        for i in 0..400 {
            let time = f64::from(i) * 0.01;
            let (one, other) = (pose(&keys, time, PIVOT), pose(&negated, time, PIVOT));
            assert!(one.rotation.dot(other.rotation).abs() > 1.0 - 1e-6, "{time}");
            assert!((one.translation - other.translation).length() < 1e-6, "{time}");
        }
    }

    #[test]
    fn a_rotation_about_the_pivot_keeps_the_pivot_between_keys() {
        let turned = Quat::from_rotation_x(1.0);
        let keys = vec![
            Keyframe { time: 0.0, world_from_head: Pose::IDENTITY },
            Keyframe { time: 1.0, world_from_head: Pose::rotation_about(PIVOT, turned) },
        ];
        let moved = pose(&keys, 0.5, PIVOT).point(PIVOT) - PIVOT;
        assert!(moved.length() < 1e-6, "{moved}");
    }

    #[test]
    fn one_key_is_a_pose() {
        let only = key(1.0, Vec3::Y, 20.0, Vec3::X);
        let motion = Motion::keyframes(vec![only]).unwrap();
        for time in [0.0, 1.0, 2.0, f64::NAN] {
            assert!((motion.pose(time, PIVOT).translation - Vec3::X).length() < 1e-6);
        }
        assert_eq!(pose(&[], 1.0, PIVOT), Pose::IDENTITY);
    }

    #[test]
    fn unusable_keys_are_refused_with_their_place() {
        let refused = |change: fn(&mut Vec<Keyframe>)| {
            let mut keys = path();
            change(&mut keys);
            Motion::keyframes(keys).unwrap_err().to_string()
        };
        assert!(refused(|keys| keys.clear()).contains("at least one keyframe"));
        assert!(
            refused(|keys| keys[2].time = 1.0).starts_with("keyframe 2 has the time 1 s after one at 1 s")
        );
        assert!(refused(|keys| keys[1].time = f64::NAN).starts_with("keyframe 1"));
        assert!(refused(|keys| keys[0].world_from_head.translation.x = f32::INFINITY).contains("finite"));
        assert!(refused(|keys| keys[3].world_from_head.rotation.w = 2.0).contains("quaternion"));
    }
}
