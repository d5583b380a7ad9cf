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

/// How many trials these rows take. Rows that read the same runs share them.
#[must_use]
pub fn trials(rows: &[&Row]) -> u32 {
    groups(rows).iter().map(|group| rows[group[0]].trials).sum()
}

/// The places of rows that read the same runs, together.
fn groups(rows: &[&Row]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (place, row) in rows.iter().enumerate() {
        match groups.iter_mut().find(|group| rows[group[0]].runs_as(row)) {
            Some(group) => group.push(place),
            None => groups.push(vec![place]),
        }
    }
    groups
}

/// Runs the trials of `rows`, of a catalogue of `all`, and judges each; `told` is called after each trial, with the seconds that it simulated. What comes out depends
/// on the rows and the seed alone.
///
/// # Errors
/// If a scenario is faulty, a trial fails, or somebody cancelled.
pub fn measure(
    rows: &[&Row],
    all: usize,
    options: &Options,
    mut told: impl FnMut(f64),
) -> Result<Vec<Judged>, ValidateError> {
    let groups = groups(rows);
    let first = |group: &Vec<usize>| scenario(rows[group[0]], options.seed);
    let scenarios = groups.iter().map(first).collect::<Result<Vec<_>, _>>()?;
    let of_group = |group: usize| (0..rows[groups[group][0]].trials).map(move |trial| (group, trial));
    let jobs: Vec<(usize, u32)> = (0..groups.len()).flat_map(of_group).collect();
    let mut parts: Vec<Vec<Part>> = rows.iter().map(|row| vec![[0.0; 2]; row.trials as usize]).collect();
    let run = |(group, trial): (usize, u32)| {
        let record = run_trial(&scenarios[group], trial, DriverKind::Inline, &options.stop);
        let record = record.map_err(|source| ValidateError::Trial {
            name: rows[groups[group][0]].name.clone(),
            trial,
            source,
        })?;
        let read: Vec<Part> = groups[group].iter().map(|&place| rows[place].read(&record)).collect();
        Ok((group, trial, read, record.simulated.as_secs()))
    };
    let threads = options.jobs.or_else(|| thread::available_parallelism().ok());
    let ending = run_trials(
        &jobs,
        threads.unwrap_or(NonZeroUsize::MIN),
        &options.stop,
        run,
        |(group, trial, read, seconds)| {
            for (&place, part) in groups[group].iter().zip(read) {
                parts[place][trial as usize] = part;
            }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::validate::{Verdict, catalogue};

    fn judged(row: &Row) -> Judged {
        measure(&[row], 60, &Options::default(), |_| ())
            .expect("its trials run")
            .remove(0)
    }

    fn row(name: &str) -> Row {
        let mut all = catalogue();
        let place = all.iter().position(|row| row.name == name).expect("a known row");
        all.swap_remove(place)
    }

    #[test]
    fn a_row_whose_form_is_wrong_differs() {
        for (name, wrong) in [("loss.bernoulli", 0.21), ("airtime.802154.20-bytes", 1184.1)] {
            let mut row = row(name);
            assert_eq!(judged(&row).verdict, Verdict::Agrees, "{name}");
            row.expected = wrong;
            assert_eq!(judged(&row).verdict, Verdict::Differs, "{name}");
        }
    }

    #[test]
    fn a_row_whose_simulation_is_wrong_differs() {
        let wrong = row("loss.bernoulli").with_other("Bernoulli(0.2)", "Bernoulli(0.19)");
        assert_eq!(judged(&wrong).verdict, Verdict::Differs);
        let wrong = row("errors.802154.20-bytes").with_other("Ieee802154()", "Ieee802154(sensitivity: -95.2)");
        assert_eq!(judged(&wrong).verdict, Verdict::Differs);
        let silent = row("loss.bernoulli").with_other("Traffic(", "Traffic(senders: Given([]), ");
        let nothing = judged(&silent);
        assert_eq!((nothing.measured, nothing.verdict), (None, Verdict::Differs));
    }

    #[test]
    fn rows_that_read_the_same_runs_share_them_and_read_what_they_would_alone() {
        let [share, delay] = ["csma-ca.broadcast.20-robots", "csma-ca.delay.20-robots"].map(row);
        assert_eq!(trials(&[&share, &delay]), share.trials);
        let together = measure(&[&share, &delay], 60, &Options::default(), |_| ()).expect("its trials run");
        assert_eq!(together[1], judged(&delay));
    }
}
