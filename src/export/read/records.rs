//! From the tables of a results folder back to the records that they were written from.

use super::table::Wrong;
use crate::metrics::TrialRecord;

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

/// The record that is being put together.
pub struct Records<'a> {
    pub names: &'a NameLists,
    record: Option<TrialRecord>,
}

impl<'a> Records<'a> {
    pub fn new(names: &'a NameLists) -> Self {
        Self { names, record: None }
    }

    /// Begins with what `trials.parquet` has of a trial.
    pub fn begin(&mut self, record: TrialRecord) {
        self.record = Some(record);
    }

    /// The number of the trial whose record it is.
    pub fn trial(&self) -> Option<u32> {
        self.record.as_ref().map(|record| record.trial)
    }

    /// The record, as far as it was put together.
    pub fn finish(self) -> Option<TrialRecord> {
        self.record
    }

    /// The record, if it is that of `trial`.
    pub fn of(&mut self, trial: u32) -> Result<&mut TrialRecord, Wrong> {
        let record = self.record.as_mut().filter(|record| record.trial == trial);
        record.ok_or_else(|| stray(trial))
    }
}

/// What is wrong with a table that has rows of `trial`.
pub fn stray(trial: u32) -> Wrong {
    format!("it has rows of trial {trial}, of which trials.parquet has none")
}
