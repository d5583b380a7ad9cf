//! What is worked out once for all trials of a process: tables and levels that follow from a radio's config alone, and take milliseconds.

use std::sync::{Mutex, PoisonError};

/// So many are kept: the radios of a study's settings.
const KEPT: usize = 64;

/// Values of a pure function, by their keys.
pub(super) struct Memo<K, V>(Mutex<Vec<(K, V)>>);

impl<K: PartialEq, V: Clone> Memo<K, V> {
    pub const fn new() -> Self {
        Self(Mutex::new(Vec::new()))
    }

    /// The value for `key`, which `make` makes if it is not known.
    pub fn get(&self, key: K, make: impl FnOnce(&K) -> V) -> V {
        let known = |entries: &Vec<(K, V)>| entries.iter().find(|entry| entry.0 == key).map(|entry| entry.1.clone());
        // A thread that panicked can have left no entry half made.
        if let Some(value) = known(&self.0.lock().unwrap_or_else(PoisonError::into_inner)) {
            return value;
        }
        // Made without holding others up: two that make the same make it alike.
        let value = make(&key);
        let mut entries = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if entries.len() >= KEPT {
            entries.remove(0);
        }
        entries.push((key, value.clone()));
        value
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    #[test]
    fn a_value_is_made_once_until_many_others_were() {
        let (memo, made) = (Memo::new(), Cell::new(0));
        let square = |x: usize| {
            memo.get(x, |x| {
                made.set(made.get() + 1);
                x * x
            })
        };
        assert_eq!([square(3), square(3), square(4)], [9, 9, 16]);
        assert_eq!(made.get(), 2);
        let all: Vec<usize> = (100..100 + KEPT).map(square).collect();
        assert_eq!(all[1], 101 * 101);
        assert_eq!((square(3), made.get()), (9, 2 + KEPT + 1));
    }
}
