//! Parallel loops: rayon's, or loops of one thread under the same names where the feature `threads` is off, as in a
//! browser page. Results have the same bits, as they do for any number of threads.

pub mod serial;

#[cfg(feature = "threads")]
mod threads;

#[cfg(feature = "threads")]
pub use rayon::{current_num_threads, join, prelude};
#[cfg(not(feature = "threads"))]
pub use serial::{Pool, awake, current_num_threads, join, prelude};
#[cfg(feature = "threads")]
pub use threads::{Pool, awake};

#[cfg(all(test, feature = "threads"))]
mod tests {
    /// A little of everything, with the loops of a prelude.
    macro_rules! work {
        ($($prelude:tt)*) => {{
            use $($prelude)*::*;
            let numbers: Vec<u64> = (0..1000_u64).into_par_iter().filter(|number| number % 3 != 0).collect();
            let mut sums = vec![0; numbers.len().div_ceil(7)];
            let chunks = sums.par_iter_mut().zip_eq(numbers.par_chunks(7)).with_min_len(2);
            chunks.for_each(|(sum, chunk)| *sum = chunk.iter().sum());
            let most = sums.par_iter().map(|sum| *sum).reduce(|| 0, u64::max);
            let (even, odd): (Vec<u64>, Vec<u64>) = sums.par_iter().map(|sum| (sum / 2, sum % 2)).unzip();
            sums.par_chunks_exact_mut(2).enumerate().for_each(|(index, pair)| pair[0] += index as u64);
            sums.par_chunks_mut(3).for_each_init(Vec::new, |seen, chunk| {
                seen.push(chunk[0]);
                chunk[0] += 1;
            });
            sums.par_extend((0..9_u64).into_par_iter().filter_map(|number| number.checked_sub(4)));
            sums.par_sort_unstable();
            sums.par_sort_by_cached_key(|sum| sum % 10);
            (numbers, sums, most, even, odd)
        }};
    }

    #[test]
    fn one_thread_gives_what_many_give() {
        assert_eq!(work!(rayon::prelude), work!(super::serial::prelude));
        assert_eq!(super::serial::join(|| 1, || 2), rayon::join(|| 1, || 2));
        assert_eq!(super::serial::awake(|| 3), super::awake(|| 3));
    }

    #[test]
    fn loops_of_threads_that_are_kept_awake_give_what_they_give() {
        use rayon::prelude::*;
        let sums = || -> Vec<u32> {
            let sum = |last: u32| (0..last).into_par_iter().with_min_len(1).sum();
            (0..200).map(sum).collect()
        };
        for threads in [1, 2, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            assert_eq!(pool.install(|| super::awake(sums)), sums());
            // Some inside others, and work that fails.
            assert_eq!(pool.install(|| super::awake(|| super::awake(sums).len())), 200);
            let fails = || pool.install(|| super::awake(|| panic!("of the test")));
            assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(fails)).is_err());
            assert_eq!(pool.install(|| super::awake(sums)), sums());
        }
        assert_eq!(super::awake(sums), sums());
    }
}
