//! `trials.parquet`: a row a trial.

use super::super::table::Column;
use crate::engine::Span;
use crate::metrics::{Outcome, TrialRecord};

/// A trial: everything about it that is one number.
pub struct Row {
    trial: u32,
    seed: u64,
    outcome: Outcome,
    steps: u64,
    control_period_s: f64,
    simulated_s: f64,
    robots: usize,
    robots_used: Option<usize>,
    events: u64,
    lambda2_min: Option<f64>,
    connected_share: Option<f64>,
    suspicions: u64,
    latency_min: Option<Span>,
    latency_max: Option<Span>,
    latency_sum_ns: u128,
    digest: u128,
}

pub fn row(record: &TrialRecord) -> Row {
    Row {
        trial: record.trial,
        seed: record.seed,
        outcome: record.outcome,
        steps: record.steps,
        control_period_s: record.control_period.as_secs(),
        simulated_s: record.simulated.as_secs(),
        robots: record.robots.len(),
        robots_used: record.robots_used(),
        events: record.events,
        lambda2_min: record.lambda2_min(),
        connected_share: record.connected_share(),
        suspicions: record.suspicions,
        latency_min: record.latency.min(),
        latency_max: record.latency.max(),
        latency_sum_ns: record.latency.sum_nanos(),
        digest: record.digest,
    }
}

type Col = Column<Row>;

pub fn columns() -> Vec<Column<Row>> {
    vec![
        Col::i32("trial", |row| row.trial as i32),
        Col::u64("seed", |row| row.seed),
        Col::text("outcome", |row| outcome(row.outcome).into()),
        Col::optional_i64("steps_to_completion", |row| match row.outcome {
            Outcome::Completed { step } => Some(step as i64),
            Outcome::Censored | Outcome::NoMission => None,
        }),
        Col::i64("steps", |row| row.steps as i64),
        Col::f64("control_period_s", |row| row.control_period_s),
        Col::f64("simulated_s", |row| row.simulated_s),
        Col::i32("robots", |row| row.robots as i32),
        Col::optional_i32("robots_used", |row| row.robots_used.map(|robots| robots as i32)),
        Col::i64("events", |row| row.events as i64),
        Col::optional_f64("lambda2_min", |row| row.lambda2_min),
        Col::optional_f64("connected_share", |row| row.connected_share),
        Col::i64("suspicions", |row| row.suspicions as i64),
        Col::optional_i64("latency_min_ns", |row| row.latency_min.map(nanos)),
        Col::optional_i64("latency_max_ns", |row| row.latency_max.map(nanos)),
        Col::optional_i64("latency_sum_ns", |row| i64::try_from(row.latency_sum_ns).ok()),
        Col::text("digest", |row| format!("{:032x}", row.digest).into()),
    ]
}

fn nanos(span: Span) -> i64 {
    span.as_nanos() as i64
}

fn outcome(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Completed { .. } => "completed",
        Outcome::Censored => "censored",
        Outcome::NoMission => "no_mission",
    }
}
