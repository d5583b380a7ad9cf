//! Frames and bytes of a trial, and what became of them.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::engine::ActorId;
use crate::radio::LossCause;

/// Frames of one topic by fate, counted a copy an intended receiver.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct TopicFates {
    /// Copies that transmissions offered to robots in range.
    pub offered: u64,
    /// Copies that arrived.
    pub delivered: u64,
    /// Copies lost, by [`LossCause`] in the order of [`LossCause::ALL`].
    pub lost: [u64; LossCause::ALL.len()],
    /// Copies under way at the end.
    pub in_flight: u64,
}

impl TopicFates {
    /// Whether every copy offered has exactly one fate.
    #[must_use]
    pub fn is_balanced(&self) -> bool {
        self.offered == self.delivered + self.lost.iter().sum::<u64>() + self.in_flight
    }

    /// Adds the frames of `other`.
    pub fn add(&mut self, other: &Self) {
        self.offered += other.offered;
        self.delivered += other.delivered;
        self.in_flight += other.in_flight;
        for (mine, theirs) in self.lost.iter_mut().zip(&other.lost) {
            *mine += theirs;
        }
    }
}

impl fmt::Display for TopicFates {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let causes: Vec<String> = LossCause::ALL
            .iter()
            .zip(&self.lost)
            .map(|(cause, frames)| format!("{} {frames}", cause.name()))
            .collect();
        let lost: u64 = self.lost.iter().sum();
        write!(
            f,
            "offered {}, delivered {}, lost {lost} ({}), in flight {}",
            self.offered,
            self.delivered,
            causes.join(", "),
            self.in_flight
        )
    }
}

/// Frames and their bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Volume {
    /// Number of frames.
    pub frames: u64,
    /// Their payload, bytes.
    pub payload_bytes: u64,
    /// Their headers, bytes.
    pub header_bytes: u64,
}

impl Volume {
    /// All their bytes, headers included.
    #[must_use]
    pub fn bytes(self) -> u64 {
        self.payload_bytes + self.header_bytes
    }
}

/// Traffic of one robot while in one role, on one topic.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TrafficRow {
    /// The robot.
    pub robot: ActorId,
    /// Its role then, an index into the protocol's roles.
    pub role: u8,
    /// The topic, an index into the protocol's topics.
    pub topic: u8,
    /// What it sent, a frame counted once however many robots hear it.
    pub sent: Volume,
    /// What reached it.
    pub received: Volume,
    /// The part of it that told it nothing new, as far as the protocol says.
    pub duplicate: Volume,
    /// What was meant for it and lost, by cause in the order of [`LossCause::ALL`].
    pub lost: [Volume; LossCause::ALL.len()],
}
