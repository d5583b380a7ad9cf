//! The radio: what arrives, and when.

use super::figure::Better;
use super::registry::Registry;
use crate::engine::Span;
use crate::metrics::record::TrialRecord;
use crate::metrics::unit::{DIMENSIONLESS, SECONDS};
use crate::metrics::volume::TopicFates;
use crate::radio::LossCause;
use crate::statistics::{Estimator, Part};

pub(super) fn declare(registry: &mut Registry) {
    let kind = (DIMENSIONLESS, Better::Higher, Estimator::ShareOf);
    registry.add_ratio("delivery_ratio", "copies delivered", kind, delivery);
    let kind = (DIMENSIONLESS, Better::Lower, Estimator::ShareOf);
    for cause in LossCause::ALL {
        let (key, name) = (cause.name(), cause.name().replace('_', " "));
        registry.add_ratio(
            &format!("lost.{key}"),
            &format!("copies lost to {name}"),
            kind,
            move |record| {
                let sum = all_topics(record);
                [sum.lost[cause as usize] as f64, sum.offered as f64]
            },
        );
    }
    let kind = (SECONDS, Better::Lower, Estimator::Mean);
    for (key, name, q) in [
        ("latency_s.p50", "latency, median", 0.5),
        ("latency_s.p95", "latency, 95th percentile", 0.95),
        ("latency_s.p99", "latency, 99th percentile", 0.99),
    ] {
        registry.add_plain(key, name, kind, move |record| {
            record.latency.quantile(q).map(Span::as_secs)
        });
    }
    registry.add_plain("latency_s.mean", "latency, mean", kind, |record| {
        record.latency.mean_secs()
    });
}

/// Copies of one trial that are delivered, and those offered. What is under way at the end has not been lost so far: it counts as
/// delivered in the share of those that came as far as their receiver and were heard there. So copies under way bias nothing.
pub(in crate::metrics) fn delivery(record: &TrialRecord) -> Part {
    let sum = all_topics(record);
    let unheard = sum.lost[LossCause::ReceiverDown as usize];
    let arrived = (sum.delivered + unheard) as f64;
    let heard = if unheard > 0 {
        sum.delivered as f64 / arrived
    } else {
        1.0
    };
    [sum.delivered as f64 + sum.in_flight as f64 * heard, sum.offered as f64]
}

fn all_topics(record: &TrialRecord) -> TopicFates {
    let mut sum = TopicFates::default();
    record.ledger.iter().for_each(|fates| sum.add(fates));
    sum
}
