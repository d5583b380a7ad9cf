//! Gilbert–Elliott: each ordered pair of robots is a two-state Markov chain, good or bad, that steps once a frame.
//!
//! With g = P(good → bad) and b = P(bad → good), the share of bad frames is π = g / (g + b), and what a state tells
//! about the n-th frame after it fades as λⁿ, λ = 1 − g − b:
//!
//! P(bad, n frames on) = π + λⁿ ([bad now] − π).
//!
//! So a link is brought up to date when its receiver next listens, by one draw however many of the sender's frames
//! that receiver was out of range for. A link never seen is the same formula at n = ∞: it starts from the stationary
//! distribution. And a link whose λⁿ is below what a draw can resolve may be forgotten, which changes no fate: rows
//! hold the pairs that met lately, not all that ever did.

use super::draw::FrameCopy;
use crate::engine::{ActorId, KeyedStreams, Purpose, Streams};

/// The uniform that decides a link's next state.
const STATE: Purpose = Purpose::new("radio.gilbert_state");

/// The smallest difference between probabilities that a draw can tell: half the step between its uniforms.
const RESOLUTION: f64 = 1.0 / (1_u64 << 33) as f64;

/// The links of all pairs that met lately.
#[derive(Debug)]
pub(super) struct GilbertElliott {
    /// π: the share of frames that find their link bad.
    bad_share: f64,
    /// λ: the correlation between the states at two successive frames.
    persistence: f64,
    /// Frames after which a state is forgotten: the smallest n at which |λ|ⁿ is below the resolution of a draw.
    memory: u32,
    /// Loss probability in the good state and in the bad one.
    losses: [f64; 2],
    draws: KeyedStreams,
    /// For each sender its links, in order of their receivers.
    rows: Vec<Vec<Link>>,
}

/// The state of an ordered pair.
#[derive(Clone, Copy, Debug)]
struct Link {
    receiver: ActorId,
    /// The sender's frame that found it so.
    sequence: u32,
    bad: bool,
}

impl GilbertElliott {
    /// Chains with transition probabilities good → bad and bad → good, not both 0, and with the loss probabilities of
    /// a good and a bad link, among `robots` robots.
    pub fn new([good_to_bad, bad_to_good]: [f64; 2], losses: [f64; 2], streams: Streams, robots: usize) -> Self {
        let persistence = 1.0 - good_to_bad - bad_to_good;
        Self {
            bad_share: good_to_bad / (good_to_bad + bad_to_good),
            persistence,
            memory: (RESOLUTION.recip().ln() / persistence.abs().recip().ln()).ceil() as u32,
            losses,
            draws: streams.keyed(STATE),
            rows: vec![Vec::new(); robots],
        }
    }

    /// The loss probability of `copy`, once its link has stepped to this frame.
    #[inline]
    pub fn loss_probability(&mut self, copy: FrameCopy) -> f64 {
        self.losses[usize::from(self.step(copy))]
    }

    /// Brings the link of `copy` up to its frame; says whether it is bad.
    fn step(&mut self, copy: FrameCopy) -> bool {
        let row = &self.rows[copy.sender.index()];
        let place = row.binary_search_by_key(&copy.receiver, |link| link.receiver);
        let last = place.ok().map(|place| row[place]);
        let now = Link {
            receiver: copy.receiver,
            sequence: copy.sequence,
            bad: copy.happens(self.bad_probability(last, copy.sequence), self.draws),
        };
        match place {
            Ok(place) => self.rows[copy.sender.index()][place] = now,
            Err(_) => self.remember(copy.sender, now),
        }
        now.bad
    }

    /// The probability that a link is bad at frame `sequence`, given what it was when last seen.
    fn bad_probability(&self, last: Option<Link>, sequence: u32) -> f64 {
        match last.map(|link| (link.bad, sequence.wrapping_sub(link.sequence))) {
            Some((bad, age)) if age < self.memory => {
                let surprise = f64::from(u8::from(bad)) - self.bad_share;
                self.bad_share + power(self.persistence, age) * surprise
            }
            _ => self.bad_share,
        }
    }

    /// Adds a link to its sender's row; a row about to grow first drops what it need not remember.
    fn remember(&mut self, sender: ActorId, link: Link) {
        let row = &mut self.rows[sender.index()];
        if row.len() == row.capacity() {
            row.retain(|old| link.sequence.wrapping_sub(old.sequence) < self.memory);
        }
        let place = row.partition_point(|old| old.receiver < link.receiver);
        row.insert(place, link);
    }
}

/// `base` to the power of `exponent`, rounded alike on every machine, which the standard library does not promise.
fn power(base: f64, exponent: u32) -> f64 {
    let (mut result, mut square, mut left) = (1.0, base, exponent);
    while left > 0 {
        if left & 1 == 1 {
            result *= square;
        }
        square *= square;
        left >>= 1;
    }
    result
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use proptest::prelude::*;

    use super::*;

    fn copy(receiver: u32, sequence: u32) -> FrameCopy {
        FrameCopy {
            sender: ActorId(0),
            receiver: ActorId(receiver),
            sequence,
        }
    }

    fn chains(good_to_bad: f64, bad_to_good: f64) -> GilbertElliott {
        GilbertElliott::new([good_to_bad, bad_to_good], [0.0, 1.0], Streams::new(7, 0), 1)
    }

    #[test]
    fn a_power_is_the_product_of_its_factors() {
        for base in [0.75, -0.4, 0.0, 1.0, -1.0] {
            for exponent in [0, 1, 2, 3, 10, 31] {
                let product: f64 = (0..exponent).map(|_| base).product();
                assert!((power(base, exponent) - product).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn memory_lasts_for_as_long_as_a_draw_can_tell_the_difference() {
        let links = chains(0.05, 0.2);
        assert!(power(0.75, links.memory) < RESOLUTION && power(0.75, links.memory - 1) >= RESOLUTION);
        assert_eq!(
            chains(0.4, 0.6).memory,
            0,
            "a chain without correlation has nothing to remember"
        );
        assert_eq!(chains(1.0, 1.0).memory, u32::MAX, "an alternating chain never forgets");
    }

    #[test]
    fn the_row_of_a_robot_that_meets_many_in_turn_stays_short() {
        let mut links = chains(0.05, 0.2);
        for frame in 0..100_000 {
            links.step(copy(frame / 10, frame));
        }
        let met_within_memory = links.memory as usize / 10 + 1;
        assert!(links.rows[0].capacity() <= 2 * met_within_memory.next_power_of_two());
    }

    proptest! {
        #[test]
        fn rows_that_forget_give_the_states_of_a_table_that_never_does(
            hearings in prop::collection::vec((0_u32..40, 0_u32..60), 1..400),
            good_to_bad in 0.05..1.0_f64, bad_to_good in 0.05..1.0_f64,
        ) {
            let mut links = chains(good_to_bad, bad_to_good);
            let mut table: BTreeMap<ActorId, Link> = BTreeMap::new();
            let mut sequence = 0;
            for (receiver, silence) in hearings {
                sequence += silence + 1;
                let copy = copy(receiver, sequence);
                let probability = links.bad_probability(table.get(&copy.receiver).copied(), sequence);
                let bad = copy.happens(probability, links.draws);
                table.insert(copy.receiver, Link { receiver: copy.receiver, sequence, bad });
                prop_assert_eq!(links.step(copy), bad);
                prop_assert!(links.rows[0].is_sorted_by_key(|link| link.receiver));
            }
        }
    }
}
