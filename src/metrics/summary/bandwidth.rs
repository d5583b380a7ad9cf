//! What robots send and receive. A robot's bandwidth in a trial is its bytes over its control steps that were due in the trial, in all of
//! which it counts, also while it was down: topics and roles thus add up to the whole.

use serde::{Deserialize, Serialize};

use crate::metrics::record::TrialRecord;
use crate::metrics::unit::{DIMENSIONLESS, Unit};
use crate::metrics::volume::{TrafficRow, Volume};
use crate::statistics::{Estimate, mean, quantile};

use super::estimates::Figures;
use super::quantity::{Named, Quantity};

/// Bandwidth of robots.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bandwidth {
    /// On all topics, in all roles.
    #[serde(flatten)]
    pub total: Directions,
    /// On each topic.
    pub by_topic: Named<TopicBandwidth>,
    /// While in each role.
    pub by_role: Named<Directions>,
}

/// Bandwidth on one topic.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TopicBandwidth {
    /// Sent and received.
    #[serde(flatten)]
    pub directions: Directions,
    /// Meant for a robot and lost, headers included.
    pub lost_bytes_per_step: Spread,
    /// Share of headers in the bytes sent, over all trials; `None` if nothing was sent.
    pub header_share: Quantity<Option<f64>>,
}

/// Bandwidth sent (tx) and received (rx), each with headers and as payload alone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Directions {
    /// Sent, headers included; a broadcast counts once.
    pub tx_bytes_per_step: Spread,
    /// Received, headers included.
    pub rx_bytes_per_step: Spread,
    /// Sent, payload alone.
    pub tx_payload_bytes_per_step: Spread,
    /// Received, payload alone.
    pub rx_payload_bytes_per_step: Spread,
}

/// How a bandwidth spreads over robots and trials; absent without a robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Least of any robot in any trial.
    pub min: Option<f64>,
    /// Median over robots and trials (quantiles of type 7).
    pub median: Option<f64>,
    /// 95th percentile over robots and trials.
    pub p95: Option<f64>,
    /// Greatest of any robot in any trial.
    pub max: Option<f64>,
    /// Mean over trials of each trial's mean over robots.
    pub mean: Estimate,
    /// Always `"B/step"`.
    pub unit: Unit,
}

/// How unevenly robots share the load: the Gini coefficient of their bytes in a trial, 0 when all carry the same.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LoadImbalance {
    /// Of bytes sent, headers included: mean over trials.
    pub tx: Estimate,
    /// Of bytes received, headers included: mean over trials.
    pub rx: Estimate,
    /// Always `"1"`.
    pub unit: Unit,
}

impl Bandwidth {
    pub(super) fn of(topics: &[&str], roles: &[&str], records: &[TrialRecord]) -> Self {
        let of_role = |role| Directions::of(records, |row| usize::from(row.role) == role);
        Self {
            total: Directions::of(records, |_| true),
            by_topic: Named::of(topics.iter().copied(), |topic| TopicBandwidth::of(records, topic)),
            by_role: Named::of(roles.iter().copied(), of_role),
        }
    }
}

impl TopicBandwidth {
    fn of(records: &[TrialRecord], topic: usize) -> Self {
        let is_its = |row: &TrafficRow| usize::from(row.topic) == topic;
        let sent = || {
            records
                .iter()
                .flat_map(|record| &record.traffic)
                .filter(|row| is_its(row))
                .map(|row| row.sent)
        };
        let headers: u64 = sent().map(|volume| volume.header_bytes).sum();
        let bytes: u64 = sent().map(Volume::bytes).sum();
        Self {
            directions: Directions::of(records, is_its),
            lost_bytes_per_step: Spread::of(records, |row| u64::from(is_its(row)) * lost_bytes(row)),
            header_share: Quantity {
                value: (bytes > 0).then(|| headers as f64 / bytes as f64),
                unit: DIMENSIONLESS.into(),
            },
        }
    }
}

fn lost_bytes(row: &TrafficRow) -> u64 {
    row.lost.into_iter().map(Volume::bytes).sum()
}

impl Directions {
    /// Of the rows that `counts` accepts.
    fn of(records: &[TrialRecord], counts: impl Fn(&TrafficRow) -> bool) -> Self {
        let spread = |bytes: fn(&TrafficRow) -> u64| Spread::of(records, |row| u64::from(counts(row)) * bytes(row));
        Self {
            tx_bytes_per_step: spread(|row| row.sent.bytes()),
            rx_bytes_per_step: spread(|row| row.received.bytes()),
            tx_payload_bytes_per_step: spread(|row| row.sent.payload_bytes),
            rx_payload_bytes_per_step: spread(|row| row.received.payload_bytes),
        }
    }
}

impl Spread {
    /// Of each robot's sum of `bytes` over its rows.
    fn of(records: &[TrialRecord], bytes: impl Fn(&TrafficRow) -> u64) -> Self {
        let trials: Vec<Vec<f64>> = records.iter().map(|record| record.bytes_per_step(&bytes)).collect();
        let means: Vec<f64> = trials.iter().filter_map(|robots| mean(robots).value).collect();
        let mut pooled = trials.concat();
        pooled.sort_by(f64::total_cmp);
        Self {
            min: pooled.first().copied(),
            median: quantile(&pooled, 0.5),
            p95: quantile(&pooled, 0.95),
            max: pooled.last().copied(),
            mean: mean(&means),
            unit: "B/step".into(),
        }
    }
}

impl LoadImbalance {
    pub(super) fn of(figures: &Figures) -> Self {
        Self {
            tx: figures.estimate("load_imbalance.tx"),
            rx: figures.estimate("load_imbalance.rx"),
            unit: DIMENSIONLESS.into(),
        }
    }
}
