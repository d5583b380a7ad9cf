//! What became of the frames.

use serde::{Deserialize, Serialize};

use crate::metrics::record::TrialRecord;
use crate::metrics::unit::Unit;
use crate::metrics::volume::TopicFates;
use crate::radio::LossCause;

use super::quantity::Named;

/// Frames by fate over all trials, a copy for each intended receiver; offered = delivered + in flight + lost.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frames {
    /// Of all topics.
    #[serde(flatten)]
    pub total: Fates,
    /// Of each topic.
    pub by_topic: Named<Fates>,
    /// Always `"frames"`.
    pub unit: Unit,
}

/// Copies of frames by fate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fates {
    /// Offered to robots in range.
    pub offered: u64,
    /// Arrived.
    pub delivered: u64,
    /// Under way at the end.
    pub in_flight: u64,
    /// Lost, by cause.
    pub lost: Named<u64>,
}

/// Frames by topic, over the trials that were counted.
#[derive(Debug, Default)]
pub(super) struct Ledger(Vec<TopicFates>);

impl Ledger {
    /// Takes in a trial.
    pub fn count(&mut self, record: &TrialRecord) {
        let topics = self.0.len().max(record.ledger.len());
        self.0.resize_with(topics, TopicFates::default);
        for (sum, fates) in self.0.iter_mut().zip(&record.ledger) {
            sum.add(fates);
        }
    }
}

impl Frames {
    pub(super) fn of(topics: &[&str], ledger: &Ledger) -> Self {
        let mut total = TopicFates::default();
        ledger.0.iter().for_each(|fates| total.add(fates));
        let of_topic = |topic: usize| Fates::of(ledger.0.get(topic).unwrap_or(&TopicFates::default()));
        Self {
            total: Fates::of(&total),
            by_topic: Named::of(topics.iter().copied(), of_topic),
            unit: "frames".into(),
        }
    }
}

impl Fates {
    fn of(sum: &TopicFates) -> Self {
        Self {
            offered: sum.offered,
            delivered: sum.delivered,
            in_flight: sum.in_flight,
            lost: Named::of(LossCause::ALL.map(LossCause::name), |cause| sum.lost[cause]),
        }
    }
}
