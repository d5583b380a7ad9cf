//! `desim validate`: every model held against its closed form, measured here and now.

use std::io::{self, Write};
use std::num::NonZeroUsize;

use clap::Args;

use super::failure::Failure;
use super::interrupt;
use super::output;
use super::progress::Progress;
use super::shown::Format;
use crate::export;
use crate::report;
use crate::validate::{LEVEL, Options, Row, SEED, ValidateError, Validation, catalogue, measure, trials};

/// What `desim validate --help` says.
pub const LONG_ABOUT: &str = "\
Holds every model against its closed form, or against what an independent program found: path loss, shadowing, fading, bit errors, airtimes, medium access, \
energy, the disk radio, graphs, rumours, the timeout detector. Each row runs the trials of a scenario of its own, which --scenarios prints, and says whether the form lies \
in the interval of what they show.

Exit status 1 if any row differs. A simulator that is right differs somewhere for one seed in a hundred.";

/// Arguments of `desim validate`.
#[derive(Debug, Args)]
pub struct ValidateArguments {
    /// Only rows whose name or model contains this; may be given many times
    #[arg(long, value_name = "TEXT")]
    pub only: Vec<String>,
    /// Print the scenarios of the rows, and run nothing
    #[arg(long)]
    pub scenarios: bool,
    /// Seed of every random stream
    #[arg(long, value_name = "S", default_value_t = SEED)]
    pub seed: u64,
    /// Trials that run at a time [default: one for each processor]; results do not depend on it
    #[arg(long, value_name = "J")]
    pub jobs: Option<NonZeroUsize>,
    /// What to print on standard output
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
    /// Show no progress
    #[arg(long)]
    pub quiet: bool,
}

/// Runs the command.
///
/// # Errors
/// If there is no such row, a row differs, or the run fails or is interrupted.
pub fn run(arguments: &ValidateArguments) -> Result<(), Failure> {
    let all = catalogue();
    let chosen = chosen(&all, &arguments.only)?;
    let mut out = output::stdout();
    if arguments.scenarios {
        let texts: Vec<String> = chosen.iter().map(|row| row.scenario(arguments.seed)).collect();
        out.write_all(texts.join("\n").as_bytes())?;
        return Ok(out.flush()?);
    }
    let options = Options {
        seed: arguments.seed,
        jobs: arguments.jobs,
        ..Options::default()
    };
    interrupt::cancels(&options.stop).map_err(|error| Failure::other(&error))?;
    let mut progress = Progress::start(trials(&chosen), 0, arguments.quiet);
    let rows = measure(&chosen, all.len(), &options, |seconds| progress.count_lasting(seconds))?;
    drop(progress);
    let validation = Validation {
        version: env!("CARGO_PKG_VERSION"),
        seed: arguments.seed,
        level: LEVEL,
        rows,
    };
    match arguments.format {
        Format::Json => out.write_all(&export::json(&validation))?,
        Format::Text => out.write_all(report::validation(&validation, output::style(&io::stdout())).as_bytes())?,
    }
    out.flush()?;
    decision(&validation)
}

/// What the exit status says.
fn decision(validation: &Validation) -> Result<(), Failure> {
    match validation.differing().next() {
        Some(_) => Err(Failure::Differs),
        None => Ok(()),
    }
}

/// The rows whose name or model contains any of the texts; all, without texts.
fn chosen<'a>(all: &'a [Row], only: &[String]) -> Result<Vec<&'a Row>, Failure> {
    let is_of = |row: &Row, text: &String| row.name.contains(text) || row.model.contains(text);
    if let Some(unknown) = only.iter().find(|text| !all.iter().any(|row| is_of(row, text))) {
        let mut models: Vec<&str> = all.iter().map(|row| row.model).collect();
        models.dedup();
        return Err(Failure::Input(format!(
            "error: no row has `{unknown}` in its name or model; the models are {}",
            models.join(", ")
        )));
    }
    let is_chosen = |row: &&Row| only.is_empty() || only.iter().any(|text| is_of(row, text));
    Ok(all.iter().filter(is_chosen).collect())
}

impl From<ValidateError> for Failure {
    fn from(error: ValidateError) -> Self {
        match error {
            ValidateError::Interrupted => Self::Interrupted(error.to_string()),
            other => Self::other(&other),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::validate::{Judged, Verdict};

    #[test]
    fn the_exit_status_is_1_where_a_row_differs_and_0_where_none_does() {
        let row = |verdict| Judged {
            model: "loss",
            name: "loss.a".to_owned(),
            form: "p".to_owned(),
            unit: "",
            expected: 0.2,
            measured: Some(0.2),
            interval: Some([0.19, 0.21]),
            margin: 0.0,
            margin_for: None,
            trials: 20,
            verdict,
            scenario: String::new(),
        };
        let status = |verdicts: &[Verdict]| {
            let validation = Validation {
                version: "1",
                seed: SEED,
                level: LEVEL,
                rows: verdicts.iter().copied().map(row).collect(),
            };
            decision(&validation).map_err(|failure| failure.status())
        };
        assert_eq!(status(&[Verdict::Agrees, Verdict::Agrees]), Ok(()));
        assert_eq!(status(&[Verdict::Agrees, Verdict::Differs]), Err(1));
    }
}
