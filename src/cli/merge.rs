//! `desim merge`: the shards of a scenario or a study put together.

use std::path::PathBuf;

use clap::Args;

use super::failure::Failure;
use super::output::say;
use super::scenario::Drawn;
use super::shown::{Finished, Format, print_comparison};
use crate::runs::{Merge, Merged, merge};
use crate::text::shown;

/// What `desim merge --help` says.
pub const LONG_ABOUT: &str = "\
Puts together what `desim scenario --shard I/N` or `desim compare --shard I/N` has left in one folder or several: tables, pictures, summary \
or comparison, byte for byte those of a run on one machine. Only the wall times in the manifests differ.

The folders stay as they are, but for the one that the results go to. Putting them together once more changes nothing. Where trials are missing or \
damaged, they are named, with the part of the array that would run them. Shards of another scenario, seed or version are refused with the difference, \
and so is a trial that two folders have and that is not the same in both.

Of a study that was run with --until-width it says whether the intervals are narrow enough, and if not, how many trials would do.";

/// Arguments of `desim merge`.
#[derive(Debug, Args)]
pub struct MergeArguments {
    /// Folders that shards have filled
    #[arg(required = true, value_name = "DIR")]
    pub dirs: Vec<PathBuf>,
    /// Folder for the results, which may be one of the others [default: DIR, if there is only one]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Trials of a scenario to draw pictures of
    #[arg(long, value_enum, default_value_t, value_name = "WHICH")]
    pub pictures: Drawn,
    /// What to print on standard output
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
    /// Print, with `--format text`, no report
    #[arg(long)]
    pub quiet: bool,
    /// Delete other results that are in the folder
    #[arg(long)]
    pub force: bool,
}

/// Runs the command.
///
/// # Errors
/// If the shards cannot be put together, or the results not be written.
pub fn run(arguments: &MergeArguments) -> Result<(), Failure> {
    let ((Some(out), _) | (None, [out])) = (&arguments.out, &arguments.dirs[..]) else {
        return Err(Failure::Input(
            "error: say where the results of several folders go: --out DIR, which may be one of them".to_owned(),
        ));
    };
    let merged = merge(&Merge {
        dirs: &arguments.dirs,
        out,
        pictures: arguments.pictures.into(),
        replace: arguments.force,
    })?;
    let (Merged::Scenario { were_there, .. } | Merged::Study { were_there, .. }) = merged;
    if were_there && !arguments.quiet {
        say(&format!("{} holds these results already", shown(out)));
    }
    if arguments.quiet && arguments.format == Format::Text {
        return Ok(());
    }
    match merged {
        Merged::Study { results, .. } => print_comparison(&results.comparison, &results.folder, arguments.format),
        Merged::Scenario { scenario, results, .. } => {
            let finished = Finished {
                question: results.manifest.question.clone(),
                scenario: &scenario,
                summary: &results.summary,
                trials: &results.manifest.trials,
                files: results.manifest.files.keys().map(String::as_str).collect(),
                folders: out.clone(),
            };
            finished.print(arguments.format)
        }
    }
}
