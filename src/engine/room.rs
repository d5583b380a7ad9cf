//! Room for lists of which every actor has one.

/// Entries by which a list grows at least.
const FEWEST: usize = 4;

/// Adds `value` to a `list` that grows by half and not twofold where it is full: with a million of them what stands empty counts.
#[inline]
pub fn push_tight<T>(list: &mut Vec<T>, value: T) {
    if list.len() == list.capacity() {
        grow(list);
    }
    list.push(value);
}

// Apart: it is seldom needed.
#[cold]
#[inline(never)]
fn grow<T>(list: &mut Vec<T>) {
    list.reserve_exact((list.len() / 2).max(FEWEST));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_holds_what_is_pushed_and_never_has_more_room_than_half_as_much_again() {
        let mut list = Vec::new();
        for value in 0..1000 {
            push_tight(&mut list, value);
            assert!(
                list.capacity() <= (list.len() + list.len() / 2).max(8),
                "{} of {}",
                list.capacity(),
                list.len()
            );
        }
        assert!(list.into_iter().eq(0..1000));
    }
}
