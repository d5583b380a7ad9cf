//! Gossip settings at work: rumours against closed forms, messages that share a frame, and a backbone that says less.

mod backbone;
mod piggyback;
mod rumours;
mod walkers;

use desim::experiment::run_trial;
use desim::metrics::TrialRecord;
use desim::scenario::{Scenario, parse};
use desim::simulation::DriverKind;

/// The scenario in `text`.
fn scenario(text: &str) -> Scenario {
    parse("gossip.ron", text, &[]).unwrap_or_else(|report| panic!("{report}"))
}

fn run(scenario: &Scenario, trials: u32) -> Vec<TrialRecord> {
    let trial = |trial| run_trial(scenario, trial, DriverKind::Inline, &Default::default());
    (0..trials)
        .map(|number| trial(number).expect("a trial runs to its end"))
        .collect()
}
