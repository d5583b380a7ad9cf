//! In place of the tables, in a build without the `parquet` feature: nothing is written.

use std::io;
use std::path::Path;

use super::Names;
use crate::metrics::TrialRecord;

/// No tables.
pub struct Tables;

impl Tables {
    /// Names of the files: none.
    pub const FILES: [&str; 0] = [];
    /// Names of files that may be there: none.
    pub const OPTIONAL: [&str; 0] = [];

    /// Starts nothing.
    ///
    /// # Errors
    /// Never.
    pub fn create(_: &Path, _: Names, _: usize) -> io::Result<Self> {
        Ok(Self)
    }

    /// Adds nothing.
    ///
    /// # Errors
    /// Never.
    pub fn append(&mut self, _: &TrialRecord) -> io::Result<()> {
        Ok(())
    }

    /// Ends nothing.
    ///
    /// # Errors
    /// Never.
    pub fn finish(self) -> io::Result<Vec<&'static str>> {
        Ok(Vec::new())
    }
}
