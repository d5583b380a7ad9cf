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

impl Frames {
    pub(super) fn of(topics: &[&str], records: &[TrialRecord]) -> Self {
        let all = records.iter().flat_map(|record| &record.ledger);
        let of_topic = |topic: usize| Fates::of(records.iter().filter_map(|record| record.ledger.get(topic)));
        Self {
            total: Fates::of(all),
            by_topic: Named::of(topics.iter().copied(), of_topic),
            unit: "frames".into(),
        }
    }
}

impl Fates {
    fn of<'a>(ledgers: impl Iterator<Item = &'a TopicFates>) -> Self {
        let mut sum = TopicFates::default();
        ledgers.for_each(|fates| sum.add(fates));
        Self {
            offered: sum.offered,
            delivered: sum.delivered,
            in_flight: sum.in_flight,
            lost: Named::of(LossCause::ALL.map(LossCause::name), |cause| sum.lost[cause]),
        }
    }
}
