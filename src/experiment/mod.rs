//! Experiments: the trials of scenarios, run in parallel, each kept as soon as it has finished.
//!
//! A [`Pool`] spreads the trials of one [`Experiment`] or many over threads, a trial on one thread; what a trial gives depends on its number alone,
//! so results do not depend on how many threads there were. [`Parts`] keeps finished trials on disk until all are
//! there, so that an interrupted experiment is taken up where it stopped.

mod parts;
mod run;
mod trial;

pub use crate::kind::TrialError;
pub use parts::{FinishedTrial, Parts, PartsError};
pub(crate) use run::run_trials;
pub use run::{Ending, Experiment, ExperimentError, Pool};
pub use trial::{reach, run_trial, run_trial_in, trace_trial, watch_trial};
