//! Failure detectors run by whole robots in whole runs, scored against the truth, and their closed forms.
//!
//! A figure must lie within four standard errors. Seeds are fixed: what passes goes on passing.

mod foreign;
mod missions;
mod moving;
mod nfd_s;
mod none;
mod phi;
mod swim;
mod timeout;

use desim::experiment::run_trial;
use desim::metrics::{Summary, TrialRecord};
use desim::scenario::parse;
use desim::simulation::DriverKind;
use tokio_util::sync::CancellationToken;

const ROBOTS: u32 = 20;
/// Length of a long run, seconds.
const SECONDS: f64 = 600.0;
/// Constant latency d, seconds.
const LATENCY: f64 = 0.05;

/// A loss model with the law of its gaps.
struct Channel {
    loss: String,
    /// P(G = 1), P(G = 2), …
    gaps: Vec<f64>,
    /// Share of heartbeats that arrive.
    arriving: f64,
    /// How fast the link forgets its state, from one heartbeat to the next.
    memory: f64,
}

fn bernoulli(p: f64) -> Channel {
    Channel {
        loss: format!("Bernoulli({p:?})"),
        gaps: (0..2000).map(|lost| (1.0 - p) * f64::powi(p, lost)).collect(),
        arriving: 1.0 - p,
        memory: 0.0,
    }
}

fn gilbert(p: f64, r: f64) -> Channel {
    let burst = (0..2000).map(|longer| p * r * f64::powi(1.0 - r, longer));
    Channel {
        loss: format!("GilbertElliott(good_to_bad: {p:?}, bad_to_good: {r:?})"),
        gaps: [1.0 - p].into_iter().chain(burst).collect(),
        arriving: r / (p + r),
        memory: 1.0 - p - r,
    }
}

/// Robots that stand in range of each other, run `detector`, and send heartbeats every `period` seconds, each at a phase of
/// its own. They wake at every reception, so that trust is as exact in time as suspicion.
fn heartbeats(detector: &str, loss: &str, period: f64, seconds: f64, more: &str) -> TrialRecord {
    swarm(
        ROBOTS,
        detector,
        loss,
        &format!("Constant({LATENCY:?})"),
        period,
        seconds,
        more,
    )
}

fn swarm(robots: u32, detector: &str, loss: &str, latency: &str, period: f64, seconds: f64, more: &str) -> TrialRecord {
    let text = format!(
        "Scenario(name: \"heartbeats\", time_limit: {seconds:?}, {more}
         swarm: (robots: {robots}, deploy: Cluster(radius: 0.9)), protocol: Heartbeat,
         control: (period: {period:?}, phase: Random, wake: OnReception), gossip: (status: (interval: {period:?})),
         detector: {detector}, radio: (loss: {loss}, latency: {latency}),
         metrics: (sample_interval: 0.0))"
    );
    let scenario = parse("heartbeats.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}"));
    run_trial(&scenario, 0, DriverKind::Inline, &CancellationToken::new()).expect("the trial reaches its end")
}

fn summary(record: TrialRecord) -> Summary {
    Summary::of("heartbeats", &["status"], &["robot"], &[record])
}

/// Mean and variance of the gaps numbered by `range`, given that they are such.
fn moments(gaps: &[f64], range: impl Fn(usize) -> bool) -> (f64, f64) {
    let chosen = || (1..).zip(gaps).filter(|(gap, _)| range(*gap));
    let sum = |of: &dyn Fn(f64) -> f64| chosen().map(|(gap, p)| p * of(gap as f64)).sum::<f64>();
    let (total, mean) = (sum(&|_| 1.0), sum(&|gap| gap));
    if total == 0.0 {
        return (0.0, 0.0);
    }
    let mean = mean / total;
    (mean, sum(&|gap| (gap - mean).powi(2)) / total)
}

#[track_caller]
fn assert_near(what: &str, measured: f64, expected: f64, standard_error: f64) {
    assert!(
        (measured - expected).abs() <= 4.0 * standard_error,
        "{what}: measured {measured}, expected {expected} ± {}",
        4.0 * standard_error
    );
}

/// The mean of independent samples, and its standard error.
fn mean_and_error(samples: &[f64]) -> (f64, f64) {
    let count = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / count;
    let variance = samples.iter().map(|sample| (sample - mean).powi(2)).sum::<f64>() / (count - 1.0);
    (mean, (variance / count).sqrt())
}
