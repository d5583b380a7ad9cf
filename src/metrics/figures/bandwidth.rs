//! Bandwidth: bytes a control step of robots, by topic, and how evenly they share them.

use super::figure::Better;
use super::registry::Registry;
use crate::metrics::unit::DIMENSIONLESS;
use crate::metrics::volume::TrafficRow;
use crate::statistics::{Estimator, gini, mean_value, quantile};

/// Bytes of a row of traffic.
type Bytes = fn(&TrafficRow) -> u64;

pub(super) fn declare(registry: &mut Registry, topics: &[&str]) {
    traffic(registry, "bandwidth", "", |_| true);
    for (number, topic) in topics.iter().enumerate() {
        let is_its = move |row: &TrafficRow| usize::from(row.topic) == number;
        traffic(
            registry,
            &format!("bandwidth.by_topic.{topic}"),
            &format!("{topic}: "),
            is_its,
        );
    }
    let even = (DIMENSIONLESS, Better::Lower, Estimator::Fraction);
    let ways: [(&str, &str, Bytes); 2] = [
        ("load_imbalance.tx", "Gini of bytes sent", |row| row.sent.bytes()),
        ("load_imbalance.rx", "Gini of bytes received", |row| {
            row.received.bytes()
        }),
    ];
    for (key, name, bytes) in ways {
        registry.add_plain(key, name, even, move |record| gini(&record.bytes_per_step(bytes)));
    }
}

/// Bytes a robot and step of the rows that `counts` accepts, over the robots of a trial.
fn traffic(registry: &mut Registry, prefix: &str, topic: &str, counts: impl Fn(&TrafficRow) -> bool + Copy + 'static) {
    let directions: [(&str, &str, Bytes); 4] = [
        ("tx_bytes_per_step", "bytes sent", |row| row.sent.bytes()),
        ("rx_bytes_per_step", "bytes received", |row| row.received.bytes()),
        ("tx_payload_bytes_per_step", "payload sent", |row| {
            row.sent.payload_bytes
        }),
        ("rx_payload_bytes_per_step", "payload received", |row| {
            row.received.payload_bytes
        }),
    ];
    for (direction, words, bytes) in directions {
        for (spread, q) in [("mean", None), ("median", Some(0.5)), ("max", Some(1.0))] {
            let key = format!("{prefix}.{direction}.{spread}");
            let name = format!("{topic}{words}, {spread} robot");
            let kind = ("B/step", Better::Lower, Estimator::Mean);
            registry.add_plain(&key, &name, kind, move |record| {
                let mut robots = record.bytes_per_step(|row| u64::from(counts(row)) * bytes(row));
                let Some(q) = q else {
                    return mean_value(&robots);
                };
                robots.sort_by(f64::total_cmp);
                quantile(&robots, q)
            });
        }
    }
}
