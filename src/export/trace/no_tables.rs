//! In place of the tables, in a build without the `parquet` feature: there are none.

use std::io;
use std::path::Path;

use super::Trace;
use super::context::Run;
use crate::happenings::log::Sink;
use crate::metrics::TrialRecord;

/// No tables.
pub struct Tables;

impl Tables {
    /// Begins nothing.
    ///
    /// # Errors
    /// Always: this build writes no tables.
    pub fn create(_: &Path, _: Run) -> io::Result<Self> {
        Err(io::Error::other("this desim was built without the feature `parquet`"))
    }
}

impl Sink for Tables {}

impl Trace for Tables {
    fn finish(self: Box<Self>, _: &TrialRecord) -> io::Result<()> {
        Ok(())
    }
}
