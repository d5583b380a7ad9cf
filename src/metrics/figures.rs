//! The figures by which settings are compared, each read off a single trial with the summary's own formulas. A key is the figure's
//! path in `summary.json`, where it has one.
//!
//! Every figure is a ratio of sums over trials. Of a plain one a trial gives its value over 1; of one that a short trial may not
//! have on its own, such as the time between mistakes, what it counts over what it watched. So all are estimated, resampled and
//! tested alike, and no trial is left out.

use std::rc::Rc;

use serde::{Deserialize, Serialize};

use super::record::{TrafficRow, TrialRecord};
use super::statistics::{Part, quantile};
use super::summary::detection::{detection_times, durations, mistakes};
use super::summary::faults::mending;
use super::summary::frames::delivery_ratio;
use super::summary::spread::{duplicate_ratio, informed_ratio};
use super::summary::{DIMENSIONLESS, SECONDS, STEPS, Unit, completion};
use crate::engine::Span;

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
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Numerator and denominator; both 0 where the trial tells nothing.
    pub part: Part,
    /// Whether the value was cut off: it would have grown larger, had the trial gone on.
    pub is_censored: bool,
}

impl Sample {
    /// The trial's own value, if it has one.
    #[must_use]
    pub fn value(&self) -> Option<f64> {
        (self.part[1] > 0.0).then(|| self.part[0] / self.part[1])
    }

    fn ratio(part: Part) -> Self {
        Self {
            part,
            is_censored: false,
        }
    }

    fn plain(value: Option<f64>) -> Self {
        Self::ratio(value.map_or([0.0; 2], |value| [value, 1.0]))
    }
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
        registry.gossip();
        registry
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

    fn add(
        &mut self,
        key: &str,
        name: &str,
        (unit, better): (&'static str, Better),
        reading: impl Fn(&TrialRecord) -> Sample + 'static,
    ) {
        let figure = Figure {
            key: key.to_owned(),
            name: name.to_owned(),
            unit: unit.into(),
            better,
            is_ratio: false,
        };
        self.figures.push((figure, Rc::new(reading)));
    }

    fn add_plain(
        &mut self,
        key: &str,
        name: &str,
        kind: (&'static str, Better),
        reading: impl Fn(&TrialRecord) -> Option<f64> + 'static,
    ) {
        self.add(key, name, kind, move |record| Sample::plain(reading(record)));
    }

    fn add_ratio(
        &mut self,
        key: &str,
        name: &str,
        kind: (&'static str, Better),
        reading: impl Fn(&TrialRecord) -> Part + 'static,
    ) {
        self.add(key, name, kind, move |record| Sample::ratio(reading(record)));
        if let Some((figure, _)) = self.figures.last_mut() {
            figure.is_ratio = true;
        }
    }

    fn mission(&mut self) {
        self.add(COMPLETION, "steps to completion", (STEPS, Better::Lower), |record| {
            completion(record).map_or(Sample::default(), |seen| Sample {
                part: [seen.time, 1.0],
                is_censored: !seen.happened,
            })
        });
        let share = (DIMENSIONLESS, Better::Higher);
        self.add_plain("completion_ratio", "trials completed", share, |record| {
            completion(record).map(|seen| f64::from(u8::from(seen.happened)))
        });
        self.add_plain("robots_used", "robots used", ("robots", Better::Lower), |record| {
            record.robots_used().map(|robots| robots as f64)
        });
        self.add_plain("lambda2_min", "least λ₂", share, TrialRecord::lambda2_min);
        self.add_plain(
            "connected_share",
            "time in one piece",
            share,
            TrialRecord::connected_share,
        );
    }

    fn radio(&mut self) {
        let kind = (DIMENSIONLESS, Better::Higher);
        self.add_plain("delivery_ratio", "copies delivered", kind, delivery_ratio);
        let kind = (SECONDS, Better::Lower);
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
    }

    /// Bytes a robot and step of the rows that `counts` accepts, over the robots of a trial.
    fn traffic(&mut self, prefix: &str, topic: &str, counts: impl Fn(&TrafficRow) -> bool + Copy + 'static) {
        type Bytes = fn(&TrafficRow) -> u64;
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
                self.add_plain(&key, &name, ("B/step", Better::Lower), move |record| {
                    let mut robots = record.bytes_per_step(|row| u64::from(counts(row)) * bytes(row));
                    robots.sort_by(f64::total_cmp);
                    let mean = || Some(robots.iter().sum::<f64>() / robots.len() as f64).filter(|_| !robots.is_empty());
                    q.map_or_else(mean, |q| quantile(&robots, q))
                });
            }
        }
    }

    fn detection(&mut self) {
        let (less, more) = ((SECONDS, Better::Lower), (SECONDS, Better::Higher));
        let count = |record: &TrialRecord| mistakes(&record.detection).count() as f64;
        self.add_ratio("detection.detection_time_s", "detection time T_D", less, |record| {
            detection_times(&record.detection)
        });
        self.add_ratio(
            "detection.mistake_rate_hz",
            "mistake rate λ_M",
            ("Hz", Better::Lower),
            move |record| [count(record), record.detection.monitored_s],
        );
        self.add_ratio(
            "detection.mistake_recurrence_s",
            "mistake recurrence T_MR",
            more,
            move |record| [record.detection.monitored_s, count(record)],
        );
        self.add_ratio("detection.mistake_duration_s", "mistake duration T_M", less, |record| {
            durations(&record.detection)
        });
        let share = (DIMENSIONLESS, Better::Higher);
        self.add_ratio("detection.query_accuracy", "query accuracy P_A", share, |record| {
            let seen = &record.detection;
            [seen.monitored_s - seen.mistaken_s, seen.monitored_s]
        });
    }

    fn gossip(&mut self) {
        let (more, less) = ((DIMENSIONLESS, Better::Higher), (DIMENSIONLESS, Better::Lower));
        self.add_plain(
            "spread.informed_ratio",
            "robots informed at the end",
            more,
            informed_ratio,
        );
        self.add_plain("duplicates", "duplicates in messages delivered", less, |record| {
            duplicate_ratio(record, |_| true)
        });
    }

    fn healing(&mut self) {
        let harmful = |record: &TrialRecord| {
            let episodes = record.healing.iter().filter(|episode| episode.is_harmful());
            let seen: Vec<_> = episodes.map(|episode| mending(episode, record.simulated)).collect();
            seen
        };
        self.add_ratio(
            "healing.unmended_s",
            "time unmended, a failure",
            (SECONDS, Better::Lower),
            move |record| {
                let seen = harmful(record);
                [seen.iter().map(|seen| seen.time).sum(), seen.len() as f64]
            },
        );
        self.add_ratio(
            "healing.healed_ratio",
            "failures healed",
            (DIMENSIONLESS, Better::Higher),
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
