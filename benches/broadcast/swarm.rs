//! The same workload as a user would run it: the library's heartbeat protocol over its radio.

use std::rc::Rc;
use std::sync::Arc;

use desim::engine::{ActorId, Span, Streams};
use desim::kinds::heartbeat::{Heartbeat, Settings};
use desim::metrics::MetricsConfig;
use desim::motion::MotionConfig;
use desim::protocol::control::{ControlConfig, PhaseConfig};
use desim::protocol::detector::DetectorConfig;
use desim::protocol::gossip::GossipConfig;
use desim::quantity::{NonNegative, Positive};
use desim::radio::RadioKind;
use desim::simulation::{DriverKind, Setup};
use tokio_util::sync::CancellationToken;

use crate::workload::{BODY_RADIUS_M, Counts, PERIOD_S, SEED, TIMEOUT_S, Workload};

pub fn run(workload: &Workload, driver: DriverKind) -> Counts {
    let setup = setup(workload);
    let detector = DetectorConfig::Timeout(Positive::new(TIMEOUT_S));
    let settings = Rc::new(Settings::new(
        &GossipConfig::default(),
        &detector,
        &setup.control,
        workload.poses.len(),
        Streams::new(SEED, 0),
    ));
    let robots = workload
        .poses
        .iter()
        .zip(0..)
        .map(|(_, id)| <Heartbeat>::new(ActorId(id), Rc::clone(&settings)))
        .collect();
    let record = setup
        .run(workload.poses.clone(), robots, driver, &CancellationToken::new())
        .expect("the run reaches its end");
    Counts {
        simulated_s: workload.seconds,
        deliveries: record.ledger.iter().map(|topic| topic.delivered).sum(),
        suspicions: record.detection.suspicions.len() as u64,
    }
}

fn setup(workload: &Workload) -> Setup {
    Setup {
        seed: SEED,
        time_limit: Span::from_secs(workload.seconds),
        arena: workload.arena.clone(),
        motion: MotionConfig {
            body_radius: Positive::new(BODY_RADIUS_M),
            ..MotionConfig::default()
        },
        control: ControlConfig {
            period: Positive::new(PERIOD_S),
            phase: PhaseConfig::Random,
            ..ControlConfig::default()
        },
        radio: workload.radio.disk().into_owned(),
        own_radio: workload
            .radio
            .shared()
            .map(|shared| Arc::new(shared.clone()) as Arc<dyn RadioKind>),
        // Connectivity is no part of the workload.
        metrics: MetricsConfig {
            sample_interval: NonNegative::new(0.0),
            ..MetricsConfig::default()
        },
        detector: DetectorConfig::Timeout(Positive::new(TIMEOUT_S)),
        ..Setup::default()
    }
}
