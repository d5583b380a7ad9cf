//! `desim scenario`: runs the trials of a scenario, keeps their results, and reports.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::thread;

use clap::{Args, ValueEnum};
use tokio_util::sync::CancellationToken;

use super::check::{self, Deny};
use super::failure::Failure;
use super::interrupt;
use super::output::say;
use super::progress::Progress;
use super::shown::{Finished, Format};
use crate::experiment::{Ending, Experiment, ExperimentError, Parts, Pool};
use crate::experiment::{TrialError, run_trial};
use crate::export::{self, Contents, Folder, FolderError, Manifest, Pictures};
use crate::metrics::Summary;
use crate::scenario::{Scenario, contents, examine, is_study, question};
use crate::simulation::DriverKind;
use crate::text::shown;

/// What `desim scenario --help` says.
pub const LONG_ABOUT: &str = "\
Runs the trials of a scenario in parallel and reports what they show: completion, bandwidth by topic, delivery, latency \
and connectivity, each with its interval. Tables (Parquet), pictures (SVG), summary.json and manifest.json go to a folder.

Finished trials are kept: after an interruption the same command goes on where it stopped, and the results are the same, \
byte for byte, as those of a run without interruption. Results of another scenario are never overwritten without --force.";

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
    /// Trials that run at a time [default: one for each processor]; results do not depend on it
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
    /// Delete the results that are in the folder, and run again
    #[arg(long)]
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
    let folder = Folder::new(arguments.out.clone().unwrap_or_else(default_out));
    let (summary, manifest) = match finished(&folder, &scenario, arguments.force)? {
        Some(manifest) => {
            let summary = folder.summary(&manifest)?;
            folder.tidy();
            arguments.remark(&format!("{} holds these results already", shown(folder.path())));
            (summary, manifest)
        }
        None => simulate(&folder, &scenario, question(&text), arguments)?,
    };
    let finished = Finished {
        question: question(&text),
        scenario: &scenario,
        folders: folder.path().to_owned(),
        summary: &summary,
        trials: &manifest.trials,
        files: manifest.files.keys().map(String::as_str).collect(),
    };
    print(&finished, arguments)
}

impl ScenarioArguments {
    /// Everything that is set on the command line, as overrides.
    fn settings(&self) -> Vec<String> {
        let trials = self.trials.map(|trials| format!("trials={trials}"));
        let seed = self.seed.map(|seed| format!("seed={seed}"));
        self.overrides.iter().cloned().chain(trials).chain(seed).collect()
    }

    /// Says something in passing.
    fn remark(&self, words: &str) {
        if !self.quiet {
            say(words);
        }
    }
}

/// The manifest of the results asked for, if they are there and finished. The folder is then ready for the others: it
/// holds nothing, or finished trials of the same experiment.
fn finished(folder: &Folder, scenario: &Scenario, force: bool) -> Result<Option<Manifest>, Failure> {
    let there = match folder.contents() {
        Ok(Contents::Results(there)) => Some(there),
        Ok(Contents::Nothing) => {
            // Finished trials that nothing says the scenario of are of no use.
            folder.tidy();
            return Ok(None);
        }
        // Whatever it was, it is to be replaced.
        Err(FolderError::Altered { .. } | FolderError::Version { .. }) if force => None,
        Err(error) => return Err(error.into()),
    };
    let Some(there) = there.filter(|_| !force) else {
        // Opening the trials makes sure that nobody is running them.
        drop(Parts::open(&folder.trials())?);
        folder.clear()?;
        return Ok(None);
    };
    let differences = there.differences(&Manifest::new(scenario));
    if differences.is_empty() {
        return Ok(there.finished.then_some(there));
    }
    Err(Failure::Input(format!(
        "error: {} holds results of another experiment:\n  {}\nChoose another folder with --out, or replace them with --force.",
        shown(folder.path()),
        differences.join("\n  "),
    )))
}

/// Runs the trials that are missing and writes the results.
fn simulate(
    folder: &Folder,
    scenario: &Scenario,
    question: Option<String>,
    arguments: &ScenarioArguments,
) -> Result<(Summary, Manifest), Failure> {
    let stop = CancellationToken::new();
    interrupt::cancels(&stop).map_err(|error| Failure::other(&error))?;
    let parts = Parts::open(&folder.trials())?;
    folder.declare(&Manifest {
        question,
        ..Manifest::new(scenario)
    })?;
    let experiment = Experiment {
        trials: scenario.trials,
        seed: scenario.seed,
        parts: &parts,
    };
    let pool = Pool {
        jobs: threads(arguments.jobs),
        stop: &stop,
    };
    let kept = experiment.kept();
    if kept > 0 {
        arguments.remark(&format!("going on after {kept} of {} trials", scenario.trials));
    }
    let mut progress = Progress::start(scenario.trials, kept, arguments.quiet);
    let run = |_, trial| run_trial(scenario, trial, arguments.driver.into(), &stop);
    let ending = pool.run(std::slice::from_ref(&experiment), run, |_, part| progress.count(part));
    drop(progress);
    match ending {
        Ok(Ending::Finished) => Ok(export::write(folder, parts, scenario, arguments.pictures.into())?),
        Ok(Ending::Interrupted) => Err(Failure::Interrupted(leave(folder, &experiment, scenario)?)),
        Err(error) => {
            leave(folder, &experiment, scenario)?;
            Err(failure(error))
        }
    }
}

/// As many threads as asked for, or one for each processor.
#[must_use]
pub fn threads(asked: Option<NonZeroUsize>) -> NonZeroUsize {
    let processors = || thread::available_parallelism().ok();
    asked.or_else(processors).unwrap_or(NonZeroUsize::MIN)
}

/// Leaves an unfinished experiment: finished trials stay, and if there are none, nothing does. Says so.
fn leave(folder: &Folder, experiment: &Experiment, scenario: &Scenario) -> Result<String, Failure> {
    let kept = experiment.kept();
    if kept == 0 {
        folder.clear()?;
        return Ok("interrupted before a trial had finished; nothing is kept".to_owned());
    }
    Ok(format!(
        "interrupted: {kept} of {} trials are kept in {}; run the same command to go on",
        scenario.trials,
        shown(folder.path())
    ))
}

/// What a failed trial means to the user.
#[must_use]
pub fn failure(error: ExperimentError<TrialError>) -> Failure {
    match error {
        ExperimentError::Trial {
            source: TrialError::Deploy(error),
            ..
        } => Failure::Input(format!("error: {error}")),
        ExperimentError::Trial { .. } => Failure::other(&error),
        ExperimentError::Parts(error) => error.into(),
    }
}

fn print(finished: &Finished, arguments: &ScenarioArguments) -> Result<(), Failure> {
    if arguments.quiet && arguments.format == Format::Text {
        return Ok(());
    }
    finished.print(arguments.format)
}
