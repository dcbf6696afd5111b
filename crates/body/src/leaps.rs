//! Jumps between two samples of a motion, which nobody marked: a cut that was baked, or a flip of a rig.

use glam::Vec3;
use strandline_base::math;

use crate::Pose;

/// Least rotation \[rad\] and way \[m\] of a jump, and the mean speeds \[rad/s\] and \[m/s\] above which they are one: heads
/// of persons turn by less than 20 rad/s and move at less than 10 m/s.
const LEAST_TURN: f32 = std::f32::consts::FRAC_PI_3;
const LEAST_WAY: f32 = 0.5;
const TURN_SPEED: f64 = 40.0;
const WAY_SPEED: f64 = 25.0;

/// The way of a head between two times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leap {
    /// Distance between the places of a point of the head \[m\].
    pub way: f32,
    /// Angle between its rotations \[rad\], 0 to half a turn.
    pub turn: f32,
}

impl Leap {
    /// The way between two poses of a head (`world_from_head`). `place` \[m\], head space, lies on the head: where that is far
    /// from the origin of its file, a small turn about the neck moves the origin by metres.
    pub fn new(from: &Pose, to: &Pose, place: Vec3) -> Self {
        let way = from.point(place).distance(to.point(place));
        let turn = 2.0 * math::asin((from.rotation.conjugate() * to.rotation).xyz().length().min(1.0));
        Self { way, turn }
    }

    /// True where no head of a person moves so far in `seconds`: by more than 60 degrees at more than 40 rad/s, or by more
    /// than 0.5 m at more than 25 m/s.
    pub fn is_jump(&self, seconds: f64) -> bool {
        let is_turn = self.turn > LEAST_TURN && f64::from(self.turn) > TURN_SPEED * seconds;
        is_turn || self.way > LEAST_WAY && f64::from(self.way) > WAY_SPEED * seconds
    }
}

/// Spans of a motion \[s\] between two samples that are a jump apart, rising: the earlier sample is held through the span.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Leaps(Vec<[f64; 2]>);

impl Leaps {
    /// The spans among `spans` \[s\], in any order, whose ends are a jump apart, however fast the motion is played. `pose`
    /// gives the head at a time of the motion, and `place` lies on it.
    pub fn find(spans: Vec<[f64; 2]>, place: Vec3, mut pose: impl FnMut(f64) -> Pose) -> Self {
        let mut spans = spans;
        spans.sort_by(|one, other| one[0].total_cmp(&other[0]).then(one[1].total_cmp(&other[1])));
        spans.dedup();
        let mut found: Vec<[f64; 2]> = Vec::new();
        let mut last: Option<(f64, Pose)> = None;
        for [from, to] in spans {
            let start = match last {
                Some((time, pose)) if time == from => pose,
                _ => pose(from),
            };
            let end = pose(to);
            last = Some((to, end));
            let is_apart = Leap::new(&start, &end, place).is_jump(to - from);
            if is_apart && found.last().is_none_or(|[_, before]| *before <= from) {
                found.push([from, to]);
            }
        }
        Self(found)
    }

    /// True without jumps.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Pairs of spans \[s\] of which the second begins where the first ends.
    pub fn chained(&self) -> impl Iterator<Item = [[f64; 2]; 2]> {
        let pairs = self.0.windows(2).map(|pair| [pair[0], pair[1]]);
        pairs.filter(|[one, other]| one[1] == other[0])
    }

    /// True where a jump ends with the motion, at `end` \[s\]: it goes on to the beginning of the next round.
    pub fn are_at_end(&self, end: f64) -> bool {
        self.0.last().is_some_and(|[_, to]| *to >= end)
    }

    /// The time of the motion \[s\] that counts at a time of it: the beginning of a span within it.
    pub fn held(&self, time: f64) -> f64 {
        let next = self.0.partition_point(|[from, _]| *from < time);
        match self.0[..next].last() {
            Some([from, to]) if time < *to => *from,
            _ => time,
        }
    }

    /// Number of jumps up to a time \[s\]; of a motion that has gone round `rounds` times those of all rounds.
    pub fn passed(&self, time: f64, rounds: f64) -> i64 {
        let rounds = if rounds.is_finite() { rounds as i64 } else { 0 };
        let all = rounds.saturating_mul(self.0.len() as i64);
        all.saturating_add(self.0.partition_point(|[_, to]| *to <= time) as i64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned(degrees: f32) -> Pose {
        Pose::rotation_about(Vec3::Y, math::rotation(Vec3::X, degrees.to_radians()))
    }

    #[test]
    fn a_fast_turn_of_a_person_is_no_jump() {
        // A shaken head is said to turn by up to 20 rad/s: 48 degrees between two samples of 24 in a second.
        for (degrees, rate, expected) in [
            (48.0, 24.0, false),
            (90.0, 24.0, false),
            (100.0, 24.0, true),
            (180.0, 24.0, true),
            (180.0, 12.0, false),
            (59.0, 120.0, false),
            (61.0, 120.0, true),
        ] {
            let leap = Leap::new(&turned(0.0), &turned(degrees), Vec3::Y);
            assert_eq!(leap.is_jump(1.0 / rate), expected, "{degrees} degrees in 1/{rate} s");
            let spans =
                Leaps::find(vec![[0.0, 1.0 / rate]], Vec3::Y, |time| turned(degrees * (time * rate) as f32));
            assert_eq!(!spans.is_empty(), expected, "{degrees} degrees in 1/{rate} s");
        }
        let moved = |way: f32| Pose { translation: Vec3::X * way, ..Pose::IDENTITY };
        let is_jump = |way: f32| Leap::new(&moved(0.0), &moved(way), Vec3::Y).is_jump(1.0 / 24.0);
        assert!(!is_jump(1.0) && is_jump(1.1), "24 and 26.4 m/s");
    }

    #[test]
    fn the_sample_before_a_jump_is_held() {
        let at = |time: f64| turned(if time >= 0.25 { 180.0 } else { 0.0 });
        let spans = || vec![[0.25, 0.5], [0.0, 0.05], [0.2, 0.25], [0.2, 0.25], [0.05, 0.2]];
        let leaps = Leaps::find(spans(), Vec3::Y, at);
        assert_eq!(leaps, Leaps(vec![[0.2, 0.25]]));
        for (time, held) in [(-1.0, -1.0), (0.2, 0.2), (0.21, 0.2), (0.249, 0.2), (0.25, 0.25), (0.3, 0.3)] {
            assert_eq!(leaps.held(time), held);
        }
        assert_eq!([0.2, 0.249, 0.25, 9.0].map(|time| leaps.passed(time, 0.0)), [0, 0, 1, 1]);
        assert!(leaps.are_at_end(0.25) && !leaps.are_at_end(0.3));
        assert_eq!([leaps.passed(0.0, 3.0), leaps.passed(0.3, -1.0)], [3, 0]);
    }
}
