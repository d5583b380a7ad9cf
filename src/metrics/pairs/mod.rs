//! What passes from one robot to another, pair by pair: kept where a scenario asks for it (`metrics: (pairs: true)`), since it costs a look-up
//! a copy and room for every two robots that ever hear each other.
//!
//! A measure of pairs is declared once, in [`MEASURES`]: the table of pairs has a column of it, and the summary, reports and studies its
//! mean over pairs.

mod age;

use serde::{Deserialize, Serialize};

use crate::engine::{ActorId, SimTime};
use crate::happenings::Copy;
use crate::protocol::Topic;

use super::figures::Better;
use super::unit::{DIMENSIONLESS, SECONDS};
use age::{Age, Told as AgeTold};

/// What passed from one robot to another in a trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PairRecord {
    /// Who sent.
    pub sender: ActorId,
    /// Who was to hear it.
    pub receiver: ActorId,
    /// Copies offered.
    pub offered: u64,
    /// Copies delivered by the end.
    pub delivered: u64,
    /// What else is measured of it, in the order of [`PAIR_MEASURES`](crate::metrics::PAIR_MEASURES); `None` where there is nothing to tell.
    pub values: Vec<Option<f64>>,
}

/// What is measured of a pair.
pub struct PairMeasure {
    /// Its key: a column of `pairs.parquet`, and after `pairs.` that of the figure, its mean over pairs.
    pub key: &'static str,
    /// What reports call the figure.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Which way is better.
    pub better: Better,
    /// How it is read off a pair at the end of the run.
    value: fn(&Told) -> Option<f64>,
}

/// All measures of pairs, in this order:
///
/// | key | meaning |
/// |---|---|
/// | `delivery_ratio` | copies delivered, of those that arrived or were lost by the end |
/// | `age_mean_s` | how old the newest status that had arrived was: mean over the time from the first to the last, s |
/// | `age_peak_s` | how old it was when a newer one arrived: mean, s |
/// | `age_p95_s` | no older than that for 95 % of the time, s |
pub static MEASURES: &[PairMeasure] = &[
    PairMeasure {
        key: "delivery_ratio",
        name: "copies delivered, by pair",
        unit: DIMENSIONLESS,
        better: Better::Higher,
        value: |told| told.pair.delivery_ratio(),
    },
    PairMeasure {
        key: "age_mean_s",
        name: "age of status by pair, mean",
        unit: SECONDS,
        better: Better::Lower,
        value: |told| told.ages.mean,
    },
    PairMeasure {
        key: "age_peak_s",
        name: "age of status by pair, peaks",
        unit: SECONDS,
        better: Better::Lower,
        value: |told| told.ages.peak,
    },
    PairMeasure {
        key: "age_p95_s",
        name: "age of status by pair, 95 % of the time",
        unit: SECONDS,
        better: Better::Lower,
        value: |told| told.ages.p95,
    },
];

/// A sender, at its receiver.
#[derive(Debug, Default)]
struct Pair {
    delivered: u64,
    lost: u64,
    /// Still under way at the end.
    in_flight: u64,
    /// How old the newest status is, once there is one.
    age: Option<Age>,
}

/// A pair at the end.
struct Told {
    pair: Pair,
    ages: AgeTold,
}

impl Pair {
    /// A status arrived at `at`.
    fn refresh(&mut self, status: &Copy, at: SimTime) {
        match &mut self.age {
            Some(age) => age.arrived(status.sent_at, at),
            none => *none = Some(Age::since(status.sent_at, at)),
        }
    }

    /// The share of the copies that arrived of those whose fate is known.
    fn delivery_ratio(&self) -> Option<f64> {
        let settled = self.delivered + self.lost;
        (settled > 0).then(|| self.delivered as f64 / settled as f64)
    }
}

/// Whom a robot was to hear, in order of their ids, and what came of it. Apart, the ids are searched in little memory.
#[derive(Debug, Default)]
struct Heard {
    senders: Vec<ActorId>,
    pairs: Vec<Pair>,
}

/// The pairs of a run. It is told of copies by value, and rarely: by reference every copy of every run would have to be in memory for it.
#[derive(Debug)]
pub(super) struct Pairs {
    /// By receiver.
    heard: Vec<Heard>,
    /// The topic of statuses.
    status: Option<Topic>,
    /// Statuses that nobody read before the end, with their arrivals, which are told in no order.
    unread: Vec<(SimTime, Copy)>,
}

impl Pairs {
    /// Of robots that have heard nothing, and send statuses on the topic `status` if they do.
    pub(super) fn new(robots: usize, status: Option<Topic>) -> Self {
        Self {
            heard: std::iter::repeat_with(Heard::default).take(robots).collect(),
            status,
            unread: Vec::new(),
        }
    }

    /// A copy arrived at `at`, and was read if it `is_read`: then in order of arrivals.
    #[cold]
    pub(super) fn delivered(&mut self, copy: Copy, at: SimTime, is_read: bool) {
        let is_status = self.status == Some(copy.topic);
        let pair = self.pair(&copy);
        pair.delivered += 1;
        if is_status && is_read {
            pair.refresh(&copy, at);
        } else if is_status {
            self.unread.push((at, copy));
        }
    }

    /// A copy was lost.
    #[cold]
    pub(super) fn lost(&mut self, copy: Copy) {
        self.pair(&copy).lost += 1;
    }

    /// A copy is still under way at the end.
    #[cold]
    pub(super) fn in_flight(&mut self, copy: Copy) {
        self.pair(&copy).in_flight += 1;
    }

    fn pair(&mut self, copy: &Copy) -> &mut Pair {
        let Heard { senders, pairs } = &mut self.heard[copy.receiver.index()];
        let place = senders.binary_search(&copy.sender).unwrap_or_else(|place| {
            senders.insert(place, copy.sender);
            pairs.insert(place, Pair::default());
            place
        });
        &mut pairs[place]
    }

    /// The pairs, by sender and receiver.
    pub(super) fn into_records(mut self) -> Vec<PairRecord> {
        let mut unread = std::mem::take(&mut self.unread);
        unread.sort_by_key(|(at, _)| *at);
        for (at, copy) in &unread {
            self.pair(copy).refresh(copy, *at);
        }
        let receivers = (0..).map(ActorId).zip(self.heard);
        let record = move |receiver: ActorId, sender: ActorId, pair: Pair| {
            let ages = pair.age.as_ref().map(Age::told).unwrap_or_default();
            let told = Told { pair, ages };
            PairRecord {
                sender,
                receiver,
                offered: told.pair.delivered + told.pair.lost + told.pair.in_flight,
                delivered: told.pair.delivered,
                values: MEASURES.iter().map(|measure| (measure.value)(&told)).collect(),
            }
        };
        let mut records: Vec<PairRecord> = receivers
            .flat_map(|(receiver, heard)| {
                let heard = heard.senders.into_iter().zip(heard.pairs);
                heard.map(move |(sender, pair)| record(receiver, sender, pair))
            })
            .collect();
        records.sort_unstable_by_key(|record| (record.sender, record.receiver));
        records
    }
}
