//! Loops of one thread under the names of rayon's.

use std::iter::{Enumerate, Filter, FilterMap, Map, Sum, Zip};

/// The traits that bring the loops.
pub mod prelude {
    pub use super::{IntoParallelIterator, ParallelExtend, ParallelIterator, ParallelSlice};
}

/// Threads that loops run on.
pub fn current_num_threads() -> usize {
    1
}

/// Runs both, in order.
pub fn join<A, B>(one: impl FnOnce() -> A, other: impl FnOnce() -> B) -> (A, B) {
    (one(), other())
}

/// Runs something: no thread falls asleep beside it.
pub fn awake<T>(work: impl FnOnce() -> T) -> T {
    work()
}

/// Threads of their own for one piece of work: here it runs on the thread of the caller.
#[derive(Debug)]
pub struct Pool;

impl Pool {
    /// No threads.
    pub fn new(_: &'static str) -> Self {
        Self
    }

    /// Runs something.
    pub fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        work()
    }
}

/// A loop over an iterator.
#[derive(Clone, Debug)]
pub struct Serial<I>(I);

impl<I: Iterator> IntoIterator for Serial<I> {
    type Item = I::Item;
    type IntoIter = I;

    fn into_iter(self) -> I {
        self.0
    }
}

/// Ranges of loops.
pub trait IntoParallelIterator: IntoIterator + Sized {
    /// The loop.
    fn into_par_iter(self) -> Serial<Self::IntoIter> {
        Serial(self.into_iter())
    }
}

impl<T: IntoIterator> IntoParallelIterator for T {}

/// Methods of loops, named as in rayon.
#[allow(missing_docs)]
pub trait ParallelIterator: IntoIterator + Sized {
    fn map<R, F: Fn(Self::Item) -> R>(self, each: F) -> Serial<Map<Self::IntoIter, F>> {
        Serial(self.into_iter().map(each))
    }

    fn map_init<T, R>(
        self,
        init: impl Fn() -> T,
        each: impl Fn(&mut T, Self::Item) -> R,
    ) -> Serial<impl Iterator<Item = R>> {
        let mut own = init();
        Serial(self.into_iter().map(move |item| each(&mut own, item)))
    }

    fn filter<F: Fn(&Self::Item) -> bool>(self, keep: F) -> Serial<Filter<Self::IntoIter, F>> {
        Serial(self.into_iter().filter(keep))
    }

    fn filter_map<R, F: Fn(Self::Item) -> Option<R>>(self, each: F) -> Serial<FilterMap<Self::IntoIter, F>> {
        Serial(self.into_iter().filter_map(each))
    }

    fn enumerate(self) -> Serial<Enumerate<Self::IntoIter>> {
        Serial(self.into_iter().enumerate())
    }

    fn zip<O: IntoIterator>(self, other: O) -> Serial<Zip<Self::IntoIter, O::IntoIter>> {
        Serial(self.into_iter().zip(other))
    }

    fn zip_eq<O: IntoIterator<IntoIter: ExactSizeIterator>>(
        self,
        other: O,
    ) -> Serial<Zip<Self::IntoIter, O::IntoIter>>
    where
        Self::IntoIter: ExactSizeIterator,
    {
        let (one, other) = (self.into_iter(), other.into_iter());
        assert_eq!(one.len(), other.len(), "both are as long");
        Serial(one.zip(other))
    }

    fn with_min_len(self, _: usize) -> Serial<Self::IntoIter> {
        Serial(self.into_iter())
    }

    fn for_each(self, each: impl Fn(Self::Item)) {
        self.into_iter().for_each(each);
    }

    fn for_each_init<T>(self, init: impl Fn() -> T, each: impl Fn(&mut T, Self::Item)) {
        let mut own = init();
        self.into_iter().for_each(|item| each(&mut own, item));
    }

    fn reduce(
        self,
        identity: impl Fn() -> Self::Item,
        join: impl Fn(Self::Item, Self::Item) -> Self::Item,
    ) -> Self::Item {
        self.into_iter().fold(identity(), join)
    }

    fn sum<S: Sum<Self::Item>>(self) -> S {
        self.into_iter().sum()
    }

    fn collect<C: FromIterator<Self::Item>>(self) -> C {
        self.into_iter().collect()
    }

    fn collect_into_vec(self, into: &mut Vec<Self::Item>) {
        into.clear();
        into.extend(self);
    }

    fn unzip<A, B, FromA: Default + Extend<A>, FromB: Default + Extend<B>>(self) -> (FromA, FromB)
    where
        Self::IntoIter: Iterator<Item = (A, B)>,
    {
        self.into_iter().unzip()
    }
}

impl<I: Iterator> ParallelIterator for Serial<I> {}

/// Loops over slices: see rayon's methods of the same names.
#[allow(missing_docs)]
pub trait ParallelSlice<T> {
    fn par_iter(&self) -> Serial<std::slice::Iter<'_, T>>;
    fn par_iter_mut(&mut self) -> Serial<std::slice::IterMut<'_, T>>;
    fn par_chunks(&self, size: usize) -> Serial<std::slice::Chunks<'_, T>>;
    fn par_chunks_mut(&mut self, size: usize) -> Serial<std::slice::ChunksMut<'_, T>>;
    fn par_chunks_exact(&self, size: usize) -> Serial<std::slice::ChunksExact<'_, T>>;
    fn par_chunks_exact_mut(&mut self, size: usize) -> Serial<std::slice::ChunksExactMut<'_, T>>;
    fn par_sort_unstable(&mut self)
    where
        T: Ord;
    fn par_sort_by_cached_key<K: Ord>(&mut self, key: impl Fn(&T) -> K);
}

impl<T> ParallelSlice<T> for [T] {
    fn par_iter(&self) -> Serial<std::slice::Iter<'_, T>> {
        Serial(self.iter())
    }

    fn par_iter_mut(&mut self) -> Serial<std::slice::IterMut<'_, T>> {
        Serial(self.iter_mut())
    }

    fn par_chunks(&self, size: usize) -> Serial<std::slice::Chunks<'_, T>> {
        Serial(self.chunks(size))
    }

    fn par_chunks_mut(&mut self, size: usize) -> Serial<std::slice::ChunksMut<'_, T>> {
        Serial(self.chunks_mut(size))
    }

    fn par_chunks_exact(&self, size: usize) -> Serial<std::slice::ChunksExact<'_, T>> {
        Serial(self.chunks_exact(size))
    }

    fn par_chunks_exact_mut(&mut self, size: usize) -> Serial<std::slice::ChunksExactMut<'_, T>> {
        Serial(self.chunks_exact_mut(size))
    }

    fn par_sort_unstable(&mut self)
    where
        T: Ord,
    {
        self.sort_unstable();
    }

    fn par_sort_by_cached_key<K: Ord>(&mut self, key: impl Fn(&T) -> K) {
        self.sort_by_cached_key(key);
    }
}

/// Lists that take all that a loop gives.
pub trait ParallelExtend<T> {
    /// Appends it.
    fn par_extend(&mut self, items: impl IntoIterator<Item = T>);
}

impl<T> ParallelExtend<T> for Vec<T> {
    fn par_extend(&mut self, items: impl IntoIterator<Item = T>) {
        self.extend(items);
    }
}
