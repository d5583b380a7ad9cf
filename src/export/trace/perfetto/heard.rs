//! Whom robots heard last, and where that was drawn: an arrow to a suspicion begins there.

use std::collections::BTreeMap;

use super::tracks::Track;
use crate::engine::{ActorId, SimTime};
use crate::protocol::Topic;

/// So many copies of a topic are remembered of each pair: the last one that counted for a detector is among the latest that arrived.
const REMEMBERED: usize = 4;
/// So few pairs are not worth looking for those that can go.
const FEW: usize = 1_024;

/// A robot, and one that it hears.
pub type Pair = (ActorId, ActorId);

/// What robots heard of those that they watch.
#[derive(Debug, Default)]
pub struct Heard {
    pairs: BTreeMap<Pair, Latest>,
    /// With so many pairs it is time to look for those that can go.
    enough: usize,
}

#[derive(Debug, Default)]
struct Latest {
    is_watched: bool,
    /// When the last one is read: then at the latest it is known whether the pair is watched.
    read: SimTime,
    copies: Vec<(Topic, SimTime, Track)>,
}

impl Heard {
    /// One watches another from now on.
    pub fn watch(&mut self, pair: Pair) {
        self.pairs.entry(pair).or_default().is_watched = true;
    }

    /// A copy arrived, was drawn, and is read then.
    pub fn note(&mut self, pair: Pair, topic: Topic, at: SimTime, read: SimTime, track: Track) {
        let latest = self.pairs.entry(pair).or_default();
        latest.read = latest.read.max(read);
        let mut alike = latest.copies.iter().enumerate().filter(|(_, copy)| copy.0 == topic);
        let oldest = alike.next().map(|(place, _)| place);
        if let Some(oldest) = oldest.filter(|_| alike.count() + 1 >= REMEMBERED) {
            latest.copies.remove(oldest);
        }
        latest.copies.push((topic, at, track));
    }

    /// Where the copy that arrived at that very instant was drawn.
    pub fn find(&self, pair: Pair, at: SimTime) -> Option<Track> {
        let latest = self.pairs.get(&pair)?;
        let found = latest.copies.iter().rev().find(|copy| copy.1 == at);
        found.map(|copy| copy.2)
    }

    /// Forgets pairs of which nobody watches the other, as far as is known at `now`.
    pub fn forget(&mut self, now: SimTime) {
        if self.pairs.len() > self.enough.max(FEW) {
            self.pairs.retain(|_, latest| latest.is_watched || latest.read >= now);
            self.enough = 2 * self.pairs.len();
        }
    }
}
