//! `desim schema`: the JSON Schema of scenario or study files.

use std::io::{self, Write};

use crate::scenario::{json_schema, study_schema};

/// Writes the JSON Schema of scenario files, or of study files, to `out`.
///
/// # Errors
/// If `out` cannot be written to.
pub fn schema(study: bool, out: &mut dyn Write) -> io::Result<()> {
    let schema = if study { study_schema() } else { json_schema() };
    serde_json::to_writer_pretty(&mut *out, &schema)?;
    writeln!(out)
}
