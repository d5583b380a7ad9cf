//! The figures of runs, held against closed forms and independent counts: detection, estimators, predictions.

#[path = "../shipped/mod.rs"]
mod shipped;

mod detection;
mod estimators;
mod failed_missions;
mod metrics;
mod predictions;
mod preflight;
