//! What is on air, and what was a moment ago.

use std::collections::VecDeque;

use crate::engine::{ActorId, SimTime};
use crate::geometry::Vec2;
use crate::radio::FrameId;

/// A burst by its number among all of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct BurstId(pub u64);

/// What one robot puts on air without a pause.
#[derive(Clone, Debug)]
pub(super) struct Burst {
    /// Who.
    pub sender: ActorId,
    /// What.
    pub content: Content,
    /// From when to when.
    pub begins: SimTime,
    pub ends: SimTime,
    /// Where its sender was when it began.
    pub position: Vec2,
    /// On which of the technology's channels.
    pub channel: u8,
    /// Whether its sender fell silent before it was through.
    pub cut: bool,
}

/// What a burst is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Content {
    /// A frame, for the so manieth time, from 0.
    Frame {
        frame: FrameId,
        attempt: u32,
        payload: u32,
        to: Option<ActorId>,
    },
    /// The answer to a frame that came from this robot in this burst.
    Acknowledgement { of: BurstId, to: ActorId },
    /// Noise, of nobody.
    Noise,
}

/// The bursts of the last while, in the order in which they began.
#[derive(Debug, Default)]
pub(super) struct Bursts {
    recent: VecDeque<Burst>,
    /// The number of the first of them.
    first: u64,
}

impl Bursts {
    /// Adds a burst.
    pub fn add(&mut self, burst: Burst) -> BurstId {
        let id = BurstId(self.first + self.recent.len() as u64);
        self.recent.push_back(burst);
        id
    }

    /// A burst, if it was not [forgotten](Self::forget).
    pub fn get(&self, id: BurstId) -> Option<&Burst> {
        let place = id.0.checked_sub(self.first)?;
        self.recent.get(place as usize)
    }

    /// The same, to be changed.
    pub fn get_mut(&mut self, id: BurstId) -> Option<&mut Burst> {
        let place = id.0.checked_sub(self.first)?;
        self.recent.get_mut(place as usize)
    }

    /// Forgets the oldest, as far as they ended before `since`.
    pub fn forget(&mut self, since: SimTime) {
        while self.recent.front().is_some_and(|burst| burst.ends < since) {
            self.recent.pop_front();
            self.first += 1;
        }
    }
}
