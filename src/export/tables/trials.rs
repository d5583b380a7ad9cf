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
    robots: u32,
    robots_used: Option<u32>,
    events: u64,
    lambda2_min: Option<f64>,
    connected_share: Option<f64>,
    robots_failed: u32,
    suspicions: u64,
    pairs: u64,
    monitored_s: f64,
    mistaken_s: f64,
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
        robots: record.robots.len() as u32,
        robots_used: record.robots_used().map(|robots| robots as u32),
        events: record.events,
        lambda2_min: record.lambda2_min(),
        connected_share: record.connected_share(),
        robots_failed: record.failed_robots().len() as u32,
        suspicions: record.detection.suspicions.len() as u64,
        pairs: record.detection.pairs,
        monitored_s: record.detection.monitored_s,
        mistaken_s: record.detection.mistaken_s,
        latency_min: record.latency.min(),
        latency_max: record.latency.max(),
        latency_sum_ns: record.latency.sum_nanos(),
        digest: record.digest,
    }
}

type Col = Column<Row>;

pub fn columns() -> Vec<Column<Row>> {
    vec![
        Col::id("trial", |row| row.trial),
        Col::key("seed", |row| row.seed),
        Col::text("outcome", |row| outcome(row.outcome).into()),
        Col::optional_count("steps_to_completion", |row| match row.outcome {
            Outcome::Completed { step } => Some(step),
            Outcome::Censored | Outcome::NoMission => None,
        }),
        Col::count("steps", |row| row.steps),
        Col::f64("control_period_s", |row| row.control_period_s),
        Col::f64("simulated_s", |row| row.simulated_s),
        Col::id("robots", |row| row.robots),
        Col::optional_id("robots_used", |row| row.robots_used),
        Col::count("events", |row| row.events),
        Col::optional_f64("lambda2_min", |row| row.lambda2_min),
        Col::optional_f64("connected_share", |row| row.connected_share),
        Col::id("robots_failed", |row| row.robots_failed),
        Col::count("suspicions", |row| row.suspicions),
        Col::count("pairs", |row| row.pairs),
        Col::f64("monitored_s", |row| row.monitored_s),
        Col::f64("mistaken_s", |row| row.mistaken_s),
        Col::optional_key("latency_min_ns", |row| row.latency_min.map(Span::as_nanos)),
        Col::optional_key("latency_max_ns", |row| row.latency_max.map(Span::as_nanos)),
        // A day of delay-tolerant traffic adds up to more nanoseconds than whole numbers of 64 bits hold.
        Col::optional_f64("latency_sum_ns", |row| {
            row.latency_min.map(|_| row.latency_sum_ns as f64)
        }),
        Col::text("digest", |row| format!("{:032x}", row.digest).into()),
    ]
}

fn outcome(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Completed { .. } => "completed",
        Outcome::Censored => "censored",
        Outcome::NoMission => "no_mission",
    }
}
