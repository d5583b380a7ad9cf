//! The figures of a protocol, each declared once: its key, how it is read off a trial, and how it is estimated from trials. The summary of a
//! scenario and the comparison of settings both take them from here. A key is the figure's path in `summary.json`, where it has one.
//!
//! Every figure is a ratio of sums over trials. Of a plain one a trial gives its value over 1; of one that a short trial may not
//! have on its own, such as the time between mistakes, what it counts over what it watched; of times that may be cut off, the sum of
//! their pseudo-values over their number. So all are estimated and tested alike, and no trial is left out.

use std::rc::Rc;

use serde::{Deserialize, Serialize};

use super::noted_figure::NotedFigure;
use super::record::{TrafficRow, TrialRecord};
use super::summary::detection::{detection_times, mistake_durations, mistakes};
use super::summary::faults::mending;
use super::summary::frames::delivery;
use super::summary::spread::{duplicates, informed_ratio};
use super::summary::{DIMENSIONLESS, SECONDS, STEPS, Unit, completion};
use crate::engine::Span;
use crate::statistics::{Estimate, Estimator, Lasting, Observation, Part, gini, mean, pseudo_values, quantile};

/// Key of the steps until a mission is complete.
pub const COMPLETION: &str = "steps_to_completion";

/// What a figure is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Figure {
    /// Its key.
    pub key: String,
    /// What reports call it.
    pub name: String,
    /// Its unit.
    pub unit: Unit,
    /// Which way is better.
    pub better: Better,
    /// Whether it is a ratio of sums, which a trial may not have on its own; otherwise a mean over trials.
    pub is_ratio: bool,
    /// How it is estimated.
    pub estimator: Estimator,
}

/// Which way a figure is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Better {
    /// The less the better.
    Lower,
    /// The more the better.
    Higher,
}

/// What a trial tells of a figure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sample {
    /// Numerator and denominator; both 0 where the trial tells nothing.
    pub part: Part,
    /// Whether the value was cut off: it would have grown larger, had the trial gone on.
    pub is_censored: bool,
    /// The times that the trial tells of, where the figure is their mean; empty for other figures. Its part follows from those of all
    /// trials: see [`pool`].
    pub times: Vec<Observation>,
}

impl Sample {
    /// The trial's own value, if it has one.
    #[must_use]
    pub fn value(&self) -> Option<f64> {
        (self.part[1] > 0.0).then(|| self.part[0] / self.part[1])
    }

    pub(super) fn ratio(part: Part) -> Self {
        Self {
            part,
            ..Self::default()
        }
    }

    pub(super) fn plain(value: Option<f64>) -> Self {
        Self::ratio(value.map_or([0.0; 2], |value| [value, 1.0]))
    }

    fn times(times: Vec<Observation>) -> Self {
        Self {
            is_censored: times.iter().any(|seen| !seen.happened),
            times,
            ..Self::default()
        }
    }
}

/// Gives the samples of one setting and figure their parts where these follow from the times of all trials. Other samples stay as they
/// are.
pub fn pool(samples: &mut [Sample]) -> Option<Lasting> {
    let times: Vec<&[Observation]> = samples.iter().map(|sample| sample.times.as_slice()).collect();
    if times.iter().all(|times| times.is_empty()) {
        return None;
    }
    let (parts, lasting) = pseudo_values(&times);
    for (sample, part) in samples.iter_mut().zip(parts) {
        sample.part = part;
    }
    Some(lasting)
}

/// How a figure is read off a trial.
type Reading = Rc<dyn Fn(&TrialRecord) -> Sample>;

/// The figures of a protocol.
pub struct Registry {
    figures: Vec<(Figure, Reading)>,
}

impl Registry {
    /// The figures of a protocol that gives its topics these names.
    #[must_use]
    pub fn of(topics: &[&str]) -> Self {
        let mut registry = Self { figures: Vec::new() };
        registry.mission();
        registry.radio();
        registry.bandwidth(topics);
        registry.detection();
        registry.healing();
        registry.gossip(topics);
        registry
    }

    /// The same, and those of what the protocol's robots note.
    #[must_use]
    pub fn noting(mut self, noted: &[NotedFigure]) -> Self {
        for &noted in noted {
            let reading: Reading = Rc::new(move |record| noted.read(record));
            self.figures.push((noted.figure(), reading));
        }
        self
    }

    /// What the figures are, in order.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.figures.iter().map(|(figure, _)| figure)
    }

    /// What a trial tells of each figure, in order.
    #[must_use]
    pub fn read(&self, record: &TrialRecord) -> Vec<Sample> {
        self.figures.iter().map(|(_, reading)| reading(record)).collect()
    }

    /// The figure called `key` over the trials of `records`, and what is known of its times if it is their mean. Nothing where there is no
    /// such figure.
    #[must_use]
    pub fn estimate(&self, key: &str, records: &[TrialRecord]) -> (Estimate, Lasting) {
        let Some((figure, reading)) = self.figures.iter().find(|(figure, _)| figure.key == key) else {
            return Default::default();
        };
        let mut samples: Vec<Sample> = records.iter().map(|record| reading(record)).collect();
        let lasting = pool(&mut samples).unwrap_or_default();
        (figure.estimate(&samples), lasting)
    }

    fn add(
        &mut self,
        key: &str,
        name: &str,
        (unit, better, estimator): Kind,
        reading: impl Fn(&TrialRecord) -> Sample + 'static,
    ) {
        let figure = Figure {
            key: key.to_owned(),
            name: name.to_owned(),
            unit: unit.into(),
            better,
            is_ratio: false,
            estimator,
        };
        self.figures.push((figure, Rc::new(reading)));
    }

    fn add_plain(
        &mut self,
        key: &str,
        name: &str,
        kind: Kind,
        reading: impl Fn(&TrialRecord) -> Option<f64> + 'static,
    ) {
        self.add(key, name, kind, move |record| Sample::plain(reading(record)));
    }

    fn add_ratio(&mut self, key: &str, name: &str, kind: Kind, reading: impl Fn(&TrialRecord) -> Part + 'static) {
        self.add_as_ratio(key, name, kind, move |record| Sample::ratio(reading(record)));
    }

    fn add_times(&mut self, key: &str, name: &str, reading: impl Fn(&TrialRecord) -> Vec<Observation> + 'static) {
        let kind = (SECONDS, Better::Lower, Estimator::Times);
        self.add_as_ratio(key, name, kind, move |record| Sample::times(reading(record)));
    }

    fn add_as_ratio(&mut self, key: &str, name: &str, kind: Kind, reading: impl Fn(&TrialRecord) -> Sample + 'static) {
        self.add(key, name, kind, reading);
        if let Some((figure, _)) = self.figures.last_mut() {
            figure.is_ratio = true;
        }
    }

    fn mission(&mut self) {
        let steps = (STEPS, Better::Lower, Estimator::Count);
        self.add(COMPLETION, "steps to completion", steps, |record| {
            completion(record).map_or(Sample::default(), |seen| Sample {
                part: [seen.time, 1.0],
                is_censored: !seen.happened,
                times: Vec::new(),
            })
        });
        let share = (DIMENSIONLESS, Better::Higher, Estimator::Share);
        self.add_plain("completion_ratio", "trials completed", share, |record| {
            completion(record).map(|seen| f64::from(u8::from(seen.happened)))
        });
        let robots = ("robots", Better::Lower, Estimator::Count);
        self.add_plain("robots_used", "robots used", robots, |record| {
            record.robots_used().map(|robots| robots as f64)
        });
        let lambda2 = (DIMENSIONLESS, Better::Higher, Estimator::Median);
        self.add_plain("lambda2_min", "least λ₂", lambda2, TrialRecord::lambda2_min);
        self.add_plain(
            "connected_share",
            "time in one piece",
            share,
            TrialRecord::connected_share,
        );
    }

    fn radio(&mut self) {
        let kind = (DIMENSIONLESS, Better::Higher, Estimator::ShareOf);
        self.add_ratio("delivery_ratio", "copies delivered", kind, delivery);
        let kind = (SECONDS, Better::Lower, Estimator::Mean);
        for (key, name, q) in [
            ("latency_s.p50", "latency, median", 0.5),
            ("latency_s.p95", "latency, 95th percentile", 0.95),
            ("latency_s.p99", "latency, 99th percentile", 0.99),
        ] {
            self.add_plain(key, name, kind, move |record| {
                record.latency.quantile(q).map(Span::as_secs)
            });
        }
        self.add_plain("latency_s.mean", "latency, mean", kind, |record| {
            record.latency.mean_secs()
        });
    }

    fn bandwidth(&mut self, topics: &[&str]) {
        self.traffic("bandwidth", "", |_| true);
        for (number, topic) in topics.iter().enumerate() {
            let is_its = move |row: &TrafficRow| usize::from(row.topic) == number;
            self.traffic(&format!("bandwidth.by_topic.{topic}"), &format!("{topic}: "), is_its);
        }
        let even = (DIMENSIONLESS, Better::Lower, Estimator::Fraction);
        let ways: [(&str, &str, Bytes); 2] = [
            ("load_imbalance.tx", "Gini of bytes sent", |row| row.sent.bytes()),
            ("load_imbalance.rx", "Gini of bytes received", |row| {
                row.received.bytes()
            }),
        ];
        for (key, name, bytes) in ways {
            self.add_plain(key, name, even, move |record| gini(&record.bytes_per_step(bytes)));
        }
    }

    /// Bytes a robot and step of the rows that `counts` accepts, over the robots of a trial.
    fn traffic(&mut self, prefix: &str, topic: &str, counts: impl Fn(&TrafficRow) -> bool + Copy + 'static) {
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
                self.add_plain(&key, &name, kind, move |record| {
                    let mut robots = record.bytes_per_step(|row| u64::from(counts(row)) * bytes(row));
                    let Some(q) = q else {
                        return mean(&robots).value;
                    };
                    robots.sort_by(f64::total_cmp);
                    quantile(&robots, q)
                });
            }
        }
    }

    fn detection(&mut self) {
        let count = |record: &TrialRecord| mistakes(&record.detection).count() as f64;
        self.add_times("detection.detection_time_s", "detection time T_D", |record| {
            detection_times(&record.detection)
        });
        self.add_ratio(
            "detection.mistake_rate_hz",
            "mistake rate λ_M",
            ("Hz", Better::Lower, Estimator::Rate),
            move |record| [count(record), record.detection.monitored_s],
        );
        self.add_ratio(
            "detection.mistake_recurrence_s",
            "mistake recurrence T_MR",
            (SECONDS, Better::Higher, Estimator::Recurrence),
            move |record| [record.detection.monitored_s, count(record)],
        );
        self.add_times("detection.mistake_duration_s", "mistake duration T_M", |record| {
            mistake_durations(&record.detection)
        });
        let share = (DIMENSIONLESS, Better::Higher, Estimator::Share);
        self.add_ratio("detection.query_accuracy", "query accuracy P_A", share, |record| {
            let seen = &record.detection;
            [seen.monitored_s - seen.mistaken_s, seen.monitored_s]
        });
    }

    fn gossip(&mut self, topics: &[&str]) {
        let more = (DIMENSIONLESS, Better::Higher, Estimator::Share);
        self.add_plain(
            "spread.informed_ratio",
            "robots informed at the end",
            more,
            informed_ratio,
        );
        let less = (DIMENSIONLESS, Better::Lower, Estimator::ShareOf);
        self.add_ratio("duplicates", "duplicates in messages delivered", less, |record| {
            duplicates(record, |_| true)
        });
        for (number, topic) in topics.iter().enumerate() {
            let key = format!("duplicates.by_topic.{topic}");
            self.add_ratio(
                &key,
                &format!("{topic}: duplicates in messages delivered"),
                less,
                move |record| duplicates(record, |row| usize::from(row.topic) == number),
            );
        }
    }

    fn healing(&mut self) {
        let harmful = |record: &TrialRecord| {
            let episodes = record.healing.iter().filter(|episode| episode.is_harmful());
            let seen: Vec<_> = episodes.map(|episode| mending(episode, record.simulated)).collect();
            seen
        };
        self.add_times("healing.unmended_s", "time unmended, a failure", harmful);
        self.add_ratio(
            "healing.healed_ratio",
            "failures healed",
            (DIMENSIONLESS, Better::Higher, Estimator::ShareOf),
            move |record| {
                let seen = harmful(record);
                [
                    seen.iter().filter(|seen| seen.happened).count() as f64,
                    seen.len() as f64,
                ]
            },
        );
    }
}

impl Figure {
    /// The figure over trials, one sample each.
    #[must_use]
    pub fn estimate(&self, samples: &[Sample]) -> Estimate {
        self.estimator.estimate(&parts(samples))
    }
}

/// The parts of trials.
#[must_use]
pub fn parts(samples: &[Sample]) -> Vec<Part> {
    samples.iter().map(|sample| sample.part).collect()
}

/// Bytes of a row of traffic.
type Bytes = fn(&TrafficRow) -> u64;

/// Unit, which way is better, and how it is estimated.
type Kind = (&'static str, Better, Estimator);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_figure_knows_which_way_is_better() {
        let higher = [
            "completion_ratio",
            "lambda2_min",
            "connected_share",
            "delivery_ratio",
            "detection.mistake_recurrence_s",
            "detection.query_accuracy",
            "healing.healed_ratio",
            "spread.informed_ratio",
        ];
        let registry = Registry::of(&["status", "probe"]);
        let mut found: Vec<&str> = registry
            .figures()
            .filter(|figure| figure.better == Better::Higher)
            .map(|figure| figure.key.as_str())
            .collect();
        found.sort_unstable();
        let mut higher = higher.to_vec();
        higher.sort_unstable();
        assert_eq!(
            found, higher,
            "of every other figure less is better: bytes, duplicates, latencies, steps, times of mistakes"
        );
        assert!(
            registry
                .figures()
                .any(|figure| figure.key == "duplicates" && figure.better == Better::Lower)
        );
    }
}
