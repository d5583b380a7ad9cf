//! What the trials of a scenario tell of its summary, gathered one by one: what of a record grows with simulated time is read and let go.

use crate::metrics::figures::{Registry, Sample};
use crate::metrics::record::{Lists, TrialRecord};

use super::Summary;
use super::air::Radios;
use super::detection::Beliefs;
use super::missed::FailedTrial;

/// The trials of a summary, in order.
pub struct Trials<'a> {
    pub(super) registry: &'a Registry,
    /// By figure, what each trial tells of it.
    pub(super) samples: Vec<Vec<Sample>>,
    /// The records, without their long lists.
    pub(super) records: Vec<TrialRecord>,
    pub(super) failed: Vec<FailedTrial>,
    pub(super) beliefs: Beliefs,
    pub(super) radios: Radios,
}

impl<'a> Trials<'a> {
    /// None yet, to be summarised by the figures of `registry`, which has at least those that desim ships for the protocol's topics.
    #[must_use]
    pub fn new(registry: &'a Registry) -> Self {
        Self {
            registry,
            samples: registry.figures().map(|_| Vec::new()).collect(),
            records: Vec::new(),
            failed: Vec::new(),
            beliefs: Beliefs::default(),
            radios: Radios::default(),
        }
    }

    /// Takes in the next trial.
    pub fn add(&mut self, mut record: TrialRecord) {
        for (samples, sample) in self.samples.iter_mut().zip(self.registry.read(&record)) {
            samples.push(sample);
        }
        self.failed.extend(FailedTrial::of(&record));
        self.beliefs.count(&record.detection);
        self.radios.count(&record);
        record.exchange(&mut Lists::default());
        record.pairs = Vec::new();
        record.asked.delivery = Vec::new();
        record.air = None;
        self.records.push(record);
    }

    /// The figures of all of them, of the scenario called `scenario`; `topics` and `roles` are the names that its protocol gives them.
    #[must_use]
    pub fn summary(self, scenario: &str, topics: &[&str], roles: &[&str]) -> Summary {
        Summary::put_together(self, scenario, topics, roles)
    }
}
