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

#[cfg(test)]
mod tests {
    use super::super::json::Events;
    use super::super::tracks::{INSTANT, Kind, Owner, Slice, Tracks};
    use super::*;

    fn track() -> Track {
        let slice = Slice {
            owner: Owner::Links,
            kind: Kind::Hears,
            name: "status",
            args: serde_json::Value::Null,
        };
        let mut tracks = Tracks::new(Events::new(Vec::new()).unwrap(), 9);
        tracks.slice(slice, SimTime::ZERO, INSTANT).unwrap()
    }

    #[test]
    fn the_latest_copies_of_each_topic_are_remembered() {
        let (at, track) = (SimTime::from_nanos, track());
        let pair = (ActorId(1), ActorId(2));
        let mut heard = Heard::default();
        heard.note(pair, Topic(0), at(1), at(1), track);
        for time in 2..12 {
            heard.note(pair, Topic(1), at(time), at(time), track);
        }
        let found: Vec<u64> = (0..20).filter(|&time| heard.find(pair, at(time)).is_some()).collect();
        assert_eq!(found, [1, 8, 9, 10, 11]);
        assert!(heard.find((ActorId(2), ActorId(1)), at(11)).is_none());
    }

    #[test]
    fn pairs_that_nobody_watches_are_forgotten_once_they_are_many() {
        let (at, track) = (SimTime::from_nanos, track());
        let mut heard = Heard::default();
        for robot in 0..2_000 {
            heard.note((ActorId(robot), ActorId(9_999)), Topic(0), at(1), at(5), track);
        }
        heard.watch((ActorId(7), ActorId(9_999)));
        heard.forget(at(5));
        assert_eq!(heard.pairs.len(), 2_000, "they may yet be read");
        heard.enough = 0;
        heard.forget(at(6));
        assert_eq!(heard.pairs.len(), 1);
        assert!(heard.find((ActorId(7), ActorId(9_999)), at(1)).is_some());
    }
}
