//! The trials behind the rows.

use std::num::NonZeroUsize;
use std::thread;

use tokio_util::sync::CancellationToken;

use super::judge::Judged;
use super::row::Row;
use crate::experiment::{Ending, TrialError, run_trial, run_trials};
use crate::scenario::{Scenario, parse};
use crate::simulation::DriverKind;
use crate::statistics::Part;

/// The seed that rows are measured by unless another is asked for.
pub const SEED: u64 = 1;

/// How rows are measured. But for the seed, results do not depend on it.
#[derive(Clone, Debug)]
pub struct Options {
    /// Seed of all trials.
    pub seed: u64,
    /// How many trials run at a time; `None` for one a processor.
    pub jobs: Option<NonZeroUsize>,
    /// Cancelled when somebody wants the trials to stop.
    pub stop: CancellationToken,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            seed: SEED,
            jobs: None,
            stop: CancellationToken::new(),
        }
    }
}

/// Why rows were not measured.
#[derive(Debug, thiserror::Error)]
pub enum ValidateError {
    /// A scenario is none.
    #[error("{name}: the scenario is faulty:\n{faults}")]
    Scenario {
        /// Whose.
        name: String,
        /// What is wrong with it.
        faults: String,
    },
    /// A trial failed.
    #[error("{name}, trial {trial}: {source}")]
    Trial {
        /// Of which row.
        name: String,
        /// Its number.
        trial: u32,
        /// Why.
        source: TrialError,
    },
    /// Somebody cancelled.
    #[error("interrupted; nothing is kept")]
    Interrupted,
}

/// How many trials these rows take.
#[must_use]
pub fn trials(rows: &[&Row]) -> u32 {
    rows.iter().map(|row| row.trials).sum()
}

/// Runs the trials of `rows`, of a catalogue of `all`, and judges each; `told` is called after each trial, with the seconds that it simulated. What comes out depends on the rows and the seed alone.
///
/// # Errors
/// If a scenario is faulty, a trial fails, or somebody cancelled.
pub fn measure(
    rows: &[&Row],
    all: usize,
    options: &Options,
    mut told: impl FnMut(f64),
) -> Result<Vec<Judged>, ValidateError> {
    let scenarios = rows.iter().map(|row| scenario(row, options.seed)).collect::<Result<Vec<_>, _>>()?;
    let places = |(place, row): (usize, &&Row)| (0..row.trials).map(move |trial| (place, trial)).collect::<Vec<_>>();
    let jobs: Vec<(usize, u32)> = rows.iter().enumerate().flat_map(places).collect();
    let mut parts: Vec<Vec<Part>> = rows.iter().map(|row| vec![[0.0; 2]; row.trials as usize]).collect();
    let run = |(place, trial): (usize, u32)| {
        let record = run_trial(&scenarios[place], trial, DriverKind::Inline, &options.stop);
        let record = record.map_err(|source| ValidateError::Trial {
            name: rows[place].name.clone(),
            trial,
            source,
        })?;
        Ok(((place, trial), rows[place].read(&record), record.simulated.as_secs()))
    };
    let threads = options.jobs.or_else(|| thread::available_parallelism().ok());
    let ending = run_trials(
        &jobs,
        threads.unwrap_or(NonZeroUsize::MIN),
        &options.stop,
        run,
        |((place, trial), part, seconds)| {
            parts[place][trial as usize] = part;
            told(seconds);
        },
    )?;
    if ending == Ending::Interrupted {
        return Err(ValidateError::Interrupted);
    }
    let judge = |(row, parts): (&&Row, &Vec<Part>)| Judged::of(row, all, options.seed, parts);
    Ok(rows.iter().zip(&parts).map(judge).collect())
}

fn scenario(row: &Row, seed: u64) -> Result<Scenario, ValidateError> {
    parse(&row.name, &row.scenario(seed), &[]).map_err(|report| ValidateError::Scenario {
        name: row.name.clone(),
        faults: report.to_string(),
    })
}
