//! Values over time in a clip of a glTF file: samplers and their interpolation, in double precision.

use glam::{DQuat, DVec3, DVec4};
use strandline_base::math;

use crate::teleports::Teleports;

/// A third of the rotation \[rad\] and of the speed \[rad/s\] of a jump of the head, which up to three nodes make together.
const FAST_TURN: f64 = std::f64::consts::PI / 9.0;
const FAST: f64 = 40.0 / 3.0;
/// Time \[s\] between keys from which on no way between them is looked at: everything is held through a jump.
const SLOW: f64 = 0.2;
/// Share of the largest coordinate that is rounding.
const ROUNDING: f64 = 1e-4;

/// Property of a node that a track moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Property {
    Translation,
    Rotation,
    Scale,
    /// Weights of the morph targets of the node's mesh.
    Weights,
}

/// The way from key to key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    Step,
    Linear,
    /// Hermite splines: an in-tangent, a value and an out-tangent for each key.
    Cubic,
}

/// A property of a node over time.
#[derive(Clone, Debug)]
pub(super) struct Track {
    pub node: usize,
    pub property: Property,
    pub way: Way,
    /// Times of the keys \[s\], not falling; at least one.
    pub times: Vec<f64>,
    /// Numbers of all keys, shape `[key][part][component]`; cubic tracks have three parts.
    pub values: Vec<f32>,
    /// Components of a value.
    pub width: usize,
}

impl Track {
    /// Parts of a key.
    pub fn parts(way: Way) -> usize {
        if way == Way::Cubic { 3 } else { 1 }
    }

    /// One of the parts of a key.
    fn part(&self, key: usize, part: usize) -> &[f32] {
        let start = (key * Self::parts(self.way) + part) * self.width;
        &self.values[start..start + self.width]
    }

    /// The value itself of a key.
    pub fn value(&self, key: usize) -> &[f32] {
        self.part(key, usize::from(self.way == Way::Cubic))
    }

    /// Spans \[s\] between two keys of a rotation or a translation that are far apart: by more than 20 degrees at more than 13
    /// rad/s, or by a tenth of all the way from the first key. A node of several that together make a jump has such keys. Steps
    /// and keys of one time are cuts by themselves.
    pub fn fast_spans(&self) -> impl Iterator<Item = [f64; 2]> {
        let number = |key: usize, component: usize| f64::from(self.value(key)[component]);
        let place =
            move |key: usize| DVec3::from_array(std::array::from_fn(|component| number(key, component)));
        let of = |property: Property| self.property == property;
        let farthest = (0..if of(Property::Translation) { self.times.len() } else { 0 })
            .map(|key| place(key).distance(place(0)))
            .fold(0.0, f64::max);
        let largest = if farthest > 0.0 { place(0).length().max(farthest) } else { 0.0 };
        let is_cut = move |key: usize| self.times.get(key + 1) == Some(&self.times[key]);
        let keys = if self.way == Way::Step { 1..1 } else { 1..self.times.len() };
        keys.filter(move |key| !is_cut(*key)).filter_map(move |key| {
            let seconds = self.times[key] - self.times[key - 1];
            let is_fast = match self.property {
                Property::Rotation => {
                    let [from, to] = [key - 1, key].map(|key| rotation(self.value(key)));
                    let turn = 2.0 * math::acos(from.dot(to).abs().min(1.0));
                    turn > FAST_TURN && turn > FAST * seconds
                }
                Property::Translation => {
                    let way = place(key).distance(place(key - 1));
                    way > 0.1 * farthest && way > ROUNDING * largest && seconds < SLOW
                }
                Property::Scale | Property::Weights => false,
            };
            is_fast.then_some([self.times[key - 1], self.times[key]])
        })
    }

    /// Writes the value at a time \[s\]; the first and the last one are held outside, and that before a mark until it.
    // glTF 2.0 appendix C
    pub fn sample(&self, time: f64, teleports: &Teleports, into: &mut Vec<f64>) {
        let next = self.times.partition_point(|key| *key <= time);
        let key = next.saturating_sub(1);
        into.clear();
        let ends = self.times.get(next).filter(|_| next > 0).map(|end| [self.times[key], *end]);
        if let Some(is_after) = ends.and_then(|ends| teleports.is_after(ends, time)) {
            into.extend(self.value(if is_after { next } else { key }).iter().copied().map(f64::from));
            return;
        }
        if next == 0 || next == self.times.len() || self.way == Way::Step {
            into.extend(self.value(key).iter().copied().map(f64::from));
        } else {
            let span = self.times[next] - self.times[key];
            let share = (time - self.times[key]) / span;
            match self.way {
                Way::Linear if self.property == Property::Rotation => {
                    let [from, to] = [key, next].map(|key| rotation(self.value(key)));
                    into.extend(slerp(from, to, share).to_array());
                }
                Way::Linear | Way::Step => {
                    let pairs = self.value(key).iter().zip(self.value(next));
                    let between = |(from, to): (&f32, &f32)| {
                        f64::from(*from) + (f64::from(*to) - f64::from(*from)) * share
                    };
                    into.extend(pairs.map(between));
                }
                Way::Cubic => {
                    let parts = [(key, 1), (key, 2), (next, 1), (next, 0)];
                    let [start, leave, end, arrive] = parts.map(|(key, part)| self.part(key, part));
                    into.extend((0..self.width).map(|component| {
                        let of = |part: &[f32]| f64::from(part[component]);
                        hermite([of(start), span * of(leave), of(end), span * of(arrive)], share)
                    }));
                }
            }
        }
    }
}

/// The cubic with given values and slopes (value, slope, value, slope) at 0 and 1.
fn hermite([start, leave, end, arrive]: [f64; 4], share: f64) -> f64 {
    let square = share * share;
    let cube = square * share;
    start * (2.0 * cube - 3.0 * square + 1.0)
        + leave * (cube - 2.0 * square + share)
        + end * (3.0 * square - 2.0 * cube)
        + arrive * (cube - square)
}

/// A quaternion of four numbers.
fn rotation(numbers: &[f32]) -> DQuat {
    unit(DVec4::from_array(std::array::from_fn(|component| f64::from(numbers[component]))))
}

/// Four numbers as a rotation: of unit length, and the identity where they are none.
pub(super) fn unit(numbers: DVec4) -> DQuat {
    numbers.try_normalize().map_or(DQuat::IDENTITY, DQuat::from_vec4)
}

/// The rotation on the shorter path between two.
fn slerp(from: DQuat, to: DQuat, share: f64) -> DQuat {
    let (cosine, to) = match from.dot(to) {
        cosine if cosine < 0.0 => (-cosine, -to),
        cosine => (cosine, to),
    };
    // For small angles the sine is dominated by rounding.
    if cosine > 1.0 - 1e-9 {
        return (from * (1.0 - share) + to * share).normalize();
    }
    let angle = math::acos(cosine);
    (from * math::sin((1.0 - share) * angle) + to * math::sin(share * angle)) * (1.0 / math::sin(angle))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(track: &Track, time: f64) -> Vec<f64> {
        let mut value = Vec::new();
        track.sample(time, &Teleports::default(), &mut value);
        value
    }

    #[test]
    fn values_are_held_outside_and_follow_their_way_between() {
        let track = |way, values: &[f32]| Track {
            node: 0,
            property: Property::Weights,
            way,
            times: vec![1.0, 3.0],
            values: values.to_vec(),
            width: 1,
        };
        let linear = track(Way::Linear, &[2.0, 6.0]);
        assert_eq!(
            [0.0, 1.0, 1.5, 3.0, 9.0].map(|time| sampled(&linear, time)[0]),
            [2.0, 2.0, 3.0, 6.0, 6.0]
        );
        let step = track(Way::Step, &[2.0, 6.0]);
        assert_eq!([0.0, 2.9, 3.0].map(|time| sampled(&step, time)[0]), [2.0, 2.0, 6.0]);
        // Tangents count by the second: a straight line at 2 per second.
        let cubic = track(Way::Cubic, &[9.0, 2.0, 2.0, 2.0, 6.0, 9.0]);
        for time in [1.0, 1.3, 2.0, 2.7, 3.0] {
            assert!((sampled(&cubic, time)[0] - 2.0 * time).abs() < 1e-12, "{time}");
        }
    }

    #[test]
    fn keys_far_apart_are_found() {
        let half = std::f32::consts::FRAC_1_SQRT_2;
        let turns = Track {
            node: 0,
            property: Property::Rotation,
            way: Way::Linear,
            times: vec![0.0, 0.04, 0.08, 1.0],
            values: [
                [0.0, 0.0, 0.0, 1.0],
                [0.0, 0.1, 0.0, 0.995],
                [0.0, half, 0.0, -half],
                [0.0, 0.0, 0.0, 1.0],
            ]
            .concat(),
            width: 4,
        };
        assert_eq!(
            turns.fast_spans().collect::<Vec<_>>(),
            [[0.04, 0.08]],
            "12 degrees, and 90 in 0.9 s, are not"
        );
        let (property, width) = (Property::Translation, 3);
        let values = [[0.0; 3], [0.5, 0.0, 0.0], [9.0, 0.0, 0.0], [9.5, 0.0, 0.0]].concat();
        let mut moves = Track { property, width, values, ..turns };
        let spans = |track: &Track| track.fast_spans().collect::<Vec<_>>();
        assert_eq!(spans(&moves), [[0.04, 0.08]]);
        moves.way = Way::Step;
        assert!(spans(&moves).is_empty(), "a step is a cut by itself, and all else goes on");
        (moves.way, moves.times) = (Way::Linear, vec![0.0, 0.04, 3.04, 3.1]);
        assert!(spans(&moves).is_empty(), "a ride of three seconds");
        moves.times = vec![0.0, 0.04, 0.08, 0.08];
        assert!(spans(&moves).is_empty(), "two keys of one time are a cut by themselves");
        moves.times = vec![0.0, 0.04, 0.08, 1.0];
        moves.values = [[1.0_f32, 0.0, 0.0], [1.0 + 1e-7, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0; 3]].concat();
        moves.values.truncate(9);
        moves.times.truncate(3);
        assert!(spans(&moves).is_empty(), "rounding");
    }

    #[test]
    fn rotations_take_the_short_way_evenly() {
        let (half, turned) = (std::f32::consts::FRAC_1_SQRT_2, [0.0, 1.0, 0.0, 0.0]);
        let mut track = Track {
            node: 0,
            property: Property::Rotation,
            way: Way::Linear,
            times: vec![0.0, 1.0],
            values: [[0.0, 0.0, 0.0, 1.0], [0.0, -half, 0.0, -half]].concat(),
            width: 4,
        };
        // A quarter turn given by its negative: a third of it is 30 degrees.
        let third = sampled(&track, 1.0 / 3.0);
        let angle = 2.0 * third[1].atan2(third[3]).to_degrees();
        assert!((angle.abs() - 30.0).abs() < 1e-4, "{angle}");
        track.values[4..].copy_from_slice(&turned);
        let half_turn = sampled(&track, 0.5);
        assert!((half_turn[1] - f64::from(half)).abs() < 1e-7, "{half_turn:?}");
    }
}
