use crate::spool::Scratch;
use serde_json::Value;

use super::*;
use crate::engine::{ActorId, SimTime};
use crate::faults::Effect;
use crate::geometry::{Pose, Vec2};
use crate::metrics::detection::{Cause, DetectionRecord, Missed, Suspicion};
use crate::metrics::episode::{FaultEpisode, FaultKind};
use crate::metrics::volume::TopicFates;
use crate::metrics::{HeaderBytes, Layout, MetricsConfig, Mission, Outcome, Recorder, RumorSpread, RunEnd, Ties};
use crate::protocol::{MessageSize, Note, Role, Topic};
use crate::radio::{LossCause, Reach};

mod detection;
mod listed;
mod many;

const TOPICS: [&str; 2] = ["status", "alarm"];
const ROLES: [&str; 2] = ["free", "worker"];

/// A trial of two robots and 10 control steps: robot 0 sends ten statuses of 4 bytes, of which robot 1 hears
/// `heard`; while a worker, robot 1 answers with one alarm of 15 bytes that is still under way at the end.
fn trial(number: u32, heard: u64) -> TrialRecord {
    let layout = Layout {
        robots: 2,
        topics: 2,
        roles: 2,
        headers: HeaderBytes { frame: 2, message: 3 },
        reach: Reach::Disk(2.0),
        control_period: Span::from_secs(0.1),
        mission: Some(Mission {
            targets: vec![],
            reach: 0.3,
            ties: Ties::Parents { within: 1.7 },
            root: ActorId(0),
            root_role: None,
            worker_role: Role(1),
        }),
        rumors: 0,
        completion: crate::protocol::CompletionConfig::default(),
        status_memory: Span::from_secs(8.0),
        patience: Span::from_secs(4.0),
        status: None,
        scratch: Scratch::default(),
    };
    let mut recorder = Recorder::new(layout, &MetricsConfig::default());
    for frame in 0..10 {
        recorder.transmitted(ActorId(0), Topic(0), MessageSize::alone(4));
        recorder.offered(Topic(0), 1);
        if frame < heard {
            recorder.delivered(ActorId(1), Topic(0), MessageSize::alone(4), Span::from_secs(0.02));
        } else {
            recorder.lost(ActorId(1), Topic(0), LossCause::Channel, MessageSize::alone(4));
        }
    }
    recorder.note(ActorId(1), &Note::Role(Role(1)));
    recorder.transmitted(ActorId(1), Topic(1), MessageSize::alone(15));
    recorder.offered(Topic(1), 1);
    recorder.in_flight(Topic(1), Some(Span::from_secs(0.02)));
    recorder.sample(SimTime::ZERO, &[Vec2::zeros(), Vec2::new(1.0, 0.0)]);
    recorder.sample(
        SimTime::from_secs(1.0),
        &[Vec2::zeros(), Vec2::new(2.0 + f64::from(number), 0.0)],
    );
    recorder.finish(RunEnd {
        trial: number,
        seed: 1,
        steps: 10,
        simulated: SimTime::from_secs(1.0),
        events: 30,
        digest: u128::from(number),
        robot_steps: vec![10; 2],
        poses: vec![Pose::default(); 2],
    })
}

fn summary() -> Summary {
    let mut records = [trial(0, 8), trial(1, 6)];
    records[0].outcome = Outcome::Completed { step: 7 };
    Summary::of("duet", &TOPICS, &ROLES, &records)
}

fn json() -> Value {
    serde_json::to_value(summary()).unwrap()
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

#[test]
fn frames_are_summed_over_trials_by_fate_and_by_topic() {
    let frames = &json()["frames"];
    assert_eq!(frames["offered"], 22);
    assert_eq!(
        (&frames["delivered"], &frames["in_flight"], &frames["lost"]["channel"]),
        (&14.into(), &2.into(), &6.into())
    );
    let alarm = &frames["by_topic"]["alarm"];
    assert_eq!(
        (&alarm["offered"], &alarm["in_flight"], &alarm["lost"]["channel"]),
        (&2.into(), &2.into(), &0.into())
    );
}

#[test]
fn bandwidth_is_bytes_of_a_robot_over_control_steps_with_and_without_headers() {
    // Sent: robot 0 ten frames of 4 + 5 B in ten steps, 9 B/step; robot 1 one of 15 + 5 B, 2 B/step.
    let Directions {
        tx_bytes_per_step: tx,
        rx_bytes_per_step: rx,
        tx_payload_bytes_per_step: payload,
        ..
    } = summary().bandwidth.total;
    assert_eq!((tx.min, tx.median, tx.max), (Some(2.0), Some(5.5), Some(9.0)));
    assert_eq!(
        tx.mean,
        Estimate {
            value: Some(5.5),
            ci95: [Some(5.5); 2],
            n: 2
        },
        "what robots send is fixed here, and so is its mean"
    );
    assert_eq!((payload.min, payload.max), (Some(1.5), Some(4.0)));
    // Received: robot 0 nothing, robot 1 eight and six frames of 9 B: means over robots 3.6 and 2.7.
    assert_eq!((rx.min, rx.max), (Some(0.0), Some(7.2)));
    assert!((rx.mean.value.unwrap() - 3.15).abs() < 1e-12);
}

#[test]
fn topics_and_roles_add_up_to_the_whole() {
    let Bandwidth {
        total,
        by_topic,
        by_role,
    } = summary().bandwidth;
    let tx_mean = |directions: &Directions| directions.tx_bytes_per_step.mean.value.unwrap();
    let topics: f64 = by_topic.0.iter().map(|(_, topic)| tx_mean(&topic.directions)).sum();
    let roles: f64 = by_role.0.iter().map(|(_, role)| tx_mean(role)).sum();
    assert_eq!((topics, roles), (tx_mean(&total), tx_mean(&total)));
    let (_, status) = &by_topic.0[0];
    assert_eq!(status.header_share.value, Some(5.0 / 9.0));
    // Lost: two and four frames of 9 B, to robot 1.
    assert_eq!(status.lost_bytes_per_step.max, Some(3.6));
}

#[test]
fn outcomes_delivery_and_connectivity_are_estimates_over_trials() {
    let summary = summary();
    assert_eq!((summary.trials, summary.completed), (2, 1));
    assert_eq!(summary.completion_ratio.estimate, crate::statistics::proportion(1, 2));
    assert_eq!(
        summary.steps_to_completion.median.value,
        Some(8.5),
        "half are done from step 7 on, the other is cut off at 10"
    );
    // Of 22 copies 6 were lost; the 2 under way have not been.
    assert_eq!(summary.delivery_ratio.estimate.value, Some(16.0 / 22.0));
    // Trial 0 ends with the robots 2 m apart, just in range; trial 1 with 3 m.
    assert_eq!(summary.connected_share.estimate.value, Some(0.75));
    assert_eq!(summary.lambda2_min.min, Some(0.0));
    assert!(
        (summary.lambda2_min.estimate.value.unwrap() - 1.0).abs() < 1e-9,
        "median of 2 and 0"
    );
    assert_eq!(summary.robots_used.estimate.value, Some(1.0));
    assert_eq!((summary.steps.value, summary.simulated_s.value), (20, 2.0));
    assert_eq!((summary.latency_s.p50, summary.latency_s.p99), (Some(0.02), Some(0.02)));
    assert_eq!(
        summary.load_imbalance.rx.value,
        Some(0.5),
        "one of two robots hears everything"
    );
}

#[test]
fn keys_are_stable_and_in_a_stable_order() {
    let json = json();
    let top = [
        "scenario",
        "trials",
        "completed",
        "digest",
        "completion_ratio",
        "steps_to_completion",
        "frames",
        "delivery_ratio",
        "latency_s",
        "bandwidth",
        "load_imbalance",
        "lambda2_min",
        "connected_share",
        "robots_used",
        "duplicates",
        "detection",
        "steps",
        "simulated_s",
        "figures",
    ];
    assert_eq!(keys(&json), top);
    assert_eq!(keys(&json["figures"]), ["completion_s", "neighbours"]);
    assert_eq!(
        keys(&json["figures"]["neighbours"]),
        ["name", "value", "ci95", "n", "unit"]
    );
    assert_eq!(
        keys(&json["frames"]),
        ["offered", "delivered", "in_flight", "lost", "by_topic", "unit"]
    );
    let detection = [
        "suspicions",
        "mistakes",
        "failures",
        "detection_time_s",
        "mistake_recurrence_s",
        "mistake_duration_s",
        "mistake_rate_hz",
        "query_accuracy",
        "monitored_s",
    ];
    assert_eq!(keys(&json["detection"]), detection);
    assert_eq!(keys(&json["delivery_ratio"]), ["value", "ci95", "n", "unit"]);
    assert_eq!(keys(&json["steps_to_completion"]), ["median", "unit"]);
    assert_eq!(
        keys(&json["detection"]["mistake_duration_s"]),
        ["value", "ci95", "n", "cut_off", "restricted_to", "unit"]
    );
    assert_eq!(keys(&json["latency_s"]), ["p50", "p95", "p99", "mean", "unit"]);
    assert_eq!(keys(&json["lambda2_min"]), ["value", "ci95", "n", "min", "unit"]);
    let directions = [
        "tx_bytes_per_step",
        "rx_bytes_per_step",
        "tx_payload_bytes_per_step",
        "rx_payload_bytes_per_step",
    ];
    assert_eq!(
        keys(&json["bandwidth"]),
        [&directions[..], &["by_topic", "by_role"]].concat()
    );
    assert_eq!(keys(&json["bandwidth"]["by_topic"]), TOPICS);
    assert_eq!(keys(&json["bandwidth"]["by_role"]), ROLES);
    assert_eq!(
        keys(&json["bandwidth"]["tx_bytes_per_step"]),
        ["min", "median", "p95", "max", "mean", "unit"]
    );
    let topic = [&directions[..], &["lost_bytes_per_step", "header_share"]].concat();
    assert_eq!(keys(&json["bandwidth"]["by_topic"]["status"]), topic);
}

#[test]
fn the_digest_depends_on_every_trial_and_their_order() {
    let (a, b) = (trial(0, 8), trial(1, 8));
    let digest = |records: &[TrialRecord]| Summary::of("duet", &TOPICS, &ROLES, records).digest;
    let [both, swapped, one] = [digest(&[a.clone(), b.clone()]), digest(&[b, a.clone()]), digest(&[a])];
    assert!(both != swapped && both != one && both.len() == 32);
}

#[test]
fn an_experiment_without_trials_or_mission_has_absent_figures_not_invented_ones() {
    let nothing = Summary::of("void", &TOPICS, &ROLES, &[]);
    assert_eq!(nothing.steps_to_completion.median, Estimate::default());
    assert_eq!(
        (nothing.latency_s.p50, nothing.bandwidth.total.tx_bytes_per_step.max),
        (None, None)
    );
    let mut still = trial(0, 8);
    still.outcome = Outcome::NoMission;
    let summary = Summary::of("still", &TOPICS, &ROLES, &[still]);
    assert_eq!(
        (summary.completion_ratio.estimate.n, summary.robots_used.estimate.value),
        (0, None)
    );
    assert_eq!(
        summary.delivery_ratio.estimate.ci95,
        [None, None],
        "one trial has no interval"
    );
}

#[test]
fn a_lossless_radio_delivers_everything_however_much_is_under_way_and_a_deaf_receiver_hears_its_share() {
    let ledger = |delivered, unheard, in_flight| {
        let mut record = trial(0, 8);
        let mut fates = TopicFates {
            offered: delivered + unheard + in_flight,
            delivered,
            in_flight,
            ..TopicFates::default()
        };
        fates.lost[LossCause::ReceiverDown as usize] = unheard;
        record.ledger = vec![fates];
        record
    };
    let delivered = |records: &[TrialRecord]| Summary::of("duet", &TOPICS, &ROLES, records).delivery_ratio.estimate;
    let lossless = delivered(&[ledger(560, 0, 440), ledger(610, 0, 390)]);
    assert_eq!((lossless.value, lossless.ci95[1]), (Some(1.0), Some(1.0)));
    assert!(
        lossless.ci95[0].is_some_and(|low| low > 0.998),
        "of 2,000 copies none was lost"
    );
    assert_eq!(delivered(&[ledger(0, 0, 7)]).value, Some(1.0));
    let deaf = delivered(&[ledger(600, 200, 400)]);
    assert_eq!(
        deaf.value,
        Some(0.75),
        "of what came as far as its receiver; the rest will fare alike"
    );
}

#[test]
fn who_is_down_at_the_end_is_no_robot_that_a_rumour_should_have_reached() {
    let mut record = trial(0, 8);
    let at = |seconds: f64| Some(SimTime::from_secs(seconds));
    record.spread = vec![RumorSpread {
        informed: vec![at(0.25), None],
        hops: vec![Some(0), None],
    }];
    let fault = |until| FaultEpisode {
        fault: 0,
        kind: FaultKind::Robot {
            robot: ActorId(1),
            effect: Effect::Crash,
            role: 0,
            target: None,
        },
        from: SimTime::from_secs(0.1),
        until,
    };
    let spread = |faults: Vec<FaultEpisode>| {
        let mut record = record.clone();
        record.faults = faults;
        let summary = Summary::of("duet", &TOPICS, &ROLES, &[record]);
        let spread = summary.spread.expect("there is a rumour");
        (spread.informed_ratio.estimate.value, spread.time_to_all.median.value)
    };
    assert_eq!(spread(vec![fault(None)]), (Some(1.0), Some(0.25)));
    assert_eq!(
        spread(vec![fault(at(0.5))]),
        (Some(0.5), None),
        "who is well again counts"
    );
    assert_eq!(spread(Vec::new()), (Some(0.5), None));
}

#[test]
fn a_robot_is_measured_by_its_own_control_steps() {
    let mut record = trial(0, 8);
    record.robots[0].steps = 9;
    let tx = Summary::of("duet", &TOPICS, &ROLES, &[record])
        .bandwidth
        .total
        .tx_bytes_per_step;
    assert_eq!(
        (tx.min, tx.max),
        (Some(2.0), Some(10.0)),
        "90 B in nine steps, 20 B in ten"
    );
}
