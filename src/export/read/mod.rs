//! A results folder read back: verified file by file against its manifest, its tables turned into the records that they
//! were written from.

mod failures;
mod fill;
mod records;
mod swarm;
mod table;
mod traffic;
mod trials;

use std::collections::BTreeMap;

pub use records::NameLists;

use crate::metrics::TrialRecord;
use fill::{OPTIONAL as MAYBE, TABLES};
use records::Records;
use table::Table;

/// Names of the tables that are read.
pub const READ: [&str; TABLES.len()] = {
    let mut names = [""; TABLES.len()];
    let mut table = 0;
    while table < TABLES.len() {
        names[table] = TABLES[table].0;
        table += 1;
    }
    names
};

/// Names of the tables that are read where they are there.
pub const OPTIONAL: [&str; MAYBE.len()] = [MAYBE[0].0];

/// The records that `files`, the bytes of the tables of [`READ`] and [`OPTIONAL`] by name, were written from, but for their paths and the
/// numbers of the frames that suspicions began with, which no report needs.
///
/// # Errors
/// The table that is not what it should be, and how.
pub fn records(
    files: &mut BTreeMap<String, Vec<u8>>,
    names: &NameLists,
) -> Result<Vec<TrialRecord>, (&'static str, String)> {
    let mut records = Records::new(names);
    for (name, fill) in TABLES {
        let bytes = files.remove(name).unwrap_or_default();
        let table = Table::new(bytes).and_then(|table| fill(&mut records, &table));
        table.map_err(|wrong| (name, wrong))?;
    }
    for (name, fill) in MAYBE {
        if let Some(bytes) = files.remove(name) {
            let table = Table::new(bytes).and_then(|table| fill(&mut records, &table));
            table.map_err(|wrong| (name, wrong))?;
        }
    }
    Ok(records.finish())
}
