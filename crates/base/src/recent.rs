//! Values of which the process keeps the last ones.

use std::sync::{Arc, Mutex, PoisonError};

/// The last `N` values that were asked for, by their keys: for what is a function of its key alone and takes long to make.
///
/// Two threads that ask for the same new value at a time both make it. If one waited for the other, which itself may wait
/// for the pool, both could wait for ever.
pub struct Recent<K, V, const N: usize>(Mutex<Vec<(K, Arc<V>)>>);

impl<K: PartialEq, V, const N: usize> Recent<K, V, N> {
    /// Nothing yet.
    #[expect(clippy::new_without_default, reason = "the default is not const")]
    pub const fn new() -> Self {
        Self(Mutex::new(Vec::new()))
    }

    /// The value of a key, made by `make` unless it is one of the last that were asked for.
    ///
    /// # Errors
    /// The error of `make`; then nothing is kept.
    pub fn get<E>(&self, key: K, make: impl FnOnce() -> Result<V, E>) -> Result<Arc<V>, E> {
        if let Some(value) = self.known(&key) {
            return Ok(value);
        }
        let made = Arc::new(make()?);
        if let Some(value) = self.known(&key) {
            return Ok(value);
        }
        let mut list = self.list();
        list.push((key, made.clone()));
        if list.len() > N {
            list.remove(0);
        }
        Ok(made)
    }

    /// The value of a key if it is one of the last, which then is the last.
    fn known(&self, key: &K) -> Option<Arc<V>> {
        let mut list = self.list();
        let place = list.iter().position(|(other, _)| other == key)?;
        list[place..].rotate_left(1);
        list.last().map(|(_, value)| value.clone())
    }

    fn list(&self) -> std::sync::MutexGuard<'_, Vec<(K, Arc<V>)>> {
        // A list is whole whenever its lock is let go.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_values_are_made_once_and_failures_are_not_kept() {
        let (recent, mut made) = (Recent::<u32, u32, 2>::new(), Vec::new());
        let mut get = |key: u32| {
            let value = recent.get(key, || {
                made.push(key);
                if key == 9 { Err(key) } else { Ok(10 * key) }
            });
            value.map(|value| *value)
        };
        let values: Vec<_> = [1, 2, 1, 9, 3, 1, 2, 1, 9].into_iter().map(&mut get).collect();
        assert_eq!(values, [Ok(10), Ok(20), Ok(10), Err(9), Ok(30), Ok(10), Ok(20), Ok(10), Err(9)]);
        assert_eq!(made, [1, 2, 9, 3, 2, 9], "of 1 and 2 the latter is the older when 3 comes");
    }
}
