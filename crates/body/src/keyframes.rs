//! The motion of a head through keyframes: angles and displacements as curves.

use glam::Vec3;
use strandline_base::math;

use crate::curve::{Curve, Interpolation, Key};
use crate::{BodyError, Pose};

/// Sine of half of the least turn, 15 degrees, and least way \[m\] by which the head jumps where a held keyframe ends: less is
/// a motion that was sampled in steps.
const LEAST_TURN: f32 = 0.130_526_19;
const LEAST_WAY: f32 = 0.1;

/// Angles and a displacement at a time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Keyframe {
    /// Time \[s\].
    pub time: f64,
    /// Angles \[degrees\] about x (pitch), y (yaw) and z (roll); whole turns count.
    ///
    /// The head rolls first, then pitches, then yaws, each about the axes of the world:
    /// `yaw * pitch * roll` as matrices.
    pub rotation: Vec3,
    /// Displacement of the pivot \[m\], world space.
    pub translation: Vec3,
    /// The way to the next keyframe.
    pub interpolation: Interpolation,
    /// Marks a jump: the pose before is held until this keyframe.
    pub is_cut: bool,
}

impl Keyframe {
    /// True if the pose jumps at the end of this keyframe, which is held, to the next one.
    fn ends_in_jump(&self, next: &Self) -> bool {
        let [from, to] = [self, next].map(|key| math::pitch_yaw_roll(key.rotation));
        let turn = (from.conjugate() * to).xyz().length();
        let way = self.translation.distance(next.translation);
        self.interpolation == Interpolation::Hold && (turn > LEAST_TURN || way > LEAST_WAY)
    }
}

/// Poses over time through keyframes.
#[derive(Clone, Debug, PartialEq)]
pub struct Keyframes(Curve<6>);

impl Keyframes {
    /// See [`Motion::keyframes`](crate::Motion::keyframes).
    pub(crate) fn new(keys: &[Keyframe]) -> Result<Self, BodyError> {
        let components = |key: &Keyframe| {
            let [pitch, yaw, roll] = key.rotation.as_dvec3().to_array();
            let [x, y, z] = key.translation.as_dvec3().to_array();
            [pitch, yaw, roll, x, y, z]
        };
        let key = |(index, key): (usize, &Keyframe)| Key {
            time: key.time,
            value: components(key),
            interpolation: key.interpolation,
            is_cut: key.is_cut || index > 0 && keys[index - 1].ends_in_jump(key),
        };
        Curve::new(keys.iter().enumerate().map(key).collect()).map(Self)
    }

    /// The pose at a time \[s\], turned about a pivot \[m\], in a world whose origin lies at `origin` \[m\].
    pub(crate) fn pose(&self, time: f64, pivot: Vec3, origin: Vec3) -> Pose {
        let [pitch, yaw, roll, x, y, z] = self.0.at(time);
        // Whole turns go before single precision does.
        let degrees = [pitch, yaw, roll].map(|angle| (angle % 360.0) as f32);
        let mut pose = Pose::rotation_about(pivot, math::pitch_yaw_roll(degrees.into()));
        pose.translation += (glam::DVec3::new(x, y, z) - origin.as_dvec3()).as_vec3();
        pose
    }

    /// Number of jumps up to a time \[s\]; `None` without any.
    pub(crate) fn jumps_until(&self, time: f64) -> Option<i64> {
        self.0.cuts_until(time)
    }

    /// Tells whether the head jumps later than `after` and not later than `until` \[s\].
    pub(crate) fn is_cut_between(&self, after: f64, until: f64) -> bool {
        self.0.is_cut_between(after, until)
    }
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;
    use crate::Motion;

    const PIVOT: Vec3 = Vec3::new(0.0, 1.4, 0.1);

    fn key(time: f64, rotation: [f32; 3], translation: Vec3) -> Keyframe {
        Keyframe { time, rotation: rotation.into(), translation, ..Keyframe::default() }
    }

    /// Uneven times and rotations about many axes.
    fn path() -> Vec<Keyframe> {
        vec![
            key(0.5, [0.0, 0.0, 0.0], Vec3::ZERO),
            key(1.0, [0.0, 80.0, 0.0], Vec3::new(0.1, 0.0, 0.0)),
            key(1.7, [40.0, 120.0, 15.0], Vec3::new(0.1, 0.2, -0.3)),
            key(2.0, [-60.0, 130.0, 15.0], Vec3::new(-0.2, 0.1, 0.0)),
            key(4.0, [0.0, 450.0, 30.0], Vec3::new(0.0, 0.0, 0.5)),
        ]
    }

    #[test]
    fn the_curve_passes_through_its_keys() {
        let keys = path();
        let motion = Motion::keyframes(&keys).unwrap();
        for key in &keys {
            for pivot in [Vec3::ZERO, PIVOT] {
                let pose = motion.pose(key.time, pivot);
                let expected = math::pitch_yaw_roll(key.rotation);
                // Single precision: rotations of length 1, places of a pivot at 1.4 m.
                assert!(pose.rotation.dot(expected).abs() > 1.0 - 1e-6);
                assert!((pose.point(pivot) - pivot - key.translation).length() < 1e-6);
            }
        }
        assert_eq!(motion.pose(-1.0, PIVOT), Pose::IDENTITY);
        assert_eq!(motion.pose(9.0, PIVOT), motion.pose(4.0, PIVOT));
    }

    /// Yaw \[degrees\] at even times, each closest to the one before.
    fn yaws(keys: &[Keyframe], until: f64) -> Vec<f64> {
        let motion = Motion::keyframes(keys).unwrap();
        let mut yaws: Vec<f64> = Vec::new();
        for i in 0..=200 {
            let face = motion.pose(until * f64::from(i) / 200.0, PIVOT).direction(Vec3::Z);
            let yaw = f64::from(face.x.atan2(face.z)).to_degrees();
            let before = yaws.last().copied().unwrap_or(0.0);
            yaws.push(yaw + 360.0 * ((before - yaw) / 360.0).round());
        }
        yaws
    }

    #[test]
    fn turns_beyond_half_a_turn_turn() {
        for (degrees, seconds) in [(720.0, 2.0), (270.0, 2.0), (-1800.0, 5.0)] {
            let keys = [key(0.0, [0.0; 3], Vec3::ZERO), key(seconds, [0.0, degrees, 0.0], Vec3::ZERO)];
            let yaws = yaws(&keys, seconds);
            let last = yaws[yaws.len() - 1];
            // Single precision of a direction: 1e-5 degrees and what a sum of 200 adds.
            assert!((last - f64::from(degrees)).abs() < 1e-2, "{last} of {degrees}");
        }
    }

    #[test]
    fn a_linear_turn_is_even() {
        let mut keys = [key(0.0, [0.0; 3], Vec3::ZERO), key(4.0, [0.0, 360.0, 0.0], Vec3::ZERO)];
        keys[0].interpolation = Interpolation::Linear;
        for (i, yaw) in yaws(&keys, 4.0).iter().enumerate() {
            assert!((yaw - 1.8 * i as f64).abs() < 1e-2, "{yaw}");
        }
    }

    #[test]
    fn a_cut_is_told_and_nothing_moves_before_it() {
        let mut keys = [key(0.0, [0.0; 3], Vec3::ZERO), key(1.0, [0.0, 180.0, 0.0], Vec3::X)];
        keys[1].is_cut = true;
        let motion = Motion::keyframes(&keys).unwrap();
        assert_eq!(motion.pose(0.999, PIVOT), Pose::IDENTITY);
        assert!((motion.pose(1.0, PIVOT).point(PIVOT) - PIVOT - Vec3::X).length() < 1e-6);
        assert!(motion.is_cut_between(0.99, 1.0) && !motion.is_cut_between(1.0, 2.0));
        assert!(!Motion::Shake.is_cut_between(0.0, 9.0));
    }

    #[test]
    fn a_held_pose_ends_in_a_jump_where_the_next_one_is_far() {
        let jumps = |rotation: [f32; 3], translation: Vec3, interpolation| {
            let mut keys = [key(0.0, [0.0, 350.0, 0.0], Vec3::ZERO), key(1.0, rotation, translation)];
            keys[0].interpolation = interpolation;
            Motion::keyframes(&keys).unwrap().jumps_until(1.0)
        };
        for (degrees, way, expected) in [
            (16.0, 0.0, Some(1)),
            (-16.0, 0.0, Some(1)),
            (0.0, 0.11, Some(1)),
            // A motion that was sampled in steps, and whole turns.
            (14.0, 0.09, None),
            (360.0, 0.0, None),
        ] {
            let (rotation, translation) = ([0.0, 350.0 + degrees, 0.0], Vec3::X * way);
            assert_eq!(jumps(rotation, translation, Interpolation::Hold), expected, "{degrees} {way}");
            assert_eq!(jumps(rotation, translation, Interpolation::Linear), None);
        }
    }

    #[test]
    fn the_order_of_axes_is_as_documented() {
        let motion = Motion::keyframes(&[key(0.0, [30.0, 50.0, 70.0], Vec3::ZERO)]).unwrap();
        let [pitch, yaw, roll] = [30.0_f32, 50.0, 70.0].map(f32::to_radians);
        let expected =
            Quat::from_rotation_y(yaw) * Quat::from_rotation_x(pitch) * Quat::from_rotation_z(roll);
        assert!(motion.pose(0.0, PIVOT).rotation.dot(expected).abs() > 1.0 - 1e-6);
    }

    #[test]
    fn a_rotation_about_the_pivot_keeps_the_pivot_between_keys() {
        let keys = [key(0.0, [0.0; 3], Vec3::ZERO), key(1.0, [57.0, 0.0, 0.0], Vec3::ZERO)];
        let moved = Motion::keyframes(&keys).unwrap().pose(0.5, PIVOT).point(PIVOT) - PIVOT;
        assert!(moved.length() < 1e-6, "{moved}");
    }

    #[test]
    fn one_key_is_a_pose() {
        let motion = Motion::keyframes(&[key(1.0, [0.0, 20.0, 0.0], Vec3::X)]).unwrap();
        for time in [0.0, 1.0, 2.0, f64::NAN] {
            assert!((motion.pose(time, PIVOT).point(PIVOT) - PIVOT - Vec3::X).length() < 1e-6);
        }
    }

    #[test]
    fn unusable_keys_are_refused_with_their_place() {
        let refused = |change: fn(&mut Vec<Keyframe>)| {
            let mut keys = path();
            change(&mut keys);
            Motion::keyframes(&keys).unwrap_err().to_string()
        };
        assert!(refused(|keys| keys.clear()).contains("at least one keyframe"));
        assert!(
            refused(|keys| keys[2].time = 1.0).starts_with("keyframe 2 has the time 1 s after one at 1 s")
        );
        assert!(refused(|keys| keys[1].time = f64::NAN).starts_with("keyframe 1"));
        assert!(refused(|keys| keys[0].translation.x = f32::INFINITY).contains("finite"));
        assert!(refused(|keys| keys[3].rotation.y = f32::NAN).contains("finite"));
    }
}
