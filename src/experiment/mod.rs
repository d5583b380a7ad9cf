//! Experiments: the trials of scenarios, run in parallel, each kept as soon as it has finished.
//!
//! A [`Pool`] spreads the trials of one [`Experiment`] or many over threads, a trial on one thread; what a trial gives depends on its number alone,
//! so results do not depend on how many threads there were. [`Parts`] keeps finished trials on disk until all are
//! there, so that an interrupted experiment is taken up where it stopped. A [`Shard`] is the part of an experiment that one of several processes runs;
//! [`Kept`] finds the trials of them all.

mod claim;
mod kept;
mod part_file;
mod parts;
mod run;
mod shard;
mod trial;

pub use crate::kind::TrialError;
pub use claim::Claim;
pub use kept::{Found, Kept};
pub use part_file::{FinishedTrial, Key};
pub use parts::{Parts, PartsError, replace};
pub(crate) use run::run_trials;
pub use run::{Ending, Experiment, ExperimentError, Pool};
pub use shard::Shard;
pub use trial::{reach, run_trial, run_trial_in, trace_trial, watch_trial};
