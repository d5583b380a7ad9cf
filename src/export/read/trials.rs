//! The trials themselves.

use super::records::Records;
use super::table::{Table, Wrong};
use crate::engine::{SimTime, Span};
use crate::metrics::detection::DetectionRecord;
use crate::metrics::{Asked, LatencyHistogram, Outcome, TopicFates, TrialRecord};
use crate::spool::Spool;

/// Begins the record of the row of `trials.parquet`.
pub fn trials(records: &mut Records, table: &Table) -> Result<(), Wrong> {
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
            pairs: Vec::new(),
            air: None,
            asked: Asked::default(),
            connectivity: Spool::default(),
            series: Spool::default(),
            robots: Vec::new(),
            trajectories: Spool::default(),
            trace: None,
        };
        records.begin(record);
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
