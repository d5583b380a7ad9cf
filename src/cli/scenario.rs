//! `desim scenario`: runs the trials of a scenario, keeps their results, and reports.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::check::{self, Deny};
use super::failure::Failure;
use super::shard;
use super::shown::{Finished, Format};
use super::told::{Teller, options};
use crate::experiment::Shard;
use crate::export::Pictures;
use crate::runs::{ScenarioRun, run_scenario, run_scenario_shard};
use crate::scenario::{contents, examine, is_study, question};
use crate::simulation::DriverKind;

/// What `desim scenario --help` says.
pub const LONG_ABOUT: &str = "\
Runs the trials of a scenario in parallel and reports what they show: completion, bandwidth by topic, delivery, latency \
and connectivity, each with its interval. Tables (Parquet), pictures (SVG), summary.json and manifest.json go to a folder.

Finished trials are kept: after an interruption the same command goes on where it stopped, and the results are the same, \
byte for byte, as those of a run without interruption. Results of another scenario are never overwritten without --force.

Trials can be spread over processes and machines: --shard 2/4 runs the second of four parts, `desim merge` puts the parts together.";

/// Arguments of `desim scenario`.
#[derive(Debug, Args)]
pub struct ScenarioArguments {
    /// Scenario file (RON)
    pub file: PathBuf,
    /// Number of trials, instead of the scenario's
    #[arg(long, value_name = "N")]
    pub trials: Option<u32>,
    /// Seed of every random stream, instead of the scenario's
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,
    /// Trials that run at a time [default: one for each processor that this process may use]; results do not depend on it
    #[arg(long, value_name = "J")]
    pub jobs: Option<NonZeroUsize>,
    /// Folder for the results [default: results/NAME, the scenario's name]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Set a value of the scenario, such as `radio.loss=Bernoulli(0.3)`; may be given many times
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub overrides: Vec<String>,
    /// How robots are run; results do not depend on it
    #[arg(long, value_enum, default_value_t)]
    pub driver: Driver,
    /// Trials to draw pictures of
    #[arg(long, value_enum, default_value_t, value_name = "WHICH")]
    pub pictures: Drawn,
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

/// How robots are run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Driver {
    /// A task and a mailbox a robot
    #[default]
    Actors,
    /// Direct calls
    Inline,
}

/// Of which trials there are pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Drawn {
    /// No trial
    None,
    /// Trial 0
    #[default]
    First,
    /// Every trial
    All,
}

impl From<Driver> for DriverKind {
    fn from(driver: Driver) -> Self {
        match driver {
            Driver::Actors => Self::Actors,
            Driver::Inline => Self::Inline,
        }
    }
}

impl From<Drawn> for Pictures {
    fn from(drawn: Drawn) -> Self {
        match drawn {
            Drawn::None => Self::None,
            Drawn::First => Self::First,
            Drawn::All => Self::All,
        }
    }
}

/// Runs the command.
///
/// # Errors
/// If the input is wrong, the run fails or is interrupted, or the results cannot be written.
pub fn run(arguments: &ScenarioArguments) -> Result<(), Failure> {
    let text = contents(&arguments.file)?;
    if is_study(&text) {
        return Err(Failure::Input(format!(
            "error: {0} is a study, and not a scenario: run it by `desim compare {0}`",
            arguments.file.display()
        )));
    }
    let (scenario, warnings) = examine(
        &arguments.file.display().to_string(),
        &text,
        &check::all(&arguments.settings())?,
    )?;
    check::heed(&warnings, arguments.deny)?;
    let default_out = || PathBuf::from("results").join(&scenario.name);
    let dir = arguments.out.clone().unwrap_or_else(default_out);
    let run = ScenarioRun {
        scenario: &scenario,
        question: question(&text),
        pictures: arguments.pictures.into(),
    };
    let options = options(arguments.jobs, arguments.driver.into(), arguments.force)?;
    let mut teller = Teller::new(&dir, arguments.quiet);
    if let Some(shard) = arguments.shard {
        let end = run_scenario_shard(&run, shard, &dir, &options, |happening| teller.tell(happening))?;
        let how = (arguments.quiet, arguments.format);
        return shard::print(shard, &scenario.name, &dir, end, how);
    }
    let results = run_scenario(&run, &dir, &options, |happening| teller.tell(happening))?;
    if arguments.quiet && arguments.format == Format::Text {
        return Ok(());
    }
    let finished = Finished {
        question: run.question,
        scenario: &scenario,
        summary: &results.summary,
        trials: &results.manifest.trials,
        files: results.manifest.files.keys().map(String::as_str).collect(),
        folders: dir,
    };
    finished.print(arguments.format)
}

impl ScenarioArguments {
    /// Everything that is set on the command line, as overrides.
    fn settings(&self) -> Vec<String> {
        let trials = self.trials.map(|trials| format!("trials={trials}"));
        let seed = self.seed.map(|seed| format!("seed={seed}"));
        self.overrides.iter().cloned().chain(trials).chain(seed).collect()
    }
}
