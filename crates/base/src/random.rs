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

/// Spreads the bits of a number, so that neighbouring seeds have nothing in common
/// (the finalizer of SplitMix64 \[Steele2014\]).
fn mix(number: u64) -> u64 {
    let mut bits = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
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
}
