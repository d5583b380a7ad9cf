//! Keyed random streams: every draw is a function of (seed, trial, purpose, entities, sequence) and of nothing else.
//!
//! The generator is Philox4x32-10 (Salmon et al., 2011), which is counter-based: a stream costs nothing to
//! open, needs no state between draws, and does not move when another stream is read more or less often.
//! That is what lets two settings be compared under common random numbers, and trials run in any order.

use rand_philox::{Philox, splitmix64};

use super::philox::{LANES, block, words, words_of_many};

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
        words(block([0, sequence, b, a], self.key))
    }

    /// The word that `next_u64` of [`at`](Self::at) would give the `nth` time, counted from 0, without those before it.
    #[must_use]
    pub fn word(&self, [a, b, sequence]: [u32; 3], nth: u32) -> u64 {
        words(block([nth / 2, sequence, b, a], self.key))[nth as usize % 2]
    }

    /// Puts the [first two words](Self::first_two) of the streams of `a` towards each of `others` into the empty `into`: several at a time.
    #[inline]
    pub fn first_two_towards(&self, a: u32, others: &[u32], sequence: u32, into: &mut Vec<[u64; 2]>) {
        for others in others.chunks(LANES) {
            let mut thirds = [0; LANES];
            thirds[..others.len()].copy_from_slice(others);
            let words = words_of_many([0, sequence, a], &thirds, self.key);
            into.extend_from_slice(&words[..others.len()]);
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const LOSS: Purpose = Purpose::new("test.loss");
    const LATENCY: Purpose = Purpose::new("test.latency");

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
    fn the_nth_word_is_that_of_the_stream() {
        let streams = Streams::new(1, 2).keyed(LOSS);
        let mut stream = streams.at(7, 1 << 31, 5);
        for nth in 0..9 {
            assert_eq!(streams.word([7, 1 << 31, 5], nth), stream.next_u64(), "{nth}");
        }
    }

    proptest! {
        #[test]
        fn words_towards_many_are_those_towards_each(others in prop::collection::vec(any::<u32>(), 0..30), a: u32, sequence: u32) {
            let streams = Streams::new(1, 2).keyed(LOSS);
            let mut words = Vec::new();
            streams.first_two_towards(a, &others, sequence, &mut words);
            let singly: Vec<_> = others.iter().map(|other| streams.first_two(a, *other, sequence)).collect();
            prop_assert_eq!(words, singly);
        }
    }

    #[test]
    fn the_first_word_of_a_seed_is_pinned_so_that_published_results_stay_reproducible() {
        let word = Streams::new(1, 0).keyed(LOSS).at(0, 1, 0).next_u64();
        assert_eq!(word, 17_631_413_880_663_629_323);
    }
}
