//! The figures of runs, held against closed forms and independent counts: detection, estimators, predictions.

#[path = "../shipped/mod.rs"]
mod shipped;

mod asked;
mod detection;
mod estimators;
#[cfg(all(feature = "command", feature = "parquet"))]
mod failed_missions;
mod metrics;
#[cfg(feature = "command")]
mod predictions;
mod preflight;
