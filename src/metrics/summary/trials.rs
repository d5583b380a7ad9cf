//! What the trials of a scenario tell of its summary, gathered one by one: each is read and let go.

use xxhash_rust::xxh3::Xxh3;

use super::Summary;
use super::air::Radios;
use super::bandwidth::Loads;
use super::detection::Beliefs;
use super::faults::{Failed, Healings};
use super::frames::Ledger;
use super::missed::FailedTrial;
use super::spread::Rumors;
use crate::metrics::LatencyHistogram;
use crate::metrics::figures::{Registry, Samples, completion};
use crate::metrics::record::{Outcome, TrialRecord};
use crate::statistics::Observation;

/// The trials of a summary, in order. What adds up is added up; of the rest memory holds little a trial, and a file without a name the
/// rest, so that there may be any number of them.
pub struct Trials<'a> {
    pub(super) registry: &'a Registry,
    pub(super) topics: &'a [&'a str],
    pub(super) roles: &'a [&'a str],
    pub(super) count: u64,
    pub(super) completed: u64,
    /// Of the trials' digests.
    pub(super) digest: Xxh3,
    pub(super) steps: u64,
    pub(super) simulated_s: f64,
    pub(super) samples: Samples,
    /// Steps until missions were complete, or that they were watched in vain.
    pub(super) missions: Vec<Observation>,
    pub(super) failed: Vec<FailedTrial>,
    pub(super) ledger: Ledger,
    pub(super) latency: LatencyHistogram,
    pub(super) radios: Radios,
    pub(super) loads: Loads,
    pub(super) faults: Failed,
    pub(super) healings: Healings,
    pub(super) rumors: Rumors,
    pub(super) beliefs: Beliefs,
}

impl<'a> Trials<'a> {
    /// None yet, to be summarised by the figures of `registry`, which has at least those that desim ships for the protocol's topics; `topics`
    /// and `roles` are the names that the protocol gives them.
    #[must_use]
    pub fn new(registry: &'a Registry, topics: &'a [&'a str], roles: &'a [&'a str]) -> Self {
        Self {
            registry,
            topics,
            roles,
            count: 0,
            completed: 0,
            digest: Xxh3::new(),
            steps: 0,
            simulated_s: 0.0,
            samples: Samples::new(registry.figures().count()),
            missions: Vec::new(),
            failed: Vec::new(),
            ledger: Ledger::default(),
            latency: LatencyHistogram::default(),
            radios: Radios::default(),
            loads: Loads::new(topics.len(), roles.len()),
            faults: Failed::default(),
            healings: Healings::new(topics.len(), roles.len()),
            rumors: Rumors::default(),
            beliefs: Beliefs::default(),
        }
    }

    /// Takes in the next trial.
    pub fn add(&mut self, record: &TrialRecord) {
        self.count += 1;
        self.completed += u64::from(matches!(record.outcome, Outcome::Completed { .. }));
        self.digest.update(&record.digest.to_le_bytes());
        self.steps += record.steps;
        self.simulated_s += record.simulated.as_secs();
        self.samples.push(&self.registry.read(record));
        self.missions.extend(completion(record));
        self.failed.extend(FailedTrial::of(record));
        self.ledger.count(record);
        self.latency.merge(&record.latency);
        self.radios.count(record);
        self.loads.count(record);
        self.faults.count(record);
        self.healings.count(record);
        self.rumors.count(record);
        self.beliefs.count(&record.detection);
    }

    /// The figures of all of them, of the scenario called `scenario`.
    #[must_use]
    pub fn summary(self, scenario: &str) -> Summary {
        Summary::put_together(&self, scenario)
    }
}
