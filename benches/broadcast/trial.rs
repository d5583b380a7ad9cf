//! The paper's 80-robot trial, four links a target: a dense cluster, in which each robot hears tens of others.

use std::path::Path;

use desim::experiment::run_trial;
use desim::scenario::load;
use desim::simulation::DriverKind;
use tokio_util::sync::CancellationToken;

use crate::workload::Counts;

pub const ROBOTS: u32 = 80;

/// Runs one whole trial, radio, motion, protocol and metrics.
pub fn run(driver: DriverKind) -> Counts {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/paper/completion_80x4.ron");
    let scenario = load(&file, &[]).expect("a shipped scenario");
    let record = run_trial(&scenario, 0, driver, &CancellationToken::new()).expect("the trial reaches its end");
    Counts {
        simulated_s: record.simulated.as_secs(),
        deliveries: record.ledger.iter().map(|topic| topic.delivered).sum(),
        suspicions: record.detection.suspicions.len() as u64,
    }
}
