//! What is kept of a trial only where a scenario asks for it: plain data.

use std::mem::swap;

use serde::{Deserialize, Serialize};

use crate::engine::{ActorId, SimTime, Span};
use crate::metrics::volume::TopicFates;
use crate::spool::{Spool, Spooled, entry};

/// What a scenario asked for (`metrics: (record: [...])`), table by table; what it did not ask for is empty.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Asked {
    /// What became of copies, by topic, then by distance: the bands in which any was offered.
    pub delivery: Vec<DeliveryBand>,
    /// How long copies took, by window of time, then by topic: those of which any was delivered.
    pub delays: Spool<DelayEntry>,
    /// Whom robots had in range, at each sample.
    pub degree: Spool<DegreeSample>,
    /// Who learnt what from whom, in the order in which robots noted it.
    pub hops: Spool<Hop>,
    /// What robots sent and received, by window of time, then by robot, then by topic: those with traffic.
    pub traffic: Spool<TrafficEntry>,
    /// The role that each robot starts in, in order of ids, then every change, in order of time.
    pub roles: Spool<RoleChange>,
}

impl Asked {
    /// Whether there is nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        let lists = [self.delays.is_empty(), self.degree.is_empty(), self.hops.is_empty()];
        self.delivery.is_empty() && lists == [true; 3] && self.traffic.is_empty() && self.roles.is_empty()
    }

    /// Its long lists, always in this order.
    pub(in crate::metrics) fn lists(&mut self) -> [&mut dyn Spooled; 5] {
        [
            &mut self.delays,
            &mut self.degree,
            &mut self.hops,
            &mut self.traffic,
            &mut self.roles,
        ]
    }

    /// Puts the long lists of `other` in the place of its own, which it gives.
    pub(in crate::metrics) fn exchange_lists(&mut self, other: &mut Self) {
        swap(&mut self.delays, &mut other.delays);
        swap(&mut self.degree, &mut other.degree);
        swap(&mut self.hops, &mut other.hops);
        swap(&mut self.traffic, &mut other.traffic);
        swap(&mut self.roles, &mut other.roles);
    }
}

/// Copies on one topic whose sender was so far away when they were sent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DeliveryBand {
    /// The topic, an index into the protocol's topics.
    pub topic: u8,
    /// From how far on, metres.
    pub from_m: f64,
    /// To how far, metres, itself not within.
    pub to_m: f64,
    /// What became of them.
    pub fates: TopicFates,
}

/// How long the copies on one topic took that were delivered in one window of time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DelayEntry {
    /// Since when.
    pub since: SimTime,
    /// Until when.
    pub at: SimTime,
    /// The topic, an index into the protocol's topics.
    pub topic: u8,
    /// Number of copies.
    pub copies: u64,
    /// Their mean latency, seconds.
    pub mean_s: f64,
    /// The least, exactly.
    pub min: Span,
    /// No longer than that took half of them, within 1/256.
    pub median: Span,
    /// No longer than that took 95 % of them, within 1/256.
    pub p95: Span,
    /// No longer than that took 99 % of them, within 1/256.
    pub p99: Span,
    /// The greatest, exactly.
    pub max: Span,
}

/// How many others each robot has in range at one instant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DegreeSample {
    /// When.
    pub at: SimTime,
    /// Live robots that each robot hears and that hear it, in order of ids; `None` of a robot that is not live.
    pub neighbours: Vec<Option<u32>>,
}

/// A robot came to know a rumour.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Hop {
    /// The rumour, from 0.
    pub rumor: u16,
    /// Who.
    pub robot: ActorId,
    /// When it arrived there, or was begun there.
    pub at: SimTime,
    /// Whom it had it from; `None` where it was begun.
    pub parent: Option<ActorId>,
    /// How many transmissions it had come over: 0 where it was begun.
    pub hops: u32,
}

/// What one robot sent and received on one topic in one window of time.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TrafficEntry {
    /// Since when.
    pub since: SimTime,
    /// Until when.
    pub at: SimTime,
    /// The robot.
    pub robot: ActorId,
    /// The topic, an index into the protocol's topics.
    pub topic: u8,
    /// Messages that it sent, each counted once however many robots hear it.
    pub sent_frames: u64,
    /// Their bytes, headers included.
    pub sent_bytes: u64,
    /// Messages that reached it.
    pub received_frames: u64,
    /// Their bytes, headers included.
    pub received_bytes: u64,
}

/// A robot entered a role.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RoleChange {
    /// When.
    pub at: SimTime,
    /// Who.
    pub robot: ActorId,
    /// The role before, an index into the protocol's roles; `None` at the start.
    pub before: Option<u8>,
    /// The role since then.
    pub role: u8,
}

entry! {
    DelayEntry { since, at, topic, copies, mean_s, min, median, p95, p99, max }
    DegreeSample { at, neighbours }
    Hop { rumor, robot, at, parent, hops }
    TrafficEntry { since, at, robot, topic, sent_frames, sent_bytes, received_frames, received_bytes }
    RoleChange { at, robot, before, role }
}
