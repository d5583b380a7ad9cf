//! A results folder read back: verified file by file against its manifest, its tables turned into the records that they
//! were written from.

mod air;
mod asked;
mod comparison;
mod failures;
mod fill;
mod records;
mod swarm;
mod table;
mod traffic;
mod trials;

use std::collections::BTreeMap;
use std::fs::File;

pub use comparison::told;
pub use records::NameLists;

use crate::metrics::TrialRecord;
use fill::{Fill, OPTIONAL as MAYBE, TABLES};
use records::Records;
use table::{Table, Wrong};

/// Names of the tables that are read.
pub const READ: [&str; TABLES.len()] = names(&TABLES);

/// Names of the tables that are read where they are there.
pub const OPTIONAL: [&str; MAYBE.len()] = names(&MAYBE);

/// The names of so many tables.
const fn names<const N: usize>(tables: &[(&'static str, Fill); N]) -> [&'static str; N] {
    let mut names = [""; N];
    let mut table = 0;
    while table < N {
        names[table] = tables[table].0;
        table += 1;
    }
    names
}

/// The records that `files`, the tables of [`READ`] and [`OPTIONAL`] by name, were written from, but for their paths and the
/// numbers of the frames that suspicions began with, which no report needs.
///
/// # Errors
/// The table that is not what it should be, and how.
pub fn records(
    files: &mut BTreeMap<String, File>,
    names: &NameLists,
) -> Result<Vec<TrialRecord>, (&'static str, String)> {
    let mut records = Records::new(names);
    for (name, fill) in TABLES.into_iter().chain(MAYBE) {
        if let Some(file) = files.remove(name) {
            fill_from(file, fill, &mut records).map_err(|wrong| (name, wrong))?;
        }
    }
    Ok(records.finish())
}

/// Fills the records with one group of a table's rows at a time: a table may be larger than the memory.
fn fill_from(file: File, fill: Fill, records: &mut Records) -> Result<(), Wrong> {
    let mut table = Table::new(file)?;
    loop {
        fill(records, &table)?;
        if !table.advance() {
            return Ok(());
        }
    }
}
