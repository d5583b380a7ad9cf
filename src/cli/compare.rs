//! `desim compare`: runs the settings of a study, or several scenarios, and says how they differ.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Args;
use clap::builder::RangedU64ValueParser;

use super::check::{self, Deny};
use super::failure::Failure;
use super::shard;
use super::shown::{Format, print_comparison};
use super::told::{Teller, options};
use crate::experiment::Shard;
use crate::runs::{StudyRun, Until, run_study, run_study_shard};
use crate::scenario::{Plan, contents, is_study, load_study, plan_of_files};
use crate::simulation::DriverKind;
use crate::text::shown;

/// What `desim compare --help` says.
pub const LONG_ABOUT: &str = "\
Runs every setting of a study file, or several scenario files, and compares them figure by figure: estimates with intervals, \
differences with effect size and adjusted p-value, and in plain words which setting is better, by how much, and how sure that is; \
or that no difference shows, and how many trials would show one. Of several factors in all combinations it says what each does, averaged \
over the others, and whether that depends on another.

All settings of a study have the same seed, so that trials of one number share their random numbers and are compared in pairs. \
Scenario files keep their own seeds and trials: where seeds are equal they are paired, else independent.

Results of each setting go to a folder of its own below the study's, beside comparison.json and comparison.parquet. Finished trials \
are kept: after an interruption the same command goes on where it stopped, to the same bytes. Results are never overwritten without \
--force.

Trials can be spread over processes and machines: --shard 2/4 runs the second of four parts of each setting, `desim merge` puts the parts \
together, and says with --until-width how many trials more it takes.";

/// Arguments of `desim compare`.
#[derive(Debug, Args)]
pub struct CompareArguments {
    /// A study file, or two scenario files or more (RON)
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Number of trials of each setting, instead of the study's or the scenarios'
    #[arg(long, value_name = "N", value_parser = RangedU64ValueParser::<u32>::new().range(1..=1_000_000))]
    pub trials: Option<u32>,
    /// Trials that run at a time, of all settings together [default: one for each processor that this process may use]; results do not
    /// depend on it
    #[arg(long, value_name = "J")]
    pub jobs: Option<NonZeroUsize>,
    /// Folder for the results [default: results/NAME, the study's name]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Key of a figure to compare, instead of the study's; may be given many times, first the one that it is about
    #[arg(long = "figure", value_name = "KEY")]
    pub figures: Vec<String>,
    /// Add trials until the interval of the first figure is no wider than W, in its unit, in every setting
    #[arg(long, value_name = "W", value_parser = width)]
    pub until_width: Option<f64>,
    /// Most trials of a setting that --until-width may come to
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = RangedU64ValueParser::<u32>::new().range(1..=1_000_000))]
    pub most_trials: u32,
    /// What to print on standard output
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
    /// Show no progress and, with `--format text`, no report
    #[arg(long)]
    pub quiet: bool,
    /// Refuse what `desim check` warns of, for scripts: nothing is run or written
    #[arg(long, value_enum, value_name = "WHAT")]
    pub deny: Option<Deny>,
    /// The shard to run, instead of all trials
    #[arg(long, value_name = "I/N", value_parser = shard::shard, help = shard::HELP, long_help = shard::LONG_HELP)]
    pub shard: Option<Shard>,
    /// Delete the results that are in the folder, and run again
    #[arg(long, conflicts_with = "shard")]
    pub force: bool,
}

fn width(text: &str) -> Result<f64, String> {
    let width = text
        .parse::<f64>()
        .ok()
        .filter(|width| width.is_finite() && *width > 0.0);
    width.ok_or_else(|| "expected a number above 0".to_owned())
}

/// Runs the command.
///
/// # Errors
/// If the input is wrong, a run fails or is interrupted, or the results cannot be written.
pub fn run(arguments: &CompareArguments) -> Result<(), Failure> {
    let plan = plan(arguments)?;
    check::heed(&plan.all_warnings(), arguments.deny)?;
    let default_out = || PathBuf::from("results").join(&plan.name);
    let dir = arguments.out.clone().unwrap_or_else(default_out);
    let run = StudyRun {
        plan: &plan,
        until: arguments.until_width.map(|width| Until {
            width,
            most_trials: arguments.most_trials,
        }),
    };
    let options = options(arguments.jobs, DriverKind::Inline, arguments.force)?;
    let mut teller = Teller::of_study(&dir, arguments.quiet);
    if let Some(shard) = arguments.shard {
        let end = run_study_shard(&run, shard, &dir, &options, |happening| teller.tell(happening))?;
        return shard::print(shard, &plan.name, &dir, end, (arguments.quiet, arguments.format));
    }
    let results = run_study(&run, &dir, &options, |happening| teller.tell(happening))?;
    if arguments.quiet && arguments.format == Format::Text {
        return Ok(());
    }
    print_comparison(&results.comparison, &results.folder, arguments.format)
}

/// What is to be compared.
fn plan(arguments: &CompareArguments) -> Result<Plan, Failure> {
    let plan = match &arguments.files[..] {
        [file] if is_study(&contents(file)?) => load_study(file)?,
        [file] => {
            return Err(Failure::Input(format!(
                "error: {0} is a scenario, and not a study: run it by `desim scenario {0}`\nGive a study file, `Study( ... )`, or two \
                 scenario files or more.",
                shown(file)
            )));
        }
        files => {
            for file in files {
                if is_study(&contents(file)?) {
                    return Err(Failure::Input(format!(
                        "error: {0} is a study, and not a scenario: run it by `desim compare {0}`\nGive one study file alone, or scenario files.",
                        shown(file)
                    )));
                }
            }
            plan_of_files(files)?
        }
    };
    let plan = plan.with_figures(&arguments.figures)?;
    let plan = match arguments.trials {
        Some(trials) => plan.with_trials(trials),
        None => plan,
    };
    Ok(match arguments.until_width {
        Some(_) => plan.with_most_trials(arguments.most_trials),
        None => plan,
    })
}
