//! In place of reading tables, in a build without the `parquet` feature: nothing is read.

use std::collections::BTreeMap;
use std::fs::File;

use crate::metrics::TrialRecord;
use crate::metrics::figures::Told;
use crate::spool::Section;

/// What the tables call topics and roles, in the order of their numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NameLists {
    /// Topics.
    pub topics: Vec<String>,
    /// Roles.
    pub roles: Vec<String>,
}

/// Names of the tables that are read: one, to say that it cannot be.
pub const READ: [&str; 1] = ["trials.parquet"];

/// Names of tables that may be there: none.
pub const OPTIONAL: [&str; 0] = [];

/// No records.
pub struct Reader;

impl Reader {
    /// Nothing.
    ///
    /// # Errors
    /// Always.
    pub fn new(_: &BTreeMap<String, Section>, _: &NameLists) -> Result<Self, (&'static str, String)> {
        Err((READ[0], "this desim was built without Parquet".to_owned()))
    }
}

impl Iterator for Reader {
    type Item = Result<TrialRecord, (&'static str, String)>;

    fn next(&mut self) -> Option<Self::Item> {
        None
    }
}

/// Nothing.
///
/// # Errors
/// Always.
pub fn told(_: File, _: &str) -> Result<BTreeMap<String, Vec<Told>>, String> {
    Err("this desim was built without Parquet".to_owned())
}
