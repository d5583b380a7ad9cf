//! From the tables of a results folder back to the records that they were written from.

use std::collections::BTreeMap;

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

/// The records that are being put together, by number of trial.
pub struct Records<'a> {
    pub names: &'a NameLists,
    pub(super) by_trial: BTreeMap<u32, TrialRecord>,
}

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
