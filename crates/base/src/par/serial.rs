//! Loops with the names of rayon's on the thread of the caller, where the system has no others. They hold what the crates use.

#![cfg_attr(not(target_family = "wasm"), allow(dead_code))] // native programs have threads; tests compare the two

/// Runs the loops of one piece of work, on the thread of the caller.
#[derive(Debug)]
pub struct Pool;

impl Pool {
    /// No thread; the name is for those of other systems.
    pub fn new(_: &'static str) -> Self {
        Self
    }

    /// Runs work.
    pub fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        work()
    }
}

/// Runs work; there are no threads that could sleep meanwhile.
pub fn awake<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    work()
}

/// One, that of the caller.
pub fn current_num_threads() -> usize {
    1
}

/// Does one thing after the other.
pub fn join<A, B>(one: impl FnOnce() -> A, other: impl FnOnce() -> B) -> (A, B) {
    (one(), other())
}

/// Traits of the loops.
pub mod prelude {
    pub use super::{
        IntoParallelIterator, ParallelExtend, ParallelIterator, ParallelSlice, ParallelSliceMut,
    };
}

/// A plain iterator that has the methods of parallel ones, and none of its own that could be meant in their place.
#[derive(Debug)]
pub struct Serial<I>(I);

impl<I: Iterator> IntoIterator for Serial<I> {
    type Item = I::Item;
    type IntoIter = I;

    fn into_iter(self) -> I {
        self.0
    }
}

impl<I: Iterator> ParallelIterator for Serial<I> {}

/// Whatever can be iterated over.
pub trait IntoParallelIterator: IntoIterator + Sized {
    /// Iterates over its items.
    fn into_par_iter(self) -> Serial<Self::IntoIter> {
        Serial(self.into_iter())
    }
}

impl<T: IntoIterator> IntoParallelIterator for T {}

/// Methods of an iteration, in the order of its items.
pub trait ParallelIterator: IntoIterator + Sized {
    /// Leaves the iteration as it is: nothing is shared out.
    fn with_min_len(self, _: usize) -> Serial<Self::IntoIter> {
        Serial(self.into_iter())
    }

    /// Results of a function of each item.
    fn map<R>(self, function: impl FnMut(Self::Item) -> R) -> Serial<impl Iterator<Item = R>> {
        Serial(self.into_iter().map(function))
    }

    /// Results of a function of one scratch value and each item.
    fn map_init<S, R>(
        self,
        scratch: impl FnOnce() -> S,
        mut function: impl FnMut(&mut S, Self::Item) -> R,
    ) -> Serial<impl Iterator<Item = R>> {
        let mut scratch = scratch();
        Serial(self.into_iter().map(move |item| function(&mut scratch, item)))
    }

    /// Items of every sequence that a function makes of an item.
    fn flat_map_iter<S: IntoIterator>(
        self,
        function: impl FnMut(Self::Item) -> S,
    ) -> Serial<impl Iterator<Item = S::Item>> {
        Serial(self.into_iter().flat_map(function))
    }

    /// Pairs with the items of another iteration, as far as the shorter one goes.
    fn zip<O: IntoIterator>(self, other: O) -> Serial<std::iter::Zip<Self::IntoIter, O::IntoIter>> {
        Serial(self.into_iter().zip(other))
    }

    /// Pairs with the items of another iteration of the same length.
    ///
    /// # Panics
    /// The lengths differ.
    fn zip_eq<O: IntoIterator>(self, other: O) -> Serial<std::iter::Zip<Self::IntoIter, O::IntoIter>> {
        let (one, other) = (self.into_iter(), other.into_iter());
        assert_eq!(one.size_hint(), other.size_hint(), "iterators must have the same length");
        Serial(one.zip(other))
    }

    /// Pairs of places and items.
    fn enumerate(self) -> Serial<std::iter::Enumerate<Self::IntoIter>> {
        Serial(self.into_iter().enumerate())
    }

    /// Items that are wanted.
    fn filter(self, wanted: impl FnMut(&Self::Item) -> bool) -> Serial<impl Iterator<Item = Self::Item>> {
        Serial(self.into_iter().filter(wanted))
    }

    /// Results of a function that leaves items out.
    fn filter_map<R>(self, function: impl FnMut(Self::Item) -> Option<R>) -> Serial<impl Iterator<Item = R>> {
        Serial(self.into_iter().filter_map(function))
    }

    /// Copies of items that are referred to.
    fn copied<'a, T: 'a + Copy>(self) -> Serial<std::iter::Copied<Self::IntoIter>>
    where
        Self: IntoIterator<Item = &'a T>,
    {
        Serial(self.into_iter().copied())
    }

    /// Does something with each item.
    fn for_each(self, act: impl FnMut(Self::Item)) {
        self.into_iter().for_each(act);
    }

    /// Does something with one scratch value and each item.
    fn for_each_init<S>(self, scratch: impl FnOnce() -> S, mut act: impl FnMut(&mut S, Self::Item)) {
        let mut scratch = scratch();
        self.into_iter().for_each(|item| act(&mut scratch, item));
    }

    /// Items together.
    fn collect<C: FromIterator<Self::Item>>(self) -> C {
        self.into_iter().collect()
    }

    /// Replaces the elements of a vector by the items.
    fn collect_into_vec(self, target: &mut Vec<Self::Item>) {
        target.clear();
        target.extend(self);
    }

    /// Both parts of all pairs.
    fn unzip<A, B, C, D>(self) -> (C, D)
    where
        Self: IntoIterator<Item = (A, B)>,
        C: Default + Extend<A>,
        D: Default + Extend<B>,
    {
        self.into_iter().unzip()
    }

    /// Sum of all items.
    fn sum<S: std::iter::Sum<Self::Item>>(self) -> S {
        self.into_iter().sum()
    }

    /// All items combined, from a first one on.
    fn reduce(
        self,
        first: impl FnOnce() -> Self::Item,
        combine: impl FnMut(Self::Item, Self::Item) -> Self::Item,
    ) -> Self::Item {
        self.into_iter().fold(first(), combine)
    }

    /// True where every item is as wanted.
    fn all(self, wanted: impl FnMut(Self::Item) -> bool) -> bool {
        self.into_iter().all(wanted)
    }

    /// True where an item is as wanted.
    fn any(self, wanted: impl FnMut(Self::Item) -> bool) -> bool {
        self.into_iter().any(wanted)
    }

    /// The least item.
    fn min(self) -> Option<Self::Item>
    where
        Self::Item: Ord,
    {
        self.into_iter().min()
    }

    /// The greatest item.
    fn max(self) -> Option<Self::Item>
    where
        Self::Item: Ord,
    {
        self.into_iter().max()
    }
}

/// A collection that grows by the items of an iteration.
pub trait ParallelExtend<T> {
    /// Appends them.
    fn par_extend(&mut self, items: impl IntoIterator<Item = T>);
}

impl<T> ParallelExtend<T> for Vec<T> {
    fn par_extend(&mut self, items: impl IntoIterator<Item = T>) {
        self.extend(items);
    }
}

/// Iterations over a slice.
pub trait ParallelSlice<T> {
    /// Its elements.
    fn par_iter(&self) -> Serial<std::slice::Iter<'_, T>>;

    /// Pieces of so many elements, the last one of fewer.
    fn par_chunks(&self, count: usize) -> Serial<std::slice::Chunks<'_, T>>;

    /// Chunks of `count` elements, without the remainder.
    fn par_chunks_exact(&self, count: usize) -> Serial<std::slice::ChunksExact<'_, T>>;
}

impl<T> ParallelSlice<T> for [T] {
    fn par_iter(&self) -> Serial<std::slice::Iter<'_, T>> {
        Serial(self.iter())
    }

    fn par_chunks(&self, count: usize) -> Serial<std::slice::Chunks<'_, T>> {
        Serial(self.chunks(count))
    }

    fn par_chunks_exact(&self, count: usize) -> Serial<std::slice::ChunksExact<'_, T>> {
        Serial(self.chunks_exact(count))
    }
}

/// Iterations that change a slice.
pub trait ParallelSliceMut<T> {
    /// Its elements.
    fn par_iter_mut(&mut self) -> Serial<std::slice::IterMut<'_, T>>;

    /// Chunks of `count` elements, the last one of fewer.
    fn par_chunks_mut(&mut self, count: usize) -> Serial<std::slice::ChunksMut<'_, T>>;

    /// Pieces of so many elements, without those that are left.
    fn par_chunks_exact_mut(&mut self, count: usize) -> Serial<std::slice::ChunksExactMut<'_, T>>;

    /// Sorts it; equal elements keep no order.
    fn par_sort_unstable(&mut self)
    where
        T: Ord;

    /// Sorts it by keys, each computed once; equal elements keep their order.
    fn par_sort_by_cached_key<K: Ord>(&mut self, key: impl FnMut(&T) -> K);
}

impl<T> ParallelSliceMut<T> for [T] {
    fn par_iter_mut(&mut self) -> Serial<std::slice::IterMut<'_, T>> {
        Serial(self.iter_mut())
    }

    fn par_chunks_mut(&mut self, count: usize) -> Serial<std::slice::ChunksMut<'_, T>> {
        Serial(self.chunks_mut(count))
    }

    fn par_chunks_exact_mut(&mut self, count: usize) -> Serial<std::slice::ChunksExactMut<'_, T>> {
        Serial(self.chunks_exact_mut(count))
    }

    fn par_sort_unstable(&mut self)
    where
        T: Ord,
    {
        self.sort_unstable();
    }

    fn par_sort_by_cached_key<K: Ord>(&mut self, key: impl FnMut(&T) -> K) {
        self.sort_by_cached_key(key);
    }
}

#[cfg(test)]
mod tests {
    /// The same loops, by the traits that are in scope.
    macro_rules! loops {
        () => {{
            let numbers: Vec<u32> = (0..1000).into_par_iter().map(|number| number * number % 97).collect();
            let mut changed = numbers.clone();
            changed.par_chunks_mut(7).zip(numbers.par_chunks(7)).enumerate().for_each(
                |(index, (changed, old))| {
                    changed.iter_mut().zip(old).for_each(|(new, old)| *new = 2 * old + index as u32);
                },
            );
            changed.par_iter_mut().zip_eq(&numbers).for_each(|(one, other)| *one += other);
            changed.par_chunks_exact_mut(300).zip(numbers.par_chunks_exact(300)).for_each(|(one, other)| {
                one[0] = other[1];
            });
            let halves: Vec<u32> =
                numbers.par_iter().with_min_len(64).filter_map(|n| (n % 2 == 0).then_some(n / 2)).collect();
            let small: Vec<u32> = numbers.par_iter().copied().filter(|number| *number < 9).collect();
            let (least, most) = (numbers.par_iter().min().copied(), numbers.par_iter().max().copied());
            let sum: u32 = numbers.par_iter().sum();
            let highest = numbers.par_iter().map(|number| *number as f32).reduce(|| 0.0, f32::max);
            let (one, other): (Vec<u32>, Vec<bool>) =
                numbers.par_iter().map(|number| (*number, *number > 50)).unzip();
            let scaled: Vec<u32> =
                numbers.par_iter().map_init(|| 3, |three, number| *three * number).collect();
            let twice: Vec<u32> = numbers.par_iter().flat_map_iter(|number| [*number, 1]).collect();
            numbers.par_iter().for_each_init(Vec::new, |seen: &mut Vec<u32>, number| seen.push(*number));
            let mut target = vec![1; 5];
            numbers.par_iter().map(|number| number + 1).collect_into_vec(&mut target);
            target.par_extend((0..10).into_par_iter());
            let mut sorted = numbers.clone();
            sorted.par_sort_by_cached_key(|number| number % 10);
            let mut all = numbers.clone();
            all.par_sort_unstable();
            let first: Result<Vec<u32>, u32> =
                [1, 2, 3].par_iter().map(|n| if *n < 9 { Ok(*n) } else { Err(*n) }).collect();
            let lists = [numbers, changed, halves, small, one, scaled, twice, target, sorted, all];
            let (all, any) = (lists[0].par_iter().all(|n| *n < 97), lists[0].par_iter().any(|n| *n == 500));
            (lists, least, most, sum, highest, other, first, all, any)
        }};
    }

    #[test]
    fn plain_loops_give_what_those_of_threads_give() {
        let plain = {
            use crate::par::serial::prelude::*;
            loops!()
        };
        let shared = {
            use rayon::prelude::*;
            loops!()
        };
        assert_eq!(plain, shared);
        assert_eq!(crate::par::serial::join(|| 1, || 2), (1, 2));
    }

    #[test]
    #[should_panic(expected = "same length")]
    fn lists_of_other_lengths_are_refused() {
        use crate::par::serial::prelude::*;
        [1, 2].par_iter().zip_eq(&[1, 2, 3]).for_each(drop);
    }
}
