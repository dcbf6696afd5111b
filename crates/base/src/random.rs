//! Random numbers with the same bits everywhere.

/// A small generator of random numbers: PCG-XSH-RR with 64 bits of state \[ONeill2014\].
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
    increment: u64,
}

impl Random {
    /// A generator for a seed and a stream; different streams of a seed are independent, so that
    /// a strand can draw the same numbers whichever thread grows it.
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut random = Self { state: 0, increment: (mix(stream) << 1) | 1 };
        random.bits();
        random.state = random.state.wrapping_add(mix(seed));
        random.bits();
        random
    }

    /// 32 random bits.
    #[inline]
    pub fn bits(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(self.increment);
        let shifted = (((old >> 18) ^ old) >> 27) as u32;
        shifted.rotate_right((old >> 59) as u32)
    }

    /// A number from 0 up to, and without, 1.
    #[inline]
    pub fn unit(&mut self) -> f32 {
        (self.bits() >> 8) as f32 / (1u32 << 24) as f32
    }

    /// A number from -1 up to, and without, 1.
    #[inline]
    pub fn signed(&mut self) -> f32 {
        2.0 * self.unit() - 1.0
    }
}

/// Spreads the bits of a number, so that neighbouring seeds are unrelated
/// (the finalizer of SplitMix64 \[Steele2014\]).
fn mix(number: u64) -> u64 {
    let mut bits = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

/// A well-mixed number from any number: the output function of a PCG generator \[ONeill2014\].
#[inline]
pub fn hash(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// A number for a pair: `hash` chained, so that (a, b) and (b, a) differ.
#[inline]
pub fn hash_pair(first: u32, second: u32) -> u32 {
    hash(hash(first).wrapping_add(second))
}

/// 0 to 1, 1 excluded, from 24 bits.
#[inline]
pub fn unit(hash: u32) -> f32 {
    (hash >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// A stream of hashes from a seed, as shaders have it too: cheaper than [`Random`], and of 32 bits.
#[derive(Clone, Copy, Debug)]
pub struct HashStream(u32);

impl HashStream {
    /// The stream of a seed.
    #[inline]
    pub fn new(seed: u32) -> Self {
        Self(hash(seed))
    }

    /// The next number, 0 to 1, 1 excluded.
    #[inline]
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9);
        unit(hash(self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_even_and_streams_differ() {
        let mut random = Random::new(7, 3);
        let mean = (0..10_000).map(|_| random.unit()).sum::<f32>() / 10_000.0;
        // The standard error is 0.29 / 100; five of them.
        assert!((mean - 0.5).abs() < 0.015);
        assert_ne!(Random::new(7, 3).bits(), Random::new(7, 4).bits());
        assert_ne!(Random::new(7, 3).bits(), Random::new(8, 3).bits());
        assert_eq!(Random::new(7, 3).bits(), Random::new(7, 3).bits());
    }

    #[test]
    fn units_are_spread_evenly() {
        let mut random = HashStream::new(7);
        let mut counts = [0u32; 16];
        for _ in 0..16_000 {
            counts[(random.unit() * 16.0) as usize] += 1;
        }
        // 1,000 expected with a deviation of 31; five of them never happen by chance.
        assert!(counts.iter().all(|&count| count.abs_diff(1000) < 155), "{counts:?}");
    }
}
