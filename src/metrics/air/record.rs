//! What a trial leaves behind of its radios: plain data.

use serde::{Deserialize, Serialize};

use crate::engine::{ActorId, SimTime, Span};
use crate::metrics::latency::LatencyHistogram;
use crate::radio::LossCause;

/// What a radio draws from its battery for, in the order of [`Account::energy`](crate::radio::Account::energy).
pub const ENERGY_STATES: [&str; 4] = ["send", "receive", "listen", "turn"];

/// What radios did in a trial, over a radio that keeps accounts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AirRecord {
    /// Of each robot, in order of ids.
    pub robots: Vec<RobotAir>,
    /// How long frames that went on air waited for those before them: from when they were handed over until they were at the head of the queue.
    pub queue_wait: LatencyHistogram,
    /// How long medium access took with them: from the head of the queue until they were first on air.
    pub access_delay: LatencyHistogram,
    /// What became of copies by distance: the bands in which any was offered, the nearest first.
    pub bands: Vec<DistanceBand>,
    /// What became of copies by link, by sender and receiver, where the scenario asks for it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub links: Vec<LinkRecord>,
}

/// What one robot's radio did in a trial. A frame counts when its radio is done with it: those still to be sent at the end do not.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RobotAir {
    /// How long it was sending, acknowledgements included.
    pub sent: Span,
    /// How long it found the channel busy, its own sending included.
    pub busy: Span,
    /// What it drew from its battery, joules, in the order of [`ENERGY_STATES`].
    pub energy: [f64; 4],
    /// When its battery was empty, if it was.
    pub empty_at: Option<SimTime>,
    /// Frames that were handed over to it.
    pub frames: u64,
    /// Those that were on air at least once.
    pub on_air: u64,
    /// How often frames were on air, all together.
    pub attempts: u64,
    /// Frames that were acknowledged.
    pub acknowledged: u64,
    /// Frames that were sent as often as may be, and not acknowledged.
    pub unacknowledged: u64,
    /// Frames that were not sent, or not to their end, by cause in the order of [`LossCause::ALL`].
    pub dropped: [u64; LossCause::ALL.len()],
    /// How long its frames that went on air waited in its queue.
    pub queue_wait: Option<Waits>,
    /// How long medium access took with them.
    pub access_delay: Option<Waits>,
    /// Copies that it was offered.
    pub heard: Copies,
    /// Messages that it got though it counted as out of range of their senders: they are in no other count.
    pub strayed: u64,
}

impl RobotAir {
    /// Frames that never went on air.
    #[must_use]
    pub fn never_sent(&self) -> u64 {
        self.frames - self.on_air
    }
}

/// Waits, summed up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Waits {
    /// Their sum.
    pub sum: Span,
    /// The shortest.
    pub min: Span,
    /// The longest.
    pub max: Span,
}

impl Waits {
    /// These, and one more.
    pub(super) fn and(before: Option<Self>, wait: Span) -> Self {
        before.map_or(
            Self {
                sum: wait,
                min: wait,
                max: wait,
            },
            |before| Self {
                sum: before.sum + wait,
                min: before.min.min(wait),
                max: before.max.max(wait),
            },
        )
    }
}

/// Copies of frames, and how strong they were. A frame counts once, however many messages it carries; one that found no room in its sender's queue is not
/// among them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Copies {
    /// Those offered.
    pub offered: u64,
    /// Those understood.
    pub delivered: u64,
    /// Those that arrived with some power, understood or not; none where a radio knows no powers.
    pub reached: u64,
    /// Mean power of those that arrived with some, dBm.
    pub power_dbm: Option<f64>,
    /// Mean power of those understood, dBm.
    pub delivered_power_dbm: Option<f64>,
}

/// Copies whose sender was so far away.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DistanceBand {
    /// From how far on, metres.
    pub from_m: f64,
    /// To how far, metres, itself not within.
    pub to_m: f64,
    /// What became of them.
    pub copies: Copies,
}

/// What became of copies from one robot to another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LinkRecord {
    /// Who sent.
    pub sender: ActorId,
    /// Who was to hear it.
    pub receiver: ActorId,
    /// What became of them.
    pub copies: Copies,
    /// How far the two were apart, mean over the copies, metres.
    pub distance_m: f64,
}
