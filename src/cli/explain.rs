//! `desim explain`: runs one finished trial again and tells why a robot was suspected.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use tokio_util::sync::CancellationToken;

use super::failure::Failure;
use super::interrupt;
use super::output;
use super::shown::Format;
use crate::engine::ActorId;
use crate::experiment::trace_trial;
use crate::export::{self, Contents, Folder, FolderError, Manifest};
use crate::metrics::TrialRecord;
use crate::report::Explanation;
use crate::scenario::{Scenario, parse, to_ron};
use crate::text::shown;

/// What `desim explain --help` says.
pub const LONG_ABOUT: &str = "\
Tells in words and times why a robot was suspected: every status that it sent since it was last heard, and what became of \
each at the robot that came to suspect it, and whether and when it had really failed.

Nothing of this is stored. A run is the same every time, so the trial is run again, and its digest shows that it is the \
same run; where this version of desim would run it otherwise, it says so and explains nothing.";

/// Arguments of `desim explain`.
#[derive(Debug, Args)]
pub struct ExplainArguments {
    /// Folder of finished results
    pub dir: PathBuf,
    /// Number of the trial, from 0
    #[arg(long, value_name = "K")]
    pub trial: u32,
    /// Number of the robot that was suspected, from 0
    #[arg(long, value_name = "R")]
    pub robot: u32,
    /// Explain only this suspicion, by its number in the list, with every status on a line of its own
    #[arg(long, value_name = "N")]
    pub suspicion: Option<usize>,
    /// What to print on standard output
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// Explains.
///
/// # Errors
/// If there is nothing to explain by these arguments, or the trial cannot be run again.
///
/// # Panics
/// Never: what is asked for is traced.
pub fn run(arguments: &ExplainArguments) -> Result<(), Failure> {
    let manifest = results(&arguments.dir)?;
    let scenario = scenario(&manifest, &arguments.dir)?;
    if !scenario.protocol.has_statuses() {
        return refuse(format!(
            "robots that run {} send no statuses: nobody watches over them, and nobody is suspected",
            scenario.protocol.name()
        ));
    }
    let digest = recorded_digest(&manifest, arguments)?;
    if arguments.robot >= scenario.swarm.robots {
        let robots = scenario.swarm.robots;
        return refuse(format!(
            "there is no robot {}: the scenario has robots 0 to {}",
            arguments.robot,
            robots - 1
        ));
    }
    let record = run_again(&scenario, arguments)?;
    let now = format!("{:032x}", record.digest);
    if now != digest {
        return refuse(format!(
            "this desim does not run trial {} as the results have it (digest {digest} there, {now} now; desim {} there, {} now): what it would tell is not what happened.\nExplain the results with the version that made them, or make them again with --force.",
            arguments.trial,
            manifest.version,
            env!("CARGO_PKG_VERSION")
        ));
    }
    let mut explanation = Explanation::of(&scenario.name, &record).expect("the robot was traced");
    explanation.rule = scenario.detector.words();
    let chosen = chosen(&explanation, arguments)?;
    let mut out = output::stdout();
    match (arguments.format, chosen) {
        (Format::Json, None) => out.write_all(&export::json(&explanation))?,
        (Format::Json, Some(number)) => out.write_all(&export::json(&explanation.suspicions[number - 1]))?,
        (Format::Text, chosen) => out.write_all(explanation.text(chosen, output::style(&io::stdout())).as_bytes())?,
    }
    Ok(out.flush()?)
}

fn refuse<T>(message: impl Into<String>) -> Result<T, Failure> {
    Err(Failure::Input(format!("error: {}", message.into())))
}

/// The manifest of the finished results in `dir`, all of which are as they were written.
fn results(dir: &Path) -> Result<Manifest, Failure> {
    let shown = shown(dir);
    if !dir.exists() {
        return refuse(format!("there is no folder {shown}"));
    }
    let folder = Folder::new(dir.to_owned());
    match folder.contents() {
        Ok(Contents::Results(manifest)) if manifest.finished => {
            folder.held(&manifest, &[])?;
            Ok(manifest)
        }
        Ok(Contents::Results(_)) => refuse(format!(
            "the results in {shown} are unfinished: run the same `desim scenario` command to its end first"
        )),
        Ok(Contents::Nothing) | Err(FolderError::Foreign { .. } | FolderError::NotAFolder(_)) => {
            refuse(format!("{shown} holds no results of desim"))
        }
        Err(error) => Err(error.into()),
    }
}

/// The scenario that `manifest` holds.
fn scenario(manifest: &Manifest, dir: &Path) -> Result<Scenario, Failure> {
    let place = shown(&dir.join("manifest.json"));
    let scenario: Scenario = serde_json::from_value(manifest.scenario.clone()).or_else(|error| {
        refuse(format!(
            "the scenario in {place} is of another version ({error}; desim {} there, {} now)",
            manifest.version,
            env!("CARGO_PKG_VERSION")
        ))
    })?;
    // Somebody may have edited it: it must hold as any scenario file must.
    Ok(parse(&place, &to_ron(&scenario), &[])?)
}

/// The digest that the trial had.
fn recorded_digest(manifest: &Manifest, arguments: &ExplainArguments) -> Result<String, Failure> {
    let trial = manifest.trials.iter().find(|entry| entry.trial == arguments.trial);
    let Some(trial) = trial else {
        return refuse(format!(
            "there is no trial {}: {} has trials 0 to {}",
            arguments.trial,
            shown(&arguments.dir),
            manifest.trials.len().saturating_sub(1)
        ));
    };
    Ok(trial.digest.clone())
}

fn run_again(scenario: &Scenario, arguments: &ExplainArguments) -> Result<TrialRecord, Failure> {
    let stop = CancellationToken::new();
    interrupt::cancels(&stop).map_err(|error| Failure::other(&error))?;
    trace_trial(scenario, arguments.trial, ActorId(arguments.robot), &stop).map_err(|error| {
        if stop.is_cancelled() {
            Failure::Interrupted("interrupted".to_owned())
        } else {
            Failure::other(&error)
        }
    })
}

/// The number of the suspicion asked for, if one was and there is one.
fn chosen(explanation: &Explanation, arguments: &ExplainArguments) -> Result<Option<usize>, Failure> {
    let known = explanation.suspicions.len();
    match arguments.suspicion {
        Some(number) if known > 0 && !(1..=known).contains(&number) => refuse(format!(
            "there is no suspicion {number}: robot {} was suspected {known} time{}",
            arguments.robot,
            if known == 1 { "" } else { "s" }
        )),
        chosen => Ok(chosen.filter(|_| known > 0)),
    }
}
