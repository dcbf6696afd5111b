use std::f64::consts::TAU;
use std::str::FromStr;

use glam::{DVec3, Vec3};
use strandline_base::math;

use crate::keyframes::{Keyframe, Keyframes};
use crate::{BodyError, Pose};

/// Largest angle of the shake to either side.
const SHAKE_DEGREES: f64 = 35.0;
/// Shakes in a second \[Hz\].
const SHAKE_FREQUENCY: f64 = 1.2;
/// Largest angle of the nod up and down.
const NOD_DEGREES: f64 = 20.0;
/// Nods in a second \[Hz\].
const NOD_FREQUENCY: f64 = 1.0;
/// Time in which shake and nod reach their full angle \[s\].
const RAMP: f64 = 0.4;
/// Largest angle of the turn to either side.
const TURN_DEGREES: f64 = 60.0;
/// Length of one look to both sides \[s\].
const TURN_PERIOD: f64 = 4.0;

/// Motion of the head: a pose for every time, smooth in velocity, at rest at time 0.
///
/// Before time 0 the built-in motions rest. Left is the head's own left, +x.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Motion {
    /// The head rests.
    #[default]
    Still,
    /// "No": the thesis's head shake, about the vertical axis, 35 degrees to either side,
    /// 1.2 times a second, the left first; the angle grows from rest over the first 0.4 s.
    Shake,
    /// "Yes": about the axis through the ears, 20 degrees down and up, once a second, down first;
    /// the angle grows from rest over the first 0.4 s.
    Nod,
    /// A slow look to the left and to the right, 60 degrees to either side in 4 s, with a rest of 0.4 s
    /// at either side, again and again.
    Turn,
    /// Poses from a scene, joined by curves; at rest before the first and after the last.
    Keyframes(Keyframes),
}

impl Motion {
    /// A motion through keyframes: each angle and each part of the displacement by itself, never beyond the two
    /// keyframes beside a time.
    ///
    /// # Errors
    /// There must be at least one; times must rise from each to the next; all numbers must be finite.
    pub fn keyframes(keys: &[Keyframe]) -> Result<Self, BodyError> {
        Keyframes::new(keys).map(Self::Keyframes)
    }

    /// Tells whether the head jumps (`is_cut` of a keyframe, the end of a held one) later than `after` and not later than `until` \[s\].
    pub fn is_cut_between(&self, after: f64, until: f64) -> bool {
        match self {
            Self::Still | Self::Shake | Self::Nod | Self::Turn => false,
            Self::Keyframes(keys) => keys.is_cut_between(after, until),
        }
    }

    /// Number of jumps (`is_cut` of a keyframe, ends of held ones) up to a time \[s\]; `None` of a motion without any.
    pub fn jumps_until(&self, time: f64) -> Option<i64> {
        match self {
            Self::Still | Self::Shake | Self::Nod | Self::Turn => None,
            Self::Keyframes(keys) => keys.jumps_until(time),
        }
    }

    /// The head's pose (`world_from_head`) at a time \[s\].
    ///
    /// `pivot` \[m\], head space, is the point about which the head rotates, near the top of the
    /// neck. The built-in motions keep it where it is. Keyframes turn the head about it and displace it.
    pub fn pose(&self, time: f64, pivot: Vec3) -> Pose {
        self.pose_from(time, pivot, Vec3::ZERO)
    }

    /// The head's pose as [`Motion::pose`], in a world whose origin lies at `origin` \[m\]: exact to single precision there,
    /// however far the head is from the origin of its keyframes.
    pub fn pose_from(&self, time: f64, pivot: Vec3, origin: Vec3) -> Pose {
        // [Chen2011 fig. 34] shows the head shake and gives no angle; these are a quick "no".
        let (axis, degrees) = match self {
            Self::Still => return Pose { translation: Vec3::ZERO - origin, ..Pose::IDENTITY },
            Self::Keyframes(keys) => return keys.pose(time, pivot, origin),
            Self::Shake => (DVec3::Y, SHAKE_DEGREES * swing(time, SHAKE_FREQUENCY)),
            Self::Nod => (DVec3::X, NOD_DEGREES * swing(time, NOD_FREQUENCY)),
            Self::Turn => (DVec3::Y, TURN_DEGREES * look(time)),
        };
        let rotation = math::rotation(axis.as_vec3(), degrees.to_radians() as f32);
        let pose = Pose::rotation_about(pivot, rotation);
        Pose { translation: pose.translation - origin, ..pose }
    }
}

impl FromStr for Motion {
    type Err = BodyError;

    fn from_str(name: &str) -> Result<Self, BodyError> {
        match name {
            "still" => Ok(Self::Still),
            "shake" => Ok(Self::Shake),
            "nod" => Ok(Self::Nod),
            "turn" => Ok(Self::Turn),
            _ => Err(BodyError::Value {
                what: "the motion",
                found: format!("`{name}`"),
                expected: "still, shake, nod or turn",
            }),
        }
    }
}

/// An oscillation of amplitude 1 that grows from rest, -1..1.
fn swing(time: f64, frequency: f64) -> f64 {
    let time = since_start(time);
    rise(time / RAMP) * math::sin(TAU * (time * frequency).fract())
}

/// A look to the left (1) and to the right (-1) with rests, from and to 0, once in a period.
fn look(time: f64) -> f64 {
    let part = (since_start(time) / TURN_PERIOD).fract();
    // To the left, rest, to the right, rest, to the front: 0.8, 0.4, 1.6, 0.4 and 0.8 s.
    rise(part / 0.2) - 2.0 * rise((part - 0.3) / 0.4) + rise((part - 0.8) / 0.2)
}

/// From 0 at 0 to 1 at 1 with no velocity and no acceleration at either end.
fn rise(share: f64) -> f64 {
    let share = share.clamp(0.0, 1.0);
    share * share * share * (10.0 + share * (6.0 * share - 15.0))
}

fn since_start(time: f64) -> f64 {
    if time.is_finite() { time.max(0.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PIVOT: Vec3 = Vec3::new(0.0, 1.45, -0.02);
    const BUILT_IN: [Motion; 3] = [Motion::Shake, Motion::Nod, Motion::Turn];

    /// Signed angle \[degrees\] about an axis.
    fn degrees(motion: &Motion, time: f64, axis: Vec3) -> f64 {
        let rotation = motion.pose(time, PIVOT).rotation;
        let imaginary = Vec3::new(rotation.x, rotation.y, rotation.z);
        let along = imaginary.dot(axis);
        assert!((imaginary - axis * along).length() < 1e-6, "only about {axis}");
        f64::from(2.0 * along.atan2(rotation.w)).to_degrees()
    }

    fn extremes(motion: &Motion, axis: Vec3, seconds: f64) -> (f64, f64) {
        (0..=(seconds * 1000.0) as usize)
            .map(|i| degrees(motion, i as f64 / 1000.0, axis))
            .fold((0.0, 0.0), |(low, high), angle| (angle.min(low), angle.max(high)))
    }

    #[test]
    fn amplitudes_are_as_documented() {
        for (motion, axis, amplitude) in
            [(Motion::Shake, Vec3::Y, 35.0), (Motion::Nod, Vec3::X, 20.0), (Motion::Turn, Vec3::Y, 60.0)]
        {
            let (low, high) = extremes(&motion, axis, 8.0);
            // Sampled every millisecond: a sine at 1.2 Hz is at most 7e-6 of its amplitude lower there;
            // the quaternion is single precision.
            assert!(
                (high - amplitude).abs() < 1e-2 && (low + amplitude).abs() < 1e-2,
                "{motion:?} {low} {high}"
            );
        }
    }

    #[test]
    fn frequencies_are_as_documented() {
        for (motion, axis, frequency) in [(Motion::Shake, Vec3::Y, 1.2), (Motion::Nod, Vec3::X, 1.0)] {
            // 10 s hold a whole number of periods; moments are off the zero crossings.
            let angles: Vec<f64> =
                (0..=4000).map(|i| degrees(&motion, 0.501 + i as f64 / 400.0, axis)).collect();
            let crossings = angles.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count();
            assert_eq!(crossings as f64, 2.0 * frequency * 10.0, "{motion:?}");
        }
        for i in 0..400 {
            let time = i as f64 / 100.0;
            // A shift by the period changes rounding only.
            let apart = degrees(&Motion::Turn, time, Vec3::Y) - degrees(&Motion::Turn, time + 4.0, Vec3::Y);
            assert!(apart.abs() < 1e-4);
        }
    }

    #[test]
    fn the_turn_rests_at_both_sides_and_starts_to_the_left() {
        for i in 0..=40 {
            let rest = i as f64 / 100.0;
            assert!((degrees(&Motion::Turn, 0.8 + rest, Vec3::Y) - 60.0).abs() < 1e-4);
            assert!((degrees(&Motion::Turn, 2.8 + rest, Vec3::Y) + 60.0).abs() < 1e-4);
        }
        let face = Motion::Turn.pose(0.8, PIVOT).direction(Vec3::Z);
        assert!(face.x > 0.8);
        assert!(Motion::Nod.pose(0.25, PIVOT).direction(Vec3::Z).y < 0.0, "down first");
    }

    #[test]
    fn every_motion_starts_at_rest() {
        for motion in BUILT_IN.iter().chain([&Motion::Still]) {
            assert_eq!(motion.pose(0.0, PIVOT), Pose::IDENTITY);
            assert_eq!(motion.pose(-3.0, PIVOT), Pose::IDENTITY);
            // The angle starts as the fourth power of time: within 1 ms it is below 2e-5 degrees.
            let moved = motion.pose(1e-3, PIVOT).point(PIVOT + Vec3::Z) - (PIVOT + Vec3::Z);
            assert!(moved.length() < 1e-6, "{motion:?} {moved}");
        }
    }

    #[test]
    fn velocity_is_smooth() {
        let step = 1e-4;
        for (stem, at) in [
            ("shake", (|t| SHAKE_DEGREES * swing(t, SHAKE_FREQUENCY)) as fn(f64) -> f64),
            ("nod", |t| NOD_DEGREES * swing(t, NOD_FREQUENCY)),
            ("turn", |t| TURN_DEGREES * look(t)),
        ] {
            let worst = (-100..90_000)
                .map(|i| i as f64 * step)
                .map(|t| (at(t + step) - 2.0 * at(t) + at(t - step)) / (step * step))
                .fold(0.0, |worst: f64, acceleration| worst.max(acceleration.abs()));
            // The documented motions reach 35 (2 pi 1.2)^2 = 1990 degrees/s^2, and 2.1 times that while
            // the angle grows; a jump in velocity of 1 degree/s would read 10,000 here.
            assert!(worst < 4500.0, "{stem} {worst}");
        }
    }

    #[test]
    fn the_pivot_stays() {
        for motion in &BUILT_IN {
            for i in 0..100 {
                let moved = motion.pose(i as f64 * 0.05, PIVOT).point(PIVOT) - PIVOT;
                // Single precision at 1.5 m.
                assert!(moved.length() < 1e-6, "{motion:?}");
            }
        }
    }

    #[test]
    fn names_are_read_and_others_refused() {
        assert_eq!("still".parse::<Motion>().unwrap(), Motion::Still);
        assert_eq!("shake".parse::<Motion>().unwrap(), Motion::Shake);
        assert_eq!("nod".parse::<Motion>().unwrap(), Motion::Nod);
        assert_eq!("turn".parse::<Motion>().unwrap(), Motion::Turn);
        let error = "wobble".parse::<Motion>().unwrap_err().to_string();
        assert_eq!(error, "the motion is `wobble`, expected still, shake, nod or turn");
    }

    #[test]
    fn times_that_are_no_times_do_no_harm() {
        for motion in &BUILT_IN {
            for time in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
                assert!(motion.pose(time, PIVOT).rotation.is_finite());
            }
        }
    }
}
