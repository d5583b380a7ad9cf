//! The shared radio, measured in whole runs of the kind `Traffic`: against closed forms, against ns-3 on the same topologies, and against the disk radio, of which it is the
//! general case.

mod air;
mod disk;
mod forms;
mod invariants;
mod ns3;
mod predictions;

use desim::experiment::run_trial;
use desim::metrics::{TopicFates, TrialRecord};
use desim::radio::LossCause;
use desim::scenario::{Scenario, parse};
use desim::simulation::DriverKind;
use tokio_util::sync::CancellationToken;

/// Robots that all hear each other with −50 dBm, whatever their places: the topology `all`.
const EVERYBODY: &str = "arena: (size: (9.0, 9.0)), swarm: (robots: 20, deploy: Uniform),";
const EQUAL_LOSS: &str = "path_loss: LogDistance(exponent: 0.000001, reference_loss: 50.0), transmit_power: 0.0,";

/// Three robots of which the outer ones hear the one between them and not each other: a wall parts them.
const HIDDEN: &str = "arena: (size: (9.0, 9.0), obstacles: [Wall(from: (0.0, -1.0), to: (0.0, 1.0))]), \
    swarm: (robots: 3, deploy: At([(-0.5, 0.0), (0.0, 1.5), (0.5, 0.0)])),";

/// A scenario of traffic over a shared radio: what robots send, where they are, what the radio is.
fn scenario(seconds: f64, traffic: &str, place: &str, radio: &str) -> Scenario {
    let text = format!(
        "Scenario(name: \"traffic\", time_limit: {seconds:?}, control: (period: 0.5, phase: Together), \
         metrics: (sample_interval: 0.0), {place} protocol: Traffic({traffic}), radio: Shared({radio}))"
    );
    parse("traffic.ron", &text, &[]).unwrap_or_else(|report| panic!("{text}\n{report}"))
}

/// `trials` trials of it, each with robots of its own number if `robots` says so.
fn runs(scenario: &Scenario, trials: u32) -> Vec<TrialRecord> {
    let run = |trial| run_trial(scenario, trial, DriverKind::Inline, &CancellationToken::new());
    (0..trials).map(|trial| run(trial).expect("the trial runs")).collect()
}

fn with_robots(mut scenario: Scenario, robots: u32) -> Scenario {
    scenario.swarm.robots = robots;
    scenario
}

/// The copies of a trial whose fate is known.
fn fates(record: &TrialRecord) -> TopicFates {
    let mut sum = TopicFates::default();
    record.ledger.iter().for_each(|fates| sum.add(fates));
    assert!(sum.is_balanced(), "{sum}");
    sum
}

/// The share of copies delivered of those whose fate is known.
fn delivery(record: &TrialRecord) -> f64 {
    let fates = fates(record);
    fates.delivered as f64 / (fates.offered - fates.in_flight) as f64
}

fn lost_to(record: &TrialRecord, cause: LossCause) -> f64 {
    let fates = fates(record);
    fates.lost[cause as usize] as f64 / (fates.offered - fates.in_flight) as f64
}

/// A mean over trials and its standard error.
#[derive(Clone, Copy, Debug)]
struct Measured {
    mean: f64,
    error: f64,
}

fn measured(records: &[TrialRecord], figure: impl Fn(&TrialRecord) -> f64) -> Measured {
    let values: Vec<f64> = records.iter().map(figure).collect();
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    Measured {
        mean,
        error: (squares / (count - 1.0) / count).sqrt(),
    }
}

impl Measured {
    /// Holds if it is within three standard errors of both sides of what is expected, and so many more of `slack`: what the form itself neglects.
    #[track_caller]
    fn agrees(self, what: &str, expected: f64, error: f64, slack: f64) {
        let allowed = 3.0 * self.error.hypot(error) + slack;
        assert!(
            (self.mean - expected).abs() <= allowed,
            "{what}: {:.5} ± {:.5}, expected {expected:.5} ± {error:.5}: off by {:.5}, allowed {allowed:.5}",
            self.mean,
            self.error,
            self.mean - expected
        );
    }
}
