//! Trials spread over threads.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::Instant;

use tokio_util::sync::CancellationToken;

use super::part_file::FinishedTrial;
use super::parts::{Parts, PartsError};
use super::shard::Shard;
use crate::metrics::TrialRecord;

/// How a set of trials ended, when none of them failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Every trial ran to its end.
    Finished,
    /// Somebody cancelled; the trials that were under way are dropped.
    Interrupted,
}

/// Why an experiment stopped before its end.
#[derive(Debug, thiserror::Error)]
pub enum ExperimentError<E: std::error::Error + 'static> {
    /// A trial failed.
    #[error("trial {trial}: {source}")]
    Trial {
        /// Its number.
        trial: u32,
        /// Why.
        source: E,
    },
    /// A finished trial could not be kept.
    #[error(transparent)]
    Parts(#[from] PartsError),
}

/// The trials of one scenario, or those of them that a shard has.
#[derive(Debug)]
pub struct Experiment<'a> {
    /// How many trials there are to be, in all shards together.
    pub trials: u32,
    /// Which of them are to be run.
    pub shard: Shard,
    /// Where finished trials are kept.
    pub parts: &'a Parts,
}

/// Threads that run trials.
#[derive(Debug)]
pub struct Pool<'a> {
    /// How many trials run at a time.
    pub jobs: NonZeroUsize,
    /// Cancelled when somebody wants the trials to stop.
    pub stop: &'a CancellationToken,
}

impl Experiment<'_> {
    /// How many of its trials are kept by now.
    #[must_use]
    pub fn kept(&self) -> u32 {
        self.len() - self.missing().len() as u32
    }

    /// How many trials it has.
    #[must_use]
    pub fn len(&self) -> u32 {
        self.shard.trials(self.trials).len() as u32
    }

    /// Whether it has none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn missing(&self) -> Vec<u32> {
        self.parts.missing(self.shard.trials(self.trials))
    }
}

impl Pool<'_> {
    /// Runs those trials of `experiments` that are not kept yet, keeps each as soon as it has finished, and tells `finished` of
    /// it on the calling thread, with the place of its experiment. Experiments take turns, so that they come on alike.
    ///
    /// `run` is called once a trial, on any thread; it should watch the token and give up early, with whatever error,
    /// when that is cancelled. No trial starts then.
    ///
    /// # Errors
    /// The first error, after which the other trials under way are dropped.
    pub fn run<E: std::error::Error + Send + 'static>(
        &self,
        experiments: &[Experiment],
        run: impl Fn(usize, u32) -> Result<TrialRecord, E> + Sync,
        mut finished: impl FnMut(usize, &FinishedTrial),
    ) -> Result<Ending, ExperimentError<E>> {
        let run = |(experiment, trial): (usize, u32)| {
            let start = Instant::now();
            let record = run(experiment, trial).map_err(|source| ExperimentError::Trial { trial, source })?;
            let mut part = FinishedTrial {
                wall_s: start.elapsed().as_secs_f64(),
                record,
            };
            experiments[experiment].parts.save(&mut part)?;
            tracing::info!(
                experiment,
                trial,
                wall_s = part.wall_s,
                steps = part.record.steps,
                "finished"
            );
            Ok((experiment, part))
        };
        let mut missing: Vec<(usize, u32)> = Vec::new();
        for (place, experiment) in experiments.iter().enumerate() {
            missing.extend(experiment.missing().into_iter().map(|trial| (place, trial)));
        }
        missing.sort_by_key(|&(_, trial)| trial);
        run_trials(&missing, self.jobs, self.stop, run, |(experiment, part)| {
            finished(experiment, &part);
        })
    }
}

/// Runs `trials` on `jobs` threads and hands what each leaves to `finished`, on the calling thread, in the order in
/// which they finish. The first error cancels `stop`; errors after a cancellation are those of dropped trials.
pub fn run_trials<J: Copy + Sync, T: Send, E: Send>(
    trials: &[J],
    jobs: NonZeroUsize,
    stop: &CancellationToken,
    run: impl Fn(J) -> Result<T, E> + Sync,
    mut finished: impl FnMut(T),
) -> Result<Ending, E> {
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    thread::scope(|scope| {
        for _ in 0..jobs.get().min(trials.len()) {
            let sender = sender.clone();
            let (next, run) = (&next, &run);
            scope.spawn(move || work(trials, next, stop, run, &sender));
        }
        drop(sender);
        let mut left = trials.len();
        for result in receiver {
            match result {
                Ok(result) => {
                    finished(result);
                    left -= 1;
                }
                Err(_) if stop.is_cancelled() => {}
                Err(error) => {
                    stop.cancel();
                    return Err(error);
                }
            }
        }
        Ok(if left == 0 {
            Ending::Finished
        } else {
            Ending::Interrupted
        })
    })
}

/// Takes the next trial as long as there is one, none of its own has failed, and nobody has cancelled.
fn work<J: Copy, T, E>(
    trials: &[J],
    next: &AtomicUsize,
    stop: &CancellationToken,
    run: &(impl Fn(J) -> Result<T, E> + Sync),
    results: &mpsc::Sender<Result<T, E>>,
) {
    while !stop.is_cancelled() {
        let Some(&trial) = trials.get(next.fetch_add(1, Ordering::Relaxed)) else {
            return;
        };
        let result = run(trial);
        let failed = result.is_err();
        if results.send(result).is_err() || failed {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::sync::Mutex;

    fn jobs(jobs: usize) -> NonZeroUsize {
        NonZeroUsize::new(jobs).unwrap()
    }

    #[test]
    fn every_trial_runs_once_however_many_threads_there_are() {
        let trials: Vec<u32> = (0..50).collect();
        for threads in [1, 3, 100] {
            let mut seen = Vec::new();
            let stop = CancellationToken::new();
            let ending = run_trials(&trials, jobs(threads), &stop, Ok::<_, ()>, |trial| seen.push(trial));
            seen.sort_unstable();
            assert_eq!((ending, &seen), (Ok(Ending::Finished), &trials));
        }
    }

    #[test]
    fn no_trial_at_all_is_a_finished_experiment() {
        let stop = CancellationToken::new();
        assert_eq!(
            run_trials(&[], jobs(2), &stop, Ok::<u32, ()>, |_| ()),
            Ok(Ending::Finished)
        );
    }

    #[test]
    fn the_first_error_comes_back_and_no_further_trial_starts() {
        let started = Mutex::new(BTreeSet::new());
        let run = |trial: u32| {
            started.lock().unwrap().insert(trial);
            if trial == 3 { Err("broken") } else { Ok(()) }
        };
        let trials: Vec<u32> = (0..1000).collect();
        let stop = CancellationToken::new();
        assert_eq!(run_trials(&trials, jobs(1), &stop, run, |()| ()), Err("broken"));
        assert_eq!(started.lock().unwrap().len(), 4);
    }

    #[test]
    fn after_a_cancellation_finished_trials_count_and_errors_do_not() {
        let stop = CancellationToken::new();
        let run = |trial: u32| {
            if trial == 2 {
                stop.cancel();
                return Err("gave up because of the cancellation");
            }
            Ok(trial)
        };
        let mut seen = Vec::new();
        let ending = run_trials(&[0, 1, 2, 3], jobs(1), &stop, run, |trial| seen.push(trial));
        assert_eq!((ending, seen), (Ok(Ending::Interrupted), vec![0, 1]));
    }
}
