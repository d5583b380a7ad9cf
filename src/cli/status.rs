//! `desim status`: how far trials are, whoever runs them.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::Args;

use super::failure::Failure;
use super::output;
use super::shown::Format;
use crate::export;
use crate::runs::status;

/// What `desim status --help` says.
pub const LONG_ABOUT: &str = "\
Says how far the trials of a scenario or a study are, while processes on this or other machines run them: how many are done, who is at work on what, what has \
failed, what nobody is at work on, and how long it will take. Folders of several shards are counted together.

A process that has not been heard of for a minute counts as silent: it was killed, or its machine is down. Nothing is written.";

/// Arguments of `desim status`.
#[derive(Debug, Args)]
pub struct StatusArguments {
    /// Folders that trials are run into
    #[arg(required = true, value_name = "DIR")]
    pub dirs: Vec<PathBuf>,
    /// What to print on standard output
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// Runs the command.
///
/// # Errors
/// If the folders do not hold trials of one scenario or study.
pub fn run(arguments: &StatusArguments) -> Result<(), Failure> {
    let progress = status(&arguments.dirs)?;
    let mut out = output::stdout();
    match arguments.format {
        Format::Json => out.write_all(&export::json(&progress))?,
        Format::Text => out.write_all(progress.text(output::style(&io::stdout())).as_bytes())?,
    }
    Ok(out.flush()?)
}
