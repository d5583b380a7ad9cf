//! Gossip: whom rumours reach, and what is heard in vain.

use super::figure::Better;
use super::registry::Registry;
use crate::engine::SimTime;
use crate::metrics::record::TrialRecord;
use crate::metrics::unit::DIMENSIONLESS;
use crate::metrics::volume::TrafficRow;
use crate::statistics::{Estimator, Part};

pub(super) fn declare(registry: &mut Registry, topics: &[&str]) {
    let more = (DIMENSIONLESS, Better::Higher, Estimator::Share);
    registry.add_plain(
        "spread.informed_ratio",
        "robots informed at the end",
        more,
        informed_ratio,
    );
    let hops = ("hops", Better::Lower, Estimator::Mean);
    registry
        .add_ratio("spread.hops", "hops that a rumour came over", hops, hops_of)
        .list();
    let less = (DIMENSIONLESS, Better::Lower, Estimator::ShareOf);
    registry.add_ratio("duplicates", "duplicates in messages delivered", less, |record| {
        duplicates(record, |_| true)
    });
    for (number, topic) in topics.iter().enumerate() {
        let key = format!("duplicates.by_topic.{topic}");
        registry.add_ratio(
            &key,
            &format!("{topic}: duplicates in messages delivered"),
            less,
            move |record| duplicates(record, |row| usize::from(row.topic) == number),
        );
    }
}

/// The pairs of a robot and a rumour in one trial.
pub(in crate::metrics) struct Pairs {
    pub count: usize,
    /// When each of the informed ones was informed, in order.
    pub times: Vec<SimTime>,
    pub end: SimTime,
}

impl Pairs {
    pub fn of(record: &TrialRecord) -> Option<Self> {
        let failed = record.failed_at_end();
        let rumors = record.spread.iter();
        let pairs = rumors.flat_map(|rumor| (0..).zip(&rumor.informed));
        let well: Vec<Option<SimTime>> = pairs
            .filter(|(robot, _)| failed.binary_search_by_key(robot, |failed| failed.0).is_err())
            .map(|(_, at)| *at)
            .collect();
        let mut times: Vec<SimTime> = well.iter().copied().flatten().collect();
        times.sort_unstable();
        // Of nobody there is nothing to say.
        (!well.is_empty()).then_some(Self {
            count: well.len(),
            times,
            end: record.simulated,
        })
    }
}

impl Pairs {
    fn informed_ratio(&self) -> f64 {
        self.times.len() as f64 / self.count as f64
    }
}

/// The share of all pairs of a robot and a rumour in which the robot knew the rumour at the end of a trial; `None` without rumours, or without robots that
/// are well.
fn informed_ratio(record: &TrialRecord) -> Option<f64> {
    Pairs::of(record).map(|pairs| pairs.informed_ratio())
}

/// The hops that the rumours of a trial came over to the robots that had them from others, all together, and how many these are.
fn hops_of(record: &TrialRecord) -> Part {
    let hops = record.spread.iter().flat_map(|rumor| rumor.hops.iter().flatten());
    let told: Vec<f64> = hops.filter(|hops| **hops > 0).map(|hops| f64::from(*hops)).collect();
    [told.iter().sum(), told.len() as f64]
}

/// Duplicates in a trial and messages delivered, of the rows of traffic that `counts` accepts.
fn duplicates(record: &TrialRecord, counts: impl Fn(&TrafficRow) -> bool) -> Part {
    let rows = || record.traffic.iter().filter(|row| counts(row));
    let received: u64 = rows().map(|row| row.received.frames).sum();
    let duplicate: u64 = rows().map(|row| row.duplicate.frames).sum();
    [duplicate as f64, received as f64]
}
