//! From the tables of a results folder back to the records that they were written from.

use std::collections::BTreeMap;

use super::table::{Table, Wrong};
use super::{failures, swarm, traffic};
use crate::engine::{SimTime, Span};
use crate::metrics::detection::DetectionRecord;
use crate::metrics::{LatencyHistogram, Outcome, TopicFates, TrialRecord};

/// What the tables call topics and roles, in the order of their numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NameLists {
    /// Topics.
    pub topics: Vec<String>,
    /// Roles.
    pub roles: Vec<String>,
}

impl NameLists {
    pub(super) fn topic(&self, name: &str) -> Result<u8, Wrong> {
        number(&self.topics, name, "topic")
    }

    pub(super) fn role(&self, name: &str) -> Result<u8, Wrong> {
        number(&self.roles, name, "role")
    }
}

fn number(names: &[String], name: &str, what: &str) -> Result<u8, Wrong> {
    let place = names.iter().position(|known| known == name);
    let place = place.and_then(|place| u8::try_from(place).ok());
    place.ok_or_else(|| format!("summary.json knows no {what} `{name}`"))
}

/// The records that are being put together, by number of trial.
pub struct Records<'a> {
    pub names: &'a NameLists,
    by_trial: BTreeMap<u32, TrialRecord>,
}

/// How a table's rows are put into the records.
pub type Fill = fn(&mut Records, &Table) -> Result<(), Wrong>;

/// The tables and what is read of them, the trials first. Paths are the bulk of a result and no report needs them.
pub const TABLES: [(&str, Fill); 11] = [
    ("trials.parquet", trials),
    ("frames.parquet", traffic::frames),
    ("bandwidth.parquet", traffic::bandwidth),
    ("latency.parquet", traffic::latency),
    ("series.parquet", traffic::series),
    ("connectivity.parquet", swarm::connectivity),
    ("robots.parquet", swarm::robots),
    ("detection.parquet", failures::detection),
    ("faults.parquet", failures::faults),
    ("healing.parquet", failures::healing),
    ("spread.parquet", traffic::spread),
];

/// Tables that are there only where there is something to put into them.
pub const OPTIONAL: [(&str, Fill); 1] = [("notes.parquet", traffic::notes)];

impl<'a> Records<'a> {
    pub fn new(names: &'a NameLists) -> Self {
        Self {
            names,
            by_trial: BTreeMap::new(),
        }
    }

    /// The records, in order of trials.
    pub fn finish(self) -> Vec<TrialRecord> {
        self.by_trial.into_values().collect()
    }

    pub fn of(&mut self, trial: u32) -> Result<&mut TrialRecord, Wrong> {
        self.by_trial
            .get_mut(&trial)
            .ok_or_else(|| format!("it has rows of trial {trial}, of which trials.parquet has none"))
    }
}

fn trials(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, seed) = (table.ids("trial")?, table.keys("seed")?);
    let (outcome, steps) = (table.texts("outcome")?, table.counts("steps")?);
    let completed = table.optional_counts("steps_to_completion")?;
    let (period, simulated) = (table.numbers("control_period_s")?, table.numbers("simulated_s")?);
    let (events, digest) = (table.counts("events")?, table.texts("digest")?);
    let pairs = table.counts("pairs")?;
    let (monitored, mistaken) = (table.numbers("monitored_s")?, table.numbers("mistaken_s")?);
    for row in 0..trial.len() {
        let outcome = match (outcome[row].as_str(), completed[row]) {
            ("completed", Some(step)) => Outcome::Completed { step },
            ("censored", None) => Outcome::Censored,
            ("no_mission", None) => Outcome::NoMission,
            (other, step) => return Err(format!("trial {} ended `{other}` at step {step:?}", trial[row])),
        };
        let digest = u128::from_str_radix(&digest[row], 16).map_err(|_| format!("`{}` is no digest", digest[row]))?;
        let record = TrialRecord {
            trial: trial[row],
            seed: seed[row],
            outcome,
            steps: steps[row],
            control_period: Span::from_secs(period[row]),
            simulated: SimTime::from_secs(simulated[row]),
            events: events[row],
            digest,
            ledger: vec![TopicFates::default(); records.names.topics.len()],
            traffic: Vec::new(),
            latency: LatencyHistogram::default(),
            detection: DetectionRecord {
                pairs: pairs[row],
                monitored_s: monitored[row],
                mistaken_s: mistaken[row],
                ..DetectionRecord::default()
            },
            faults: Vec::new(),
            healing: Vec::new(),
            spread: Vec::new(),
            noted: Vec::new(),
            connectivity: Vec::new(),
            series: Vec::new(),
            robots: Vec::new(),
            trajectories: Vec::new(),
            trace: None,
        };
        records.by_trial.insert(trial[row], record);
    }
    let [least, most] = ["latency_min_ns", "latency_max_ns"].map(|name| table.optional_keys(name));
    let (least, most, sum) = (least?, most?, table.optional_numbers("latency_sum_ns")?);
    for (row, trial) in trial.iter().enumerate() {
        if let (Some(least), Some(most), Some(sum)) = (least[row], most[row], sum[row]) {
            let record = records.of(*trial)?;
            record.latency = LatencyHistogram::exactly(least, most, sum as u128);
        }
    }
    Ok(())
}
