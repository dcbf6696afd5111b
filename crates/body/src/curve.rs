//! Curves through keys: values over time that never leave the span between two keys.

use strandline_base::choices;

use crate::BodyError;

choices! {
    /// The way from a key to the next one.
    pub enum Interpolation as "interpolation" {
        /// Smooth in velocity and never beyond either key; at rest where the value turns or is held.
        Smooth = "smooth",
        /// At one velocity from key to key.
        Linear = "linear",
        /// The value of the key until the next one.
        Hold = "hold",
    }
    default Smooth
}

/// A value of `N` components at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key<const N: usize> {
    /// Time \[s\].
    pub time: f64,
    /// The components, in any unit.
    pub value: [f64; N],
    /// The way to the next key.
    pub interpolation: Interpolation,
    /// Marks a jump: the value before is held until this key, whatever its interpolation says.
    pub is_cut: bool,
}

/// Values over time through keys, each component by itself.
///
/// Smooth spans are monotone cubics \[Fritsch1980\]: between two keys a component never leaves the range of
/// their two values, so equal keys hold. The first and the last value are held outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve<const N: usize> {
    keys: Vec<Key<N>>,
}

impl<const N: usize> Curve<N> {
    /// A curve through keys.
    ///
    /// # Errors
    /// There must be at least one key; times and values must be finite, and times rise from each to the next.
    pub fn new(keys: Vec<Key<N>>) -> Result<Self, BodyError> {
        if keys.is_empty() {
            return Err(BodyError::Value {
                what: "the list of keyframes",
                found: "empty".into(),
                expected: "at least one keyframe",
            });
        }
        let mut before = f64::NEG_INFINITY;
        for (index, key) in keys.iter().enumerate() {
            let (found, expected) = if !key.time.is_finite() {
                (format!("the time {}", key.time), "a finite time [s]")
            } else if key.time <= before {
                (
                    format!("the time {} s after one at {before} s", key.time),
                    "times that rise from each to the next",
                )
            } else if let Some(value) = key.value.iter().find(|value| !value.is_finite()) {
                (format!("the value {value}"), "finite numbers")
            } else {
                before = key.time;
                continue;
            };
            return Err(BodyError::Keyframe { index, found, expected });
        }
        Ok(Self { keys })
    }

    /// The value at a time \[s\]; at a key exactly that of the key.
    pub fn at(&self, time: f64) -> [f64; N] {
        let next = self.keys.partition_point(|key| key.time <= time);
        let (Some(before), Some(start)) = (next.checked_sub(1), self.keys.get(next.saturating_sub(1))) else {
            return self.keys[0].value;
        };
        let Some(end) = self.keys.get(next) else { return start.value };
        let span = end.time - start.time;
        let share = (time - start.time) / span;
        match self.way(before) {
            Some(Interpolation::Smooth) => std::array::from_fn(|component| {
                let slope = |key| span * self.slope(key, component);
                let ends = [start.value[component], end.value[component]];
                let between = hermite([ends[0], slope(before), ends[1], slope(next)], share);
                // Rounding alone could leave the range.
                between.clamp(ends[0].min(ends[1]), ends[0].max(ends[1]))
            }),
            Some(Interpolation::Linear) => std::array::from_fn(|component| {
                let [from, to] = [start.value[component], end.value[component]];
                from + (to - from) * share
            }),
            Some(Interpolation::Hold) | None => start.value,
        }
    }

    /// Tells a jump of the curve: a key marked as a cut later than `after` and not later than `until` \[s\].
    pub fn is_cut_between(&self, after: f64, until: f64) -> bool {
        let mut within = self.keys.iter().skip(1).filter(|key| after < key.time && key.time <= until);
        within.any(|key| key.is_cut)
    }

    /// Number of jumps up to a time \[s\]; `None` of a curve without any.
    pub fn cuts_until(&self, time: f64) -> Option<i64> {
        let cuts = || self.keys.iter().skip(1).filter(|key| key.is_cut);
        (cuts().count() > 0).then(|| cuts().filter(|key| key.time <= time).count() as i64)
    }

    /// The way from a key to the next; `None` beyond both ends.
    fn way(&self, key: usize) -> Option<Interpolation> {
        let next = self.keys.get(key.checked_add(1)?)?;
        Some(if next.is_cut { Interpolation::Hold } else { self.keys[key].interpolation })
    }

    /// The mean rate of a component from a key to the next.
    fn rate(&self, key: usize, component: usize) -> f64 {
        let [start, end] = [&self.keys[key], &self.keys[key + 1]];
        (end.value[component] - start.value[component]) / (end.time - start.time)
    }

    /// The rate of a component at a key, as smooth spans beside it see it; 0 where a span holds or none is.
    fn slope(&self, key: usize, component: usize) -> f64 {
        use Interpolation::{Linear, Smooth};
        let before = key.checked_sub(1);
        let ways = [before.and_then(|before| self.way(before)), self.way(key)];
        let Some(before) = before else { return 0.0 };
        let rates = || [before, key].map(|span| self.rate(span, component));
        match ways {
            [Some(Smooth), Some(Smooth)] => {
                let spans = [before, key].map(|span| self.keys[span + 1].time - self.keys[span].time);
                monotone(rates(), spans)
            }
            [Some(Linear), Some(Smooth)] => limited(rates()[0], rates()[1]),
            [Some(Smooth), Some(Linear)] => limited(rates()[1], rates()[0]),
            _ => 0.0,
        }
    }
}

/// The weighted harmonic mean of two rates, 0 where the value turns or stands: it keeps cubics of uneven spans
/// monotone. // [Fritsch1980], the mean as in scipy's `PchipInterpolator`
fn monotone([before, after]: [f64; 2], [span_before, span_after]: [f64; 2]) -> f64 {
    if before * after <= 0.0 {
        return 0.0;
    }
    let weights = [2.0 * span_after + span_before, span_after + 2.0 * span_before];
    (weights[0] + weights[1]) / (weights[0] / before + weights[1] / after)
}

/// The rate of a straight neighbour as far as a span of a mean rate stays monotone. // [Fritsch1980]
fn limited(straight: f64, own: f64) -> f64 {
    let most = 3.0 * own;
    straight.clamp(most.min(0.0), most.max(0.0))
}

/// The cubic with given values and slopes (value, slope, value, slope) at 0 and 1.
fn hermite([start, leave, end, arrive]: [f64; 4], share: f64) -> f64 {
    let (t, t2) = (share, share * share);
    let t3 = t2 * t;
    start * (2.0 * t3 - 3.0 * t2 + 1.0)
        + leave * (t3 - 2.0 * t2 + t)
        + end * (3.0 * t2 - 2.0 * t3)
        + arrive * (t3 - t2)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn key(time: f64, value: f64, interpolation: Interpolation) -> Key<1> {
        Key { time, value: [value], interpolation, is_cut: false }
    }

    fn smooth(keys: &[(f64, f64)]) -> Curve<1> {
        let keys = keys.iter().map(|(time, value)| key(*time, *value, Interpolation::Smooth));
        Curve::new(keys.collect()).unwrap()
    }

    #[test]
    fn equal_keys_hold_beside_a_fast_turn() {
        let curve = smooth(&[(0.0, 0.0), (1.0, 0.0), (1.2, 60.0), (4.0, 60.0)]);
        for i in 0..=400 {
            let time = f64::from(i) * 0.01;
            let [value] = curve.at(time);
            if time <= 1.0 {
                assert_eq!(value, 0.0, "{time}");
            } else if time >= 1.2 {
                assert_eq!(value, 60.0, "{time}");
            }
        }
        assert!((curve.at(1.1)[0] - 30.0).abs() < 1e-9, "half way at half the time");
    }

    proptest! {
        /// Uneven spans, jumps and holds: no value leaves the range of its two keys.
        #[test]
        fn a_smooth_curve_never_overshoots(
            spans in prop::collection::vec((1e-4..3.0_f64, prop_oneof![Just(0.0), -500.0..500.0_f64]), 2..8),
        ) {
            let mut time = 0.0;
            let mut keys = vec![(0.0, 1.0)];
            for (span, change) in spans {
                time += span;
                keys.push((time, keys[keys.len() - 1].1 + change));
            }
            let curve = smooth(&keys);
            for pair in keys.windows(2) {
                let [(start, from), (end, to)] = [pair[0], pair[1]];
                let mut last = from;
                for i in 0..=50 {
                    let [value] = curve.at((start + (end - start) * f64::from(i) / 50.0).min(end));
                    prop_assert!((from.min(to)..=from.max(to)).contains(&value), "{value} of {from}..{to}");
                    // The rounding of a cubic of this size.
                    let way = (value - last) * (to - from).signum();
                    prop_assert!(way >= -1e-10, "turns back by {way}");
                    last = value;
                }
            }
        }
    }

    #[test]
    fn even_rates_stay_even_at_uneven_times() {
        let curve = smooth(&[0.0, 1.0, 1.5, 3.0, 3.2, 4.0].map(|time| (time, 40.0 * time)));
        for i in 0..=44 {
            // From the second to the last but one key every slope is the chord's.
            let time = 1.0 + f64::from(i) * 0.05;
            assert!((curve.at(time)[0] - 40.0 * time).abs() < 1e-10, "{time}");
        }
    }

    #[test]
    fn the_rate_is_continuous_at_smooth_and_straight_keys() {
        use Interpolation::{Linear, Smooth};
        let keys = [
            key(0.0, 0.0, Linear),
            key(1.0, 1.0, Smooth),
            key(1.5, 2.0, Smooth),
            key(3.0, 3.0, Smooth),
            key(4.0, 8.0, Linear),
            key(5.0, 12.0, Smooth),
        ];
        let curve = Curve::new(keys.to_vec()).unwrap();
        let step = 1e-6;
        for key in &keys[1..5] {
            let [here] = curve.at(key.time);
            let rates = [-step, step].map(|step| (curve.at(key.time + step)[0] - here) / step);
            // The slope of the smooth span into 4 s may reach three times its mean of 5: 4 is less.
            assert!((rates[0] - rates[1]).abs() < 1e-3, "at {} s: {rates:?}", key.time);
            assert!(rates[0] > 0.5, "the curve does not stop at its keys: {rates:?}");
        }
        // The straight neighbour of a slow span is followed as far as the span stays monotone.
        let curve = Curve::new(vec![key(0.0, 0.0, Linear), key(1.0, 9.0, Smooth), key(2.0, 10.0, Smooth)]);
        let rate = (curve.unwrap().at(1.0 + step)[0] - 9.0) / step;
        assert!((rate - 3.0).abs() < 1e-3, "{rate}");
    }

    #[test]
    fn linear_hold_and_cut_are_as_documented() {
        use Interpolation::{Hold, Linear, Smooth};
        let mut keys =
            vec![key(0.0, 0.0, Linear), key(2.0, 8.0, Hold), key(3.0, -1.0, Smooth), key(4.0, 5.0, Smooth)];
        keys[3].is_cut = true;
        let curve = Curve::new(keys).unwrap();
        let values = [-1.0, 0.5, 1.0, 2.0, 2.999, 3.0, 3.999, 4.0, 9.0].map(|time| curve.at(time)[0]);
        assert_eq!(values, [0.0, 2.0, 4.0, 8.0, 8.0, -1.0, -1.0, 5.0, 5.0]);
        let cuts = [(3.0, 3.9), (3.9, 4.0), (4.0, 5.0), (0.0, 9.0)];
        assert_eq!(cuts.map(|(after, until)| curve.is_cut_between(after, until)), [false, true, false, true]);
    }

    #[test]
    fn every_time_has_a_value() {
        let curve = smooth(&[(0.0, 1.0), (1.0, 2.0)]);
        let values = [f64::NAN, f64::NEG_INFINITY, f64::INFINITY].map(|time| curve.at(time)[0]);
        assert_eq!(values, [1.0, 1.0, 2.0]);
    }
}
