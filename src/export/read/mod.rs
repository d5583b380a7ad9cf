//! A results folder read back: verified file by file against its manifest, its tables turned into the records that they
//! were written from.

mod air;
mod asked;
mod chunks;
mod column;
mod comparison;
mod failures;
mod fill;
mod records;
mod swarm;
mod table;
mod traffic;
mod trials;

use std::collections::BTreeMap;

pub use comparison::told;
pub use records::NameLists;

use crate::metrics::TrialRecord;
use crate::spool::Section;
use fill::{Fill, OPTIONAL as MAYBE, TABLES};
use records::{Records, stray};
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

/// A table that is not what it should be, and how.
pub type WrongTable = (&'static str, Wrong);

/// The records that tables were written from, but for their paths and the numbers of the frames that suspicions began with, which no report
/// needs. All tables are in order of trials: they are read side by side, and one record is in memory at a time.
pub struct Reader<'a> {
    names: &'a NameLists,
    /// The tables, that of the trials first.
    tables: Vec<(&'static str, Fill, Table)>,
    is_over: bool,
}

impl<'a> Reader<'a> {
    /// Begins to read `files`, the tables of [`READ`] and [`OPTIONAL`] by name.
    ///
    /// # Errors
    /// The table that cannot be one of them, and why.
    pub fn new(files: &BTreeMap<String, Section>, names: &'a NameLists) -> Result<Self, WrongTable> {
        let mut tables = Vec::new();
        for (name, fill) in TABLES.into_iter().chain(MAYBE) {
            if let Some(file) = files.get(name) {
                let table = Table::new(file).and_then(|table| {
                    // Of no row yet: whether its columns are there.
                    fill(&mut Records::new(names), &table).map(|()| table)
                });
                tables.push((name, fill, table.map_err(|wrong| (name, wrong))?));
            }
        }
        Ok(Self {
            names,
            tables,
            is_over: false,
        })
    }

    /// The next record; none after the last.
    fn read(&mut self) -> Result<Option<TrialRecord>, WrongTable> {
        let mut records = Records::new(self.names);
        for (place, (name, fill, table)) in self.tables.iter_mut().enumerate() {
            let read = if place == 0 {
                table
                    .advance_by_one()
                    .and_then(|is_one| if is_one { fill(&mut records, table) } else { Ok(()) })
            } else {
                rows_of(&mut records, *fill, table)
            };
            read.map_err(|wrong| (*name, wrong))?;
        }
        Ok(records.finish())
    }
}

/// Puts a table's rows of the trial into its record; after the last trial there are to be no more.
fn rows_of(records: &mut Records, fill: Fill, table: &mut Table) -> Result<(), Wrong> {
    let Some(trial) = records.trial() else {
        return table.next_trial()?.map_or(Ok(()), |trial| Err(stray(trial)));
    };
    while table.advance(trial)? {
        fill(records, table)?;
    }
    Ok(())
}

impl Iterator for Reader<'_> {
    type Item = Result<TrialRecord, WrongTable>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.is_over {
            return None;
        }
        let next = self.read().transpose();
        self.is_over = !matches!(next, Some(Ok(_)));
        next
    }
}
