//! Keyed random streams: every draw is a function of (seed, trial, purpose, entities, sequence) and of nothing else.
//!
//! The generator is Philox4x32-10 (Salmon et al., 2011), which is counter-based: a stream costs nothing to
//! open, needs no state between draws, and does not move when another stream is read more or less often.
//! That is what lets two settings be compared under common random numbers, and trials run in any order.

use rand_philox::{Philox, splitmix64};

/// What a stream is used for. Two purposes never share a draw.
///
/// Each module names its own, as a constant: `const LOSS: Purpose = Purpose::new("radio.loss");`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Purpose(u64);

impl Purpose {
    /// A purpose known by `name` (FNV-1a of its bytes; the name is part of what makes a result).
    #[must_use]
    pub const fn new(name: &str) -> Self {
        let bytes = name.as_bytes();
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        let mut i = 0;
        while i < bytes.len() {
            hash = (hash ^ bytes[i] as u64).wrapping_mul(0x0000_0100_0000_01b3);
            i += 1;
        }
        Self(hash)
    }
}

/// All random streams of one trial.
#[derive(Clone, Copy, Debug)]
pub struct Streams {
    trial_key: u64,
}

/// The streams of one trial for one purpose.
#[derive(Clone, Copy, Debug)]
pub struct KeyedStreams {
    key: [u32; 2],
}

impl Streams {
    /// The streams of trial number `trial` of an experiment with `seed`.
    #[must_use]
    pub fn new(seed: u64, trial: u32) -> Self {
        let golden = 0x9e37_79b9_7f4a_7c15_u64;
        let seeded = splitmix64(seed.wrapping_add(golden));
        Self {
            trial_key: splitmix64(seeded ^ u64::from(trial).wrapping_add(1).wrapping_mul(golden)),
        }
    }

    /// The streams for one purpose.
    #[must_use]
    pub fn keyed(&self, purpose: Purpose) -> KeyedStreams {
        let key = splitmix64(self.trial_key ^ purpose.0);
        KeyedStreams {
            key: [key as u32, (key >> 32) as u32],
        }
    }
}

impl KeyedStreams {
    /// The stream of entity `a`, towards entity `b` where the purpose is about an ordered pair (else 0),
    /// for the `sequence`-th occasion. Opening it draws nothing.
    #[inline]
    #[must_use]
    pub fn at(&self, a: u32, b: u32, sequence: u32) -> Philox {
        let counter = (u128::from(a) << 96) | (u128::from(b) << 64) | (u128::from(sequence) << 32);
        Philox::new(self.key, counter)
    }

    /// The first two words that `next_u64` of [`at`](Self::at) would give, without the stream.
    #[inline]
    #[must_use]
    pub fn first_two(&self, a: u32, b: u32, sequence: u32) -> [u64; 2] {
        let [first_low, first_high, second_low, second_high] = block([0, sequence, b, a], self.key).map(u64::from);
        [first_low | first_high << 32, second_low | second_high << 32]
    }
}

/// The block function of Philox4x32-10 (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", 2011). The generator's crate has it as well; here it
/// is always inlined, so that a loop over the keys of many copies becomes one over vectors of them: whether the other is inlined hangs on
/// what else is in the caller, and costs a tenth of a run where it is not.
#[allow(clippy::inline_always)]
#[inline(always)]
fn block(mut counter: [u32; 4], mut key: [u32; 2]) -> [u32; 4] {
    const MULTIPLIERS: [u32; 2] = [0xD251_1F53, 0xCD9E_8D57];
    const WEYL: [u32; 2] = [0x9E37_79B9, 0xBB67_AE85];
    for _ in 0..10 {
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
        key = [key[0].wrapping_add(WEYL[0]), key[1].wrapping_add(WEYL[1])];
    }
    counter
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const LOSS: Purpose = Purpose::new("test.loss");
    const LATENCY: Purpose = Purpose::new("test.latency");

    #[test]
    fn the_block_function_gives_the_published_known_answers() {
        assert_eq!(
            rand_philox::philox4x32_10([0; 4], [0; 2]),
            [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]
        );
        assert_eq!(
            rand_philox::philox4x32_10([u32::MAX; 4], [u32::MAX; 2]),
            [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]
        );
    }

    proptest! {
        #[test]
        fn our_block_function_is_that_of_the_generator(counter: [u32; 4], key: [u32; 2]) {
            prop_assert_eq!(block(counter, key), rand_philox::philox4x32_10(counter, key));
        }
    }

    #[test]
    fn a_stream_depends_on_every_part_of_its_key_and_on_nothing_else() {
        let word = |seed, trial, purpose, a, b, sequence| {
            Streams::new(seed, trial).keyed(purpose).at(a, b, sequence).next_u64()
        };
        let base = word(1, 2, LOSS, 3, 4, 5);
        assert_eq!(base, word(1, 2, LOSS, 3, 4, 5));
        for other in [
            word(2, 2, LOSS, 3, 4, 5),
            word(1, 3, LOSS, 3, 4, 5),
            word(1, 2, LATENCY, 3, 4, 5),
            word(1, 2, LOSS, 4, 3, 5),
            word(1, 2, LOSS, 3, 5, 4),
            word(1, 2, LOSS, 3, 4, 6),
        ] {
            assert_ne!(base, other);
        }
    }

    #[test]
    fn the_first_two_words_are_those_of_the_stream() {
        let streams = Streams::new(1, 2).keyed(LOSS);
        let mut stream = streams.at(7, 1 << 31, 5);
        assert_eq!(streams.first_two(7, 1 << 31, 5), [stream.next_u64(), stream.next_u64()]);
    }

    #[test]
    fn the_first_word_of_a_seed_is_pinned_so_that_published_results_stay_reproducible() {
        let word = Streams::new(1, 0).keyed(LOSS).at(0, 1, 0).next_u64();
        assert_eq!(word, 17_631_413_880_663_629_323);
    }
}
