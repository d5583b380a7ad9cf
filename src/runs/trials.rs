//! The trials that are missing, of one scenario or many.

use std::num::NonZeroUsize;
use std::thread;

use super::error::RunsError;
use super::options::Options;
use crate::experiment::{Ending, Experiment, FinishedTrial, Parts, Pool, run_trial_in};
use crate::scenario::Scenario;

/// What whoever runs something is told.
#[derive(Clone, Copy, Debug)]
pub enum Happening<'a> {
    /// The results are there already; nothing is run.
    There,
    /// Trials begin. A study whose intervals are too wide by then begins once more, with more of them.
    Begin {
        /// How many are kept from before.
        kept: u32,
        /// How many there are to be.
        trials: u32,
    },
    /// A trial has finished and is kept.
    Trial(&'a FinishedTrial),
    /// No more trials run: all have finished, or one has failed, or somebody has cancelled.
    End,
}

/// Runs the trials of `scenarios` that are not kept yet, all in one pool, and tells `finished` of each, with the place of its
/// scenario. `kept` says how many are.
///
/// # Errors
/// The first error of a trial.
pub(super) fn run_missing(
    scenarios: &[(&Scenario, &Parts)],
    kept: u32,
    options: &Options,
    mut finished: impl FnMut(usize, &FinishedTrial),
    tell: &mut dyn FnMut(Happening),
) -> Result<Ending, RunsError> {
    let experiments: Vec<Experiment> = scenarios
        .iter()
        .map(|(scenario, parts)| Experiment {
            trials: scenario.trials,
            seed: scenario.seed,
            parts,
        })
        .collect();
    // A trial that fails stops the others, and nobody else's.
    let stop = options.stop.child_token();
    let pool = Pool {
        jobs: threads(options.jobs),
        stop: &stop,
    };
    let run = |place: usize, trial| {
        let (scenario, parts) = scenarios[place];
        run_trial_in(&parts.scratch(), scenario, trial, options.driver, &stop)
    };
    let trials = experiments.iter().map(|experiment| experiment.trials).sum();
    tell(Happening::Begin { kept, trials });
    let ending = pool.run(&experiments, run, |place, part| {
        tell(Happening::Trial(part));
        finished(place, part);
    });
    tell(Happening::End);
    Ok(ending?)
}

/// As many threads as asked for, or one for each processor.
fn threads(asked: Option<NonZeroUsize>) -> NonZeroUsize {
    let processors = || thread::available_parallelism().ok();
    asked.or_else(processors).unwrap_or(NonZeroUsize::MIN)
}
