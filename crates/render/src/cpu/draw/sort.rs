//! Front-to-back order.

/// Bits of a key sorted in one pass: 4,096 counters fit the first-level cache.
const DIGIT_BITS: u32 = 12;
/// Passes: keys have 24 bits.
const PASSES: u32 = 2;
/// Largest key.
pub const MAX_KEY: u32 = (1 << (DIGIT_BITS * PASSES)) - 1;

/// Joins a key of at most [`MAX_KEY`] and its payload, key first.
pub fn keyed(key: u32, payload: u32) -> u64 {
    u64::from(key) << 32 | u64::from(payload)
}

/// Payload of a keyed item.
pub fn payload(item: u64) -> u32 {
    item as u32
}

/// Sorts items by key, smallest first; equal keys keep their order. `spare` is working memory.
pub fn sort_by_key(items: &mut Vec<u64>, spare: &mut Vec<u64>) {
    spare.clear();
    spare.resize(items.len(), 0);
    for pass in 0..PASSES {
        let digit = |item: u64| (item >> (32 + pass * DIGIT_BITS)) as usize & ((1 << DIGIT_BITS) - 1);
        let mut starts = [0_u32; 1 << DIGIT_BITS];
        items.iter().for_each(|&item| starts[digit(item)] += 1);
        let mut total = 0;
        for start in &mut starts {
            (*start, total) = (total, total + *start);
        }
        for &item in items.iter() {
            let slot = &mut starts[digit(item)];
            spare[*slot as usize] = item;
            *slot += 1;
        }
        std::mem::swap(items, spare);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_agrees_with_a_stable_sort() {
        let mut random = strandline_base::Random::new(1, 0);
        let mut items: Vec<u64> = (0..20_000)
            .map(|index| {
                let state = random.bits();
                // A narrow range of keys makes many of them equal.
                let key = if index % 2 == 0 { state >> 8 } else { state >> 22 };
                keyed(key.min(MAX_KEY), index)
            })
            .collect();
        let mut expected = items.clone();
        expected.sort_by_key(|item| item >> 32);
        sort_by_key(&mut items, &mut Vec::new());
        assert_eq!(items, expected);
    }
}
