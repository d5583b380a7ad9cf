use super::*;
use crate::faults::{Effect, Health};
use crate::geometry::Pose;
use crate::metrics::figures::Registry;
use crate::metrics::traffic::HeaderBytes;
use crate::metrics::volume::TopicFates;
use crate::metrics::{Mission, Ties};
use crate::protocol::{CompletionConfig, Role};
use crate::spool::Scratch;

const RANGE: f64 = 2.0;

fn recorder(mission: Option<Mission>) -> Recorder {
    let layout = Layout {
        robots: 3,
        topics: 2,
        roles: 2,
        headers: HeaderBytes { frame: 2, message: 3 },
        reach: Reach::Disk(RANGE),
        control_period: Span::from_secs(0.1),
        mission,
        rumors: 0,
        completion: CompletionConfig::default(),
        status_memory: Span::from_secs(8.0),
        patience: Span::from_secs(4.0),
        status: None,
        scratch: Scratch::default(),
    };
    Recorder::new(layout, &MetricsConfig::default())
}

fn end() -> RunEnd {
    RunEnd {
        trial: 4,
        seed: 9,
        steps: 100,
        simulated: SimTime::from_secs(10.0),
        events: 1000,
        digest: 7,
        robot_steps: vec![100; 3],
        poses: vec![Pose::default(); 3],
    }
}

fn line(spacing: f64) -> Vec<Vec2> {
    (0..3).map(|i| Vec2::new(spacing * f64::from(i), 0.0)).collect()
}

#[test]
fn a_transmission_with_every_fate_balances_and_is_recorded_at_its_receivers() {
    let mut recorder = recorder(None);
    recorder.transmitted(ActorId(0), Topic(1), MessageSize::alone(4));
    recorder.offered(Topic(1), 3);
    recorder.delivered(ActorId(1), Topic(1), MessageSize::alone(4), Span::from_secs(0.02));
    recorder.lost(ActorId(2), Topic(1), LossCause::Channel, MessageSize::alone(4));
    recorder.in_flight(Topic(1), Some(Span::from_secs(30.0)));
    let record = recorder.finish(end());
    let mut expected = TopicFates {
        offered: 3,
        delivered: 1,
        in_flight: 1,
        ..TopicFates::default()
    };
    expected.lost[LossCause::Channel as usize] = 1;
    assert_eq!(record.ledger, [TopicFates::default(), expected]);
    assert_eq!(
        record.traffic.iter().map(|row| row.robot.0).collect::<Vec<_>>(),
        [0, 1, 2]
    );
    assert_eq!(
        (record.latency.count(), record.latency.max()),
        (2, Some(Span::from_secs(30.0))),
        "what is under way counts too"
    );
    assert_eq!(record.outcome, Outcome::NoMission);
    assert_eq!((record.trial, record.seed, record.steps, record.digest), (4, 9, 100, 7));
}

#[test]
#[should_panic(
    expected = "frames were not conserved on topic 0: offered 10, delivered 2, lost 1 (channel 1, link_fault 0, receiver_down 0, below_sensitivity 0, collision 0, half_duplex 0, access_failure 0, queue_full 0, duty_cycle 0, too_long 0, occlusion 0, sender_down 0), in flight 1"
)]
fn a_broken_ledger_ends_the_run_with_every_number() {
    let mut recorder = recorder(None);
    recorder.offered(Topic(0), 10);
    for _ in 0..2 {
        recorder.delivered(ActorId(1), Topic(0), MessageSize::alone(4), Span::ZERO);
    }
    recorder.lost(ActorId(2), Topic(0), LossCause::Channel, MessageSize::alone(4));
    recorder.in_flight(Topic(0), Some(Span::ZERO));
    let _ = recorder.finish(end());
}

#[test]
fn samples_follow_the_graph_the_roles_and_the_paths() {
    let mut recorder = recorder(None);
    recorder.sample(SimTime::ZERO, &line(1.5));
    recorder.note(ActorId(1), &Note::Role(Role(1)));
    recorder.sample(SimTime::from_secs(1.0), &line(0.5));
    recorder.sample(SimTime::from_secs(2.0), &line(2.5));
    let record = recorder.finish(end());
    let samples: Vec<_> = record.connectivity.iter().collect();
    let [path, complete, apart] = &samples[..] else {
        panic!("three samples")
    };
    assert!(
        (path.lambda2 - 1.0).abs() < 1e-9 && path.components == 1,
        "a path of three"
    );
    assert!((complete.lambda2 - 3.0).abs() < 1e-9, "a triangle");
    assert_eq!((apart.lambda2, apart.components), (0.0, 3));
    assert_eq!((&path.roles[..], &complete.roles[..]), (&[3, 0][..], &[2, 1][..]));
    assert_eq!(
        record.trajectories.get(1).unwrap().1[2].map(f32::to_bits),
        [1.0_f32, 0.0].map(f32::to_bits)
    );
    assert_eq!(record.robots[1].role, 1);
}

fn fails(recorder: &mut Recorder, seconds: f64, robot: u32, positions: &[Vec2]) {
    let subject = Subject::Robot {
        robot: ActorId(robot),
        effect: Effect::Crash,
        health: Health {
            sends: false,
            hears: false,
            acts: false,
        },
    };
    let change = Change {
        fault: 0,
        begins: true,
        subject,
    };
    recorder.fault(SimTime::from_secs(seconds), &change, positions);
}

#[test]
fn the_graph_is_that_of_live_robots_and_of_nobody_nothing_is_said() {
    let mut recorder = recorder(None);
    let row = line(1.5);
    recorder.sample(SimTime::ZERO, &row);
    fails(&mut recorder, 0.5, 1, &row);
    recorder.sample(SimTime::from_secs(1.0), &row);
    fails(&mut recorder, 1.5, 2, &row);
    recorder.sample(SimTime::from_secs(2.0), &row);
    fails(&mut recorder, 2.5, 0, &row);
    recorder.sample(SimTime::from_secs(3.0), &row);
    let record = recorder.finish(end());
    let components: Vec<u32> = record.connectivity.iter().map(|sample| sample.components).collect();
    assert_eq!(components, [1, 2, 1, 0], "a path, its ends, one of them, nobody");
    let neighbours: Vec<f64> = record.connectivity.iter().map(|sample| sample.neighbours).collect();
    assert_eq!(
        neighbours,
        [4.0 / 3.0, 0.0, 0.0, 0.0],
        "of the path's robots one has two and two have one"
    );
    let registry = Registry::of(&["a", "b"]);
    let seen = registry.figures().zip(registry.read(&record));
    let mut seen = seen.filter(|(figure, _)| figure.key == "neighbours");
    let value = seen.next().and_then(|(_, sample)| sample.value());
    assert_eq!(value, Some(4.0 / 9.0), "nobody is no sample");
    // Whose least λ₂ is that of the two ends, who are in two pieces; one robot has none.
    assert_eq!(record.lambda2_min(), Some(0.0));
    assert_eq!(record.connected_share(), Some(2.0 / 3.0), "nobody is not in one piece");

    let mut whole = self::recorder(None);
    whole.sample(SimTime::ZERO, &line(0.5));
    fails(&mut whole, 0.5, 1, &row);
    whole.sample(SimTime::from_secs(1.0), &line(0.5));
    fails(&mut whole, 1.5, 2, &row);
    whole.sample(SimTime::from_secs(2.0), &line(0.5));
    let least = whole.finish(end()).lambda2_min().unwrap();
    assert!((least - 2.0).abs() < 1e-9, "two robots that hear each other: {least}");
}

#[test]
fn a_robot_that_has_failed_is_no_part_of_the_graph() {
    // A path of three whose middle fails leaves two that are out of each other's range; whose end fails, a pair: λ₂ = 2.
    for (failed, lambda2, components) in [(1, 0.0, 2), (2, 2.0, 1)] {
        let mut recorder = recorder(None);
        let health = Health {
            sends: false,
            ..Health::WELL
        };
        let change = Change {
            fault: 0,
            begins: true,
            subject: Subject::Robot {
                robot: ActorId(failed),
                effect: Effect::Mute,
                health,
            },
        };
        recorder.fault(SimTime::from_secs(1.0), &change, &line(1.5));
        recorder.sample(SimTime::from_secs(2.0), &line(1.5));
        let record = recorder.finish(end());
        let sample = &record.connectivity.get(0).unwrap();
        assert_eq!((sample.components, failed), (components, failed));
        assert!((sample.lambda2 - lambda2).abs() < 1e-9, "{}", sample.lambda2);
    }
}

#[test]
fn a_record_from_the_far_side_of_the_universe_is_read_back_as_it_was() {
    let mut recorder = recorder(None);
    recorder.sample(SimTime::ZERO, &line(1e39));
    let record = recorder.finish(end());
    assert!(
        record
            .trajectories
            .get(0)
            .unwrap()
            .1
            .iter()
            .flatten()
            .all(|coordinate| coordinate.is_finite())
    );
    let read: TrialRecord = serde_json::from_str(&serde_json::to_string(&record).unwrap()).unwrap();
    assert_eq!(read, record);
}

#[test]
fn a_mission_never_held_is_censored() {
    let mission = Mission {
        targets: vec![super::super::MissionTarget {
            position: Vec2::zeros(),
            links: 1,
        }],
        reach: 0.3,
        ties: Ties::Parents { within: 1.7 },
        root: ActorId(0),
        root_role: None,
        worker_role: Role(1),
    };
    let mut recorder = recorder(Some(mission));
    assert_eq!(recorder.observe(0, &line(1.0)), Progress::Underway);
    recorder.sample(SimTime::ZERO, &line(1.0));
    let record = recorder.finish(end());
    assert_eq!(
        (record.outcome, &record.connectivity.get(0).unwrap().links[..]),
        (Outcome::Censored, &[0][..])
    );
}
