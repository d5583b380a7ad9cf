//! The block function of Philox4x32-10 (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", 2011): of one stream, and of many at once.
//!
//! The generator's crate has it as well. Here it stands for the sake of what is drawn for every copy of every frame: the processor works on
//! several blocks in one instruction where they lie side by side.

const MULTIPLIERS: [u32; 2] = [0xD251_1F53, 0xCD9E_8D57];
const WEYL: [u32; 2] = [0x9E37_79B9, 0xBB67_AE85];
const ROUNDS: usize = 10;

/// Blocks that are made at once.
pub(super) const LANES: usize = 8;

/// The block of a counter, its least word first.
// Left to the compiler, whether it is inlined hangs on what else is in the caller, and costs a tenth of a run where it is not.
#[allow(clippy::inline_always)]
#[inline(always)]
pub(super) fn block(mut counter: [u32; 4], mut key: [u32; 2]) -> [u32; 4] {
    for _ in 0..ROUNDS {
        let [a, b, c, d] = counter;
        let [first, second] = [
            u64::from(a) * u64::from(MULTIPLIERS[0]),
            u64::from(c) * u64::from(MULTIPLIERS[1]),
        ];
        counter = [
            (second >> 32) as u32 ^ b ^ key[0],
            second as u32,
            (first >> 32) as u32 ^ d ^ key[1],
            first as u32,
        ];
        key = next(key);
    }
    counter
}

/// A block as two words of 64 bits, as a stream gives them.
#[inline]
pub(super) fn words([first_low, first_high, second_low, second_high]: [u32; 4]) -> [u64; 2] {
    let word = |low, high| u64::from(low) | u64::from(high) << 32;
    [word(first_low, first_high), word(second_low, second_high)]
}

/// The [`words`] of the blocks of counters that differ in their third word alone: they are `[first, second, thirds[i], fourth]`.
#[inline]
pub(super) fn words_of_many(
    [first, second, fourth]: [u32; 3],
    thirds: &[u32; LANES],
    key: [u32; 2],
) -> [[u64; 2]; LANES] {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        return with_avx2([first, second, fourth], thirds, key);
    }
    lanes([first, second, fourth], thirds, key)
}

/// [`lanes`] for processors that have vectors of 256 bits: with loops of its own for the disk's models a twentieth off a delivery.
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
#[inline]
fn with_avx2(rest: [u32; 3], thirds: &[u32; LANES], key: [u32; 2]) -> [[u64; 2]; LANES] {
    #[target_feature(enable = "avx2")]
    fn compiled(rest: [u32; 3], thirds: &[u32; LANES], key: [u32; 2]) -> [[u64; 2]; LANES] {
        lanes(rest, thirds, key)
    }
    // SAFETY: the one caller has asked the processor whether it has these instructions.
    unsafe { compiled(rest, thirds, key) }
}

/// Lane by lane, in 64 bits of which the products need the lower half alone: then a round is a few instructions for all lanes.
// It is compiled anew within each caller, for the processor that the caller is for.
#[allow(clippy::inline_always)]
#[inline(always)]
fn lanes([first, second, fourth]: [u32; 3], thirds: &[u32; LANES], mut key: [u32; 2]) -> [[u64; 2]; LANES] {
    const LOWER: u64 = u32::MAX as u64;
    let all = |word: u32| [u64::from(word); LANES];
    let [mut a, mut b, mut c, mut d] = [all(first), all(second), thirds.map(u64::from), all(fourth)];
    for _ in 0..ROUNDS {
        let [k0, k1] = key.map(u64::from);
        for lane in 0..LANES {
            let one = (a[lane] & LOWER) * u64::from(MULTIPLIERS[0]);
            let two = (c[lane] & LOWER) * u64::from(MULTIPLIERS[1]);
            a[lane] = (two >> 32) ^ b[lane] ^ k0;
            b[lane] = two;
            c[lane] = (one >> 32) ^ d[lane] ^ k1;
            d[lane] = one;
        }
        key = next(key);
    }
    std::array::from_fn(|lane| {
        let word = |low: u64, high: u64| (low & LOWER) | high << 32;
        [word(a[lane], b[lane]), word(c[lane], d[lane])]
    })
}

#[inline]
fn next(key: [u32; 2]) -> [u32; 2] {
    [key[0].wrapping_add(WEYL[0]), key[1].wrapping_add(WEYL[1])]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn the_block_function_gives_the_published_known_answers() {
        assert_eq!(
            block([0; 4], [0; 2]),
            [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]
        );
        assert_eq!(
            block([u32::MAX; 4], [u32::MAX; 2]),
            [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]
        );
    }

    proptest! {
        #[test]
        fn our_block_function_is_that_of_the_generator(counter: [u32; 4], key: [u32; 2]) {
            prop_assert_eq!(block(counter, key), rand_philox::philox4x32_10(counter, key));
        }

        #[test]
        fn many_blocks_at_once_are_those_of_one_at_a_time(rest: [u32; 3], thirds: [u32; LANES], key: [u32; 2]) {
            let [first, second, fourth] = rest;
            let singly = thirds.map(|third| words(block([first, second, third, fourth], key)));
            prop_assert_eq!(lanes(rest, &thirds, key), singly);
            prop_assert_eq!(words_of_many(rest, &thirds, key), singly);
        }
    }
}
