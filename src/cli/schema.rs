//! `desim schema`: the JSON Schema of scenario files.

use std::io::{self, Write};

use crate::scenario::json_schema;

/// Writes the JSON Schema of scenario files to `out`.
///
/// # Errors
/// If `out` cannot be written to.
pub fn schema(out: &mut dyn Write) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, &json_schema())?;
    writeln!(out)
}
