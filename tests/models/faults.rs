//! Runs in which robots and links fail.

use std::path::Path;

use desim::engine::{ActorId, SimTime};
use desim::experiment::run_trial;
use desim::metrics::{FaultKind, TrialRecord};
use desim::protocol::CompletionConfig;
use desim::quantity::{NonNegative, Positive};
use desim::radio::LossCause;
use desim::scenario::{Scenario, load, parse};
use desim::simulation::DriverKind;
use proptest::prelude::*;
use tokio_util::sync::CancellationToken;

use crate::shipped;

fn scenario(text: &str) -> Scenario {
    parse("test.ron", text, &[]).unwrap_or_else(|report| panic!("{report}"))
}

fn run_with(scenario: &Scenario, driver: DriverKind, trial: u32) -> TrialRecord {
    run_trial(scenario, trial, driver, &CancellationToken::new()).expect("the trial reaches its end")
}

fn run(scenario: &Scenario) -> TrialRecord {
    run_with(scenario, DriverKind::Inline, 0)
}

/// Still robots that all hear each other and say their status every 0.1 s, for 60 s; it arrives 20 ms later.
fn heartbeats(robots: u32, faults: &str) -> Scenario {
    scenario(&format!(
        "Scenario(name: \"beats\", time_limit: 60.0, swarm: (robots: {robots}, deploy: Cluster(radius: 0.9)), \
         control: (phase: Together), protocol: Heartbeat, radio: (latency: Constant(0.02)), faults: {faults})"
    ))
}

/// A backbone of 20 robots for two targets.
fn backbone(seconds: f64, faults: &str) -> Scenario {
    scenario(&format!(
        "Scenario(name: \"bones\", time_limit: {seconds:?}, swarm: (robots: 20, deploy: Cluster(radius: 0.75)), \
         protocol: Backbone(targets: Ring(count: 2, radius: 3.0, links: 2)), faults: {faults})"
    ))
}

fn sent(record: &TrialRecord, robot: u32) -> u64 {
    let mine = record.traffic.iter().filter(|row| row.robot == ActorId(robot));
    mine.map(|row| row.sent.frames).sum()
}

fn lost(record: &TrialRecord, robot: u32, cause: LossCause) -> u64 {
    let mine = record.traffic.iter().filter(|row| row.robot == ActorId(robot));
    mine.map(|row| row.lost[cause as usize].frames).sum()
}

const EVERY_KIND: &str = "[
    Silence(robots: [3], at: 2.0, lasts: For(3.3)),
    Crash(robots: [1, 4], at: 4.0, lasts: For(2.05)),
    Crash(robots: [4], at: 5.0, lasts: For(4.0)),
    Mute(robots: [5], at: 3.0),
    Deaf(robots: [6], at: 3.33, lasts: For(2.0)),
    Fallible(share: 0.5, hazard: 0.002),
    OnJoin(probability: 0.5, window: 10.0),
    Radiation(within: Disc(at: (1.0, 0.0), radius: 1.0), hazard: 0.01, lasts: For(1.5)),
    Robots(effect: Deaf, robots: Share(0.3), roles: [\"worker\"], when: At(6.0), lasts: For(1.0)),
    Partition(line: ((0.3, -1.0), (0.2, 1.0)), during: Between(3.0, 8.0)),
    Burst(links: Of([2]), loss: 0.4),
    Burst(links: Pairs([(7, 8)]), loss: 1.0, during: From(5.0)),
]";

#[test]
fn a_run_with_every_kind_of_fault_is_the_same_under_both_drivers() {
    let mut scenario = backbone(15.0, EVERY_KIND);
    let inline = run_with(&scenario, DriverKind::Inline, 0);
    assert_eq!(inline, run_with(&scenario, DriverKind::Actors, 0));
    let kinds: Vec<_> = inline.faults.iter().map(|episode| episode.kind.name()).collect();
    for kind in ["silence", "crash", "mute", "deaf", "partition", "burst"] {
        assert!(kinds.contains(&kind), "no {kind} among {kinds:?}");
    }
    assert!(inline.faults.is_sorted_by_key(|episode| episode.from));
    let total: u64 = inline
        .ledger
        .iter()
        .map(|fates| fates.lost[LossCause::LinkFault as usize])
        .sum();
    assert!(total > 0);

    let woken = "OnReception".to_owned();
    scenario = parse(
        "test.ron",
        &desim::scenario::to_ron(&scenario).replace("wake: ControlStep", &format!("wake: {woken}")),
        &[
            "time_limit=8.0".parse().unwrap(),
            "protocol.completion=Held(1.0)".parse().unwrap(),
        ],
    )
    .unwrap();
    assert_eq!(
        run_with(&scenario, DriverKind::Inline, 0),
        run_with(&scenario, DriverKind::Actors, 0)
    );
}

#[test]
fn a_share_of_nobody_is_the_run_without_faults() {
    let (none, nobody) = (
        run(&backbone(20.0, "[]")),
        run(&backbone(20.0, "[Fallible(share: 0.0, hazard: 0.1)]")),
    );
    assert_eq!(none, nobody);
}

#[test]
fn robots_that_fail_at_a_share_fail_at_the_same_time_at_a_greater_share() {
    let failed = |share: f64| {
        let faults = format!("[Fallible(share: {share:?}, hazard: 0.002, roles: [\"robot\"])]");
        let record = run(&heartbeats(30, &faults));
        let robots = record.faults.iter().map(|episode| (episode.kind.robot(), episode.from));
        robots.collect::<Vec<_>>()
    };
    let (few, many) = (failed(0.2), failed(0.5));
    assert!(!few.is_empty() && few.len() < many.len());
    assert!(few.iter().all(|failure| many.contains(failure)));
}

#[test]
fn a_deaf_robot_loses_what_arrives_while_it_cannot_hear_and_a_mute_one_sends_nothing() {
    let record = run(&heartbeats(
        2,
        "[Deaf(robots: [1], at: 10.0, lasts: For(10.0)), Mute(robots: [1], at: 30.0, lasts: For(10.0))]",
    ));
    // Statuses at 0, 0.1, … 60 s. Deaf: those that arrive from 10.02 to 19.92 s. Mute: those of 30 to 39.9 s.
    assert_eq!((sent(&record, 0), sent(&record, 1)), (601, 501));
    assert_eq!(lost(&record, 1, LossCause::ReceiverDown), 100);
    assert_eq!(lost(&record, 0, LossCause::ReceiverDown), 0);
    let fates = &record.ledger[0];
    assert_eq!((fates.offered, fates.in_flight), (1102, 2));
    let [deaf, mute] = &record.faults[..] else {
        panic!("two failures: {:?}", record.faults)
    };
    assert_eq!(
        (deaf.from, deaf.until),
        (SimTime::from_secs(10.0), Some(SimTime::from_secs(20.0)))
    );
    assert_eq!((deaf.kind.name(), mute.kind.name()), ("deaf", "mute"));
}

#[test]
fn a_frame_that_arrived_before_its_receiver_went_deaf_is_read_and_one_at_that_instant_is_not() {
    // Arrivals 0.02 s after each control step: the robot goes deaf between two steps, with one frame unread.
    for (at, lost_frames) in [("0.22", 2), ("0.2201", 1), ("0.2199", 2)] {
        let faults = format!("[Deaf(robots: [1], at: {at}, lasts: For(0.15))]");
        let record = run(&heartbeats(2, &faults));
        assert_eq!(lost(&record, 1, LossCause::ReceiverDown), lost_frames, "deaf at {at} s");
    }
}

#[test]
fn a_crashed_robot_misses_its_control_steps_and_keeps_its_rhythm_afterwards() {
    let record = run(&heartbeats(2, "[Crash(robots: [1], at: 10.0, lasts: For(10.05))]"));
    // It misses the steps from 10.0 to 20.0 s, 101 of them, and wakes again at 20.1 s.
    assert_eq!((sent(&record, 0), sent(&record, 1)), (601, 500));
    // What reached it from 10.02 to 20.02 s is lost.
    assert_eq!(lost(&record, 1, LossCause::ReceiverDown), 101);
}

#[test]
fn crashed_robots_stand_where_they_stopped() {
    let all: Vec<u32> = (0..20).collect();
    let record = run(&backbone(30.0, &format!("[Crash(robots: {all:?}, at: 15.0)]")));
    let at = |second: usize| record.trajectories.get(second).unwrap().1;
    assert_ne!(at(14), at(15), "they moved before");
    assert_eq!(at(18), at(30), "and have stopped within three seconds");
}

#[test]
fn nothing_crosses_a_partition_and_all_else_arrives() {
    // Two robots on each side of the y axis, all in range of each other.
    let text = "Scenario(name: \"wall\", time_limit: 10.0, protocol: Heartbeat, \
        swarm: (robots: 4, deploy: At([(-0.5, 0.0), (-0.2, 0.3), (0.5, 0.0), (0.2, -0.3)])), \
        radio: (latency: Constant(0.02)), \
        faults: [Partition(line: ((0.0, 1.0), (0.0, -1.0)), during: Between(5.0, 7.0))])";
    let record = run(&scenario(text));
    // 20 statuses of 4 robots in two seconds, each stopped on its way to two others.
    let fates = &record.ledger[0];
    assert_eq!(fates.lost[LossCause::LinkFault as usize], 20 * 4 * 2);
    assert_eq!(fates.delivered + fates.in_flight, fates.offered - 160);
    assert_eq!(record.faults[0].kind, FaultKind::Partition);
}

#[test]
fn a_burst_takes_its_share_of_what_its_links_carry_and_leaves_the_channel_as_it_was() {
    let lossy = |faults: &str| {
        let mut scenario = heartbeats(2, faults);
        let mut radio = scenario.radio.disk().into_owned();
        radio.loss = desim::radio::LossConfig::Bernoulli(desim::quantity::Probability::new(0.2));
        scenario.radio = radio.into();
        run(&scenario)
    };
    let record = lossy("[Burst(loss: 0.3)]");
    // 1202 copies: four deviations of a binomial at 0.3 are 64.
    let stopped = record.ledger[0].lost[LossCause::LinkFault as usize];
    assert!(stopped.abs_diff(361) < 64, "{stopped}");
    // What the channel loses of the others it also loses without the burst.
    let channel = |record: &TrialRecord| record.ledger[0].lost[LossCause::Channel as usize];
    assert!(channel(&record) < channel(&lossy("[]")));
}

/// A fault at random among robots 0 to 5.
fn any_fault() -> impl Strategy<Value = String> {
    let effect = prop::sample::select(vec!["Silence", "Crash", "Mute", "Deaf"]);
    let planned = (effect, 0..6_u32, 0.0..3.0_f64, 0.01..2.0_f64).prop_map(|(effect, robot, at, lasts)| {
        format!("{effect}(robots: [{robot}], at: {at:?}, lasts: For({lasts:?}))")
    });
    let hazard = (0.0..1.0_f64, 0.0..0.1_f64, 0.05..1.0_f64).prop_map(|(share, hazard, lasts)| {
        format!(
            "Robots(effect: Crash, robots: Share({share:?}), when: Hazard(per_step: {hazard:?}), lasts: For({lasts:?}))"
        )
    });
    let burst = (0.0..1.0_f64, 0.0..2.0_f64, 0.1..2.0_f64).prop_map(|(loss, from, length)| {
        format!(
            "Burst(links: Of([0, 2]), loss: {loss:?}, during: Between({from:?}, {:?}))",
            from + length
        )
    });
    let partition =
        (-0.5..0.5_f64).prop_map(|x| format!("Partition(line: (({x:?}, 0.0), (0.1, 1.0)), during: From(1.0))"));
    prop_oneof![3 => planned, 1 => hazard, 1 => burst, 1 => partition]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn every_copy_has_one_fate_and_both_drivers_agree_whatever_fails(
        faults in prop::collection::vec(any_fault(), 0..8),
        random_latency in any::<bool>(),
        wake in prop::sample::select(vec!["ControlStep", "OnReception"]),
    ) {
        let latency = if random_latency { "Uniform(min: 0.0, max: 0.5)" } else { "Constant(0.1)" };
        let text = format!(
            "Scenario(name: \"any\", time_limit: 4.0, swarm: (robots: 6, deploy: Cluster(radius: 0.9)), \
             protocol: Heartbeat, control: (phase: Random, wake: {wake}), detector: Timeout(0.35), \
             radio: (loss: Bernoulli(0.1), latency: {latency}), faults: [{}])",
            faults.join(", ")
        );
        // The recorder itself asserts, at the end of every run, that no copy is lost from the books.
        let record = run(&scenario(&text));
        let fates = &record.ledger[0];
        prop_assert!(fates.is_balanced() && fates.offered > 0);
        prop_assert_eq!(run_with(&scenario(&text), DriverKind::Actors, 0), record);
    }
}

#[test]
fn the_shipped_examples_of_faults_run_and_something_fails() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/faults");
    let examples = shipped::files().into_iter().filter(|file| file.starts_with(&folder));
    let mut seen = 0;
    for file in examples {
        let mut scenario = load(&file, &[]).unwrap_or_else(|report| panic!("{report}"));
        scenario.time_limit = Positive::new(390.0);
        let completion = CompletionConfig::Held(NonNegative::new(385.0));
        if let Some(longer) = scenario.protocol.completed_by(completion) {
            scenario.protocol = longer.into();
        }
        // Radiation spares a trial once in a while, and three in a row once in a hundred times.
        let something_fails = |trial| !run_with(&scenario, DriverKind::Inline, trial).faults.is_empty();
        assert!((0..3).any(something_fails), "nothing failed in {}", file.display());
        seen += 1;
    }
    assert_eq!(seen, 5);
}
