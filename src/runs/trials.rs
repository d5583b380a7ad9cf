//! The trials that are missing, of one scenario or many.

use std::path::Path;

use super::error::RunsError;
use super::options::Options;
use super::processors::processors;
use super::runner::Telling;
use crate::experiment::{Ending, Experiment, FinishedTrial, Parts, Pool, Shard, run_trial_in};
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

/// Trials to be run, of one scenario or many.
pub(super) struct Run<'a> {
    /// The scenarios, and where their trials are kept.
    pub scenarios: &'a [(&'a Scenario, &'a Parts)],
    /// Which trials are to be run.
    pub shard: Shard,
    /// How many of these are kept from before.
    pub kept: u32,
    /// The folder in which this process says how far it is.
    pub signs: &'a Path,
}

impl Run<'_> {
    /// Runs the trials that are not kept yet, all in one pool, and tells `finished` of each, with the place of its scenario.
    ///
    /// # Errors
    /// The first error of a trial.
    pub fn missing(
        &self,
        options: &Options,
        mut finished: impl FnMut(usize, &FinishedTrial),
        tell: &mut dyn FnMut(Happening),
    ) -> Result<Ending, RunsError> {
        let experiments: Vec<Experiment> = self
            .scenarios
            .iter()
            .map(|(scenario, parts)| Experiment {
                trials: scenario.trials,
                shard: self.shard,
                parts,
            })
            .collect();
        // A trial that fails stops the others, and nobody else's.
        let stop = options.stop.child_token();
        let jobs = options.jobs.unwrap_or_else(processors);
        let pool = Pool { jobs, stop: &stop };
        let trials = experiments.iter().map(Experiment::len).sum::<u32>();
        let telling = Telling::begin(self.signs, self.shard, jobs.get(), trials - self.kept.min(trials));
        let run = |place: usize, trial| {
            let (scenario, parts) = self.scenarios[place];
            telling.starts(place, trial);
            let ran = run_trial_in(&parts.scratch(), scenario, trial, options.driver, &stop);
            let failed = ran.as_ref().err().filter(|_| !stop.is_cancelled());
            telling.stops(place, trial, failed.map(ToString::to_string));
            ran
        };
        tell(Happening::Begin {
            kept: self.kept,
            trials,
        });
        let ending = pool.run(&experiments, run, |place, part| {
            tell(Happening::Trial(part));
            finished(place, part);
        });
        tell(Happening::End);
        Ok(ending?)
    }
}
