//! Random numbers that depend on nothing but what they are for.

/// A well-mixed number from any number: the output function of a PCG generator \[ONeill2014\].
#[inline]
pub(crate) fn hash(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// A number for a pair: `hash` chained, so that (a, b) and (b, a) differ.
#[inline]
pub(crate) fn hash_pair(first: u32, second: u32) -> u32 {
    hash(hash(first).wrapping_add(second))
}

/// 0 to 1, 1 excluded, from 24 bits.
#[inline]
pub(crate) fn unit(hash: u32) -> f32 {
    (hash >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// A stream of numbers from a seed.
#[derive(Clone, Copy)]
pub(crate) struct Random(u32);

impl Random {
    pub(crate) fn new(seed: u32) -> Self {
        Self(hash(seed))
    }

    /// The next number, 0 to 1, 1 excluded.
    #[inline]
    pub(crate) fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9);
        unit(hash(self.0))
    }
}

/// sin(2 pi turns) by a parabola refined once; the error is below 1.2e-3.
#[inline]
pub(crate) fn sine(turns: f32) -> f32 {
    let phase = turns - (turns + 0.5).floor();
    let parabola = 8.0 * phase - 16.0 * phase * phase.abs();
    0.775 * parabola + 0.225 * parabola * parabola.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_spread_evenly() {
        let mut random = Random::new(7);
        let mut counts = [0u32; 16];
        for _ in 0..16_000 {
            counts[(random.unit() * 16.0) as usize] += 1;
        }
        // 1,000 expected with a deviation of 31; five of them never happen by chance.
        assert!(counts.iter().all(|&count| count.abs_diff(1000) < 155), "{counts:?}");
    }

    #[test]
    fn sine_is_close() {
        for step in -400..400 {
            let turns = step as f32 * 0.0137;
            let exact = (f64::from(turns) * std::f64::consts::TAU).sin() as f32;
            assert!((sine(turns) - exact).abs() < 1.2e-3, "{turns}");
        }
    }
}
