//! What robots send and receive. A robot's bandwidth in a trial is its bytes over its control steps that were due in the trial, in all of
//! which it counts, also while it was down: topics and roles thus add up to the whole.

use serde::{Deserialize, Serialize};

use crate::metrics::record::TrialRecord;
use crate::metrics::unit::{DIMENSIONLESS, Unit};
use crate::metrics::volume::{TrafficRow, Volume};
use crate::spool::{Columns, Scratch};
use crate::statistics::{Estimate, mean, mean_value, quantile};

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

/// Bytes of a row of traffic.
type Bytes = fn(&TrafficRow) -> u64;

/// What [`Directions`] are of, in order.
const WAYS: [Bytes; 4] = [
    |row| row.sent.bytes(),
    |row| row.received.bytes(),
    |row| row.sent.payload_bytes,
    |row| row.received.payload_bytes,
];

/// Whose bytes are counted.
#[derive(Clone, Copy)]
enum Whose {
    All,
    Topic(usize),
    Role(usize),
}

impl Whose {
    fn has(self, row: &TrafficRow) -> bool {
        match self {
            Self::All => true,
            Self::Topic(topic) => usize::from(row.topic) == topic,
            Self::Role(role) => usize::from(row.role) == role,
        }
    }
}

/// What robots carried, over the trials that were counted: every [`Spread`] is a column.
pub(super) struct Loads {
    counted: Vec<(Whose, Bytes)>,
    /// A row a robot and trial.
    robots: Columns,
    /// A row a trial: the mean of its robots.
    means: Columns,
    /// What was sent on each topic.
    sent: Vec<Volume>,
}

impl Loads {
    /// None yet, of so many topics and roles.
    pub fn new(topics: usize, roles: usize) -> Self {
        let ways = |whose: Whose| WAYS.map(|bytes| (whose, bytes));
        let mut counted = ways(Whose::All).to_vec();
        for topic in (0..topics).map(Whose::Topic) {
            counted.extend(ways(topic));
            counted.push((topic, lost_bytes));
        }
        counted.extend((0..roles).map(Whose::Role).flat_map(ways));
        let columns = || Columns::new(counted.len(), &Scratch::default());
        Self {
            robots: columns(),
            means: columns(),
            sent: vec![Volume::default(); topics],
            counted,
        }
    }

    /// Takes in a trial.
    pub fn count(&mut self, record: &TrialRecord) {
        let carried = self
            .counted
            .iter()
            .map(|(whose, bytes)| record.bytes_per_step(|row| if whose.has(row) { bytes(row) } else { 0 }));
        let carried: Vec<Vec<f64>> = carried.collect();
        for robot in 0..record.robots.len() {
            self.robots.push(carried.iter().map(|robots| robots[robot]));
        }
        if !record.robots.is_empty() {
            self.means.push(carried.iter().filter_map(|robots| mean_value(robots)));
        }
        for row in &record.traffic {
            if let Some(sum) = self.sent.get_mut(usize::from(row.topic)) {
                sum.frames += row.sent.frames;
                sum.payload_bytes += row.sent.payload_bytes;
                sum.header_bytes += row.sent.header_bytes;
            }
        }
    }

    fn spread(&self, column: usize) -> Spread {
        let mut pooled = self.robots.column(column);
        pooled.sort_unstable_by(f64::total_cmp);
        Spread {
            min: pooled.first().copied(),
            median: quantile(&pooled, 0.5),
            p95: quantile(&pooled, 0.95),
            max: pooled.last().copied(),
            mean: mean(&self.means.column(column)),
            unit: "B/step".into(),
        }
    }

    /// From column number `first` on.
    fn directions(&self, first: usize) -> Directions {
        let [tx, rx, tx_payload, rx_payload] = [0, 1, 2, 3].map(|way| self.spread(first + way));
        Directions {
            tx_bytes_per_step: tx,
            rx_bytes_per_step: rx,
            tx_payload_bytes_per_step: tx_payload,
            rx_payload_bytes_per_step: rx_payload,
        }
    }

    fn topic(&self, topic: usize, first: usize) -> TopicBandwidth {
        let sent = self.sent[topic];
        let bytes = sent.bytes();
        TopicBandwidth {
            directions: self.directions(first),
            lost_bytes_per_step: self.spread(first + WAYS.len()),
            header_share: Quantity {
                value: (bytes > 0).then(|| sent.header_bytes as f64 / bytes as f64),
                unit: DIMENSIONLESS.into(),
            },
        }
    }
}

fn lost_bytes(row: &TrafficRow) -> u64 {
    row.lost.into_iter().map(Volume::bytes).sum()
}

impl Bandwidth {
    /// By these names of the topics and roles of `loads`, whose columns are those of all, of topics and of roles.
    pub(super) fn of(topics: &[&str], roles: &[&str], loads: &Loads) -> Self {
        let a_topic = WAYS.len() + 1;
        let of_role = |role: usize| loads.directions(WAYS.len() * (role + 1) + topics.len() * a_topic);
        Self {
            total: loads.directions(0),
            by_topic: Named::of(topics.iter().copied(), |topic| {
                loads.topic(topic, WAYS.len() + topic * a_topic)
            }),
            by_role: Named::of(roles.iter().copied(), of_role),
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
