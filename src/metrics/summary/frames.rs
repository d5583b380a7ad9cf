//! What became of the frames.

use serde::{Deserialize, Serialize};

use crate::metrics::record::{TopicFates, TrialRecord};
use crate::radio::LossCause;
use crate::statistics::Part;

use super::quantity::{Named, Unit};

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

/// Copies of one trial that are delivered, and those offered. What is under way at the end has not been lost so far: it counts as
/// delivered in the share of those that came as far as their receiver and were heard there. So copies under way bias nothing.
pub(in crate::metrics) fn delivery(record: &TrialRecord) -> Part {
    let mut sum = TopicFates::default();
    record.ledger.iter().for_each(|fates| sum.add(fates));
    let unheard = sum.lost[LossCause::ReceiverDown as usize];
    let arrived = (sum.delivered + unheard) as f64;
    let heard = if unheard > 0 {
        sum.delivered as f64 / arrived
    } else {
        1.0
    };
    [sum.delivered as f64 + sum.in_flight as f64 * heard, sum.offered as f64]
}
