//! For tests of formats: a shipped scenario, run and traced.

use tokio_util::sync::CancellationToken;

use super::context::Run;
use crate::experiment::{reach, watch_trial};
use crate::happenings::log::{Log, Selection, Sink};
use crate::metrics::TrialRecord;
use crate::scenario::{Override, Scenario, parse};

/// Robots that send statuses to each other over a disk, crash, go deaf and mute, and recover.
pub const FAULTS: &str = include_str!("../../../scenarios/faults/crash_and_recover.ron");
/// Robots that share a channel.
pub const SHARED: &str = include_str!("../../../scenarios/radio/ieee802154.ron");

/// The scenario in `text`, with what is `set`.
pub fn scenario(text: &str, set: &[&str]) -> Scenario {
    let set: Vec<Override> = set.iter().map(|set| set.parse().unwrap()).collect();
    parse("scenario.ron", text, &set).unwrap()
}

/// Its first trial.
pub fn run(scenario: &Scenario) -> Run {
    Run::new(scenario, 0, "0", reach(scenario, 0))
}

/// That trial's record, and the sink that was told of a `selection` of it.
pub fn traced<S: Sink + 'static>(scenario: &Scenario, selection: Selection, sink: S) -> (TrialRecord, S) {
    let log = Log::new(selection, scenario.radio.shared().is_some(), sink);
    let (record, log) = watch_trial(scenario, 0, log, &CancellationToken::new()).unwrap();
    (record, log.into_sink().unwrap())
}
