//! Asking for memory before it is needed.
//!
//! In a swarm that outgrows the processor's cache nearly every wake finds its robot's state in main memory, a tenth of a
//! microsecond away, and the simulator does little but wait. Which robots wake next is known, though, and so is who hears a
//! frame before its fates are drawn: what is asked for then is there in time. At 20,480 robots this takes more than a third off
//! the cost of a delivery; nothing depends on it, and where the processor has no such instruction it does nothing.

/// Swarms up to so many robots stay in the cache, at a few kilobytes a robot: asking would only cost time.
const CACHED: usize = 500;

/// Bytes that travel together between memory and cache.
const LINE: usize = 64;
/// Bytes of an entry that is aligned to its size in any table.
const SMALL: usize = 16;

/// Whether a swarm of so many `robots` outgrows the cache, so that asking for memory is worth its time.
#[must_use]
pub fn outgrows_cache(robots: usize) -> bool {
    robots > CACHED
}

/// Asks for `value`.
#[inline]
pub fn prefetch<T>(value: &T) {
    bytes(std::ptr::from_ref(value).cast(), size_of::<T>());
}

/// Asks for all of `values`.
#[inline]
pub fn prefetch_all<T>(values: &[T]) {
    bytes(values.as_ptr().cast(), size_of_val(values));
}

/// Asks for the place where the next push to `values` goes.
#[inline]
pub fn prefetch_end<T>(values: &[T]) {
    bytes(values.as_ptr().wrapping_add(values.len()).cast(), size_of::<T>());
}

/// Asks for `count` bytes from `start` on.
#[inline]
fn bytes(start: *const u8, count: usize) {
    for offset in (0..count).step_by(LINE) {
        line_at(start.wrapping_add(offset));
    }
    // They may end in one line more. What is as small as a table's entry nearly never does.
    if count > SMALL {
        line_at(start.wrapping_add(count - 1));
    }
}

#[cfg(target_arch = "x86_64")]
#[inline]
#[allow(unsafe_code)]
fn line_at(place: *const u8) {
    use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
    // SAFETY: a prefetch is a hint. It neither reads nor writes, and at an address that is nobody's it does nothing.
    unsafe { _mm_prefetch::<_MM_HINT_T0>(place.cast()) }
}

#[cfg(not(target_arch = "x86_64"))]
#[inline]
fn line_at(_: *const u8) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn asking_for_nothing_for_much_and_past_the_end_is_harmless() {
        prefetch(&());
        prefetch(&[0_u8; 1000]);
        prefetch_all::<u64>(&[]);
        prefetch_all(&[0_u64; 1000]);
        prefetch_end::<u64>(&[]);
        prefetch_end(&[0_u64; 8]);
    }
}
