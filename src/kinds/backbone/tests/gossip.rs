//! What gossip settings do to one robot: sending on change, strands that are old or have come too far, orders passed on.

use super::*;
use crate::protocol::MessageSize;

fn gossip(text: &str) -> GossipConfig {
    ron::from_str(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// The root and the worker, as a robot between them hears them.
fn company() -> [(u32, f64, Message); 2] {
    [
        (ROOT, 0.0, status(Role::Root, false, 0)),
        (WORKER, 1.2, status(Role::Worker, true, 1)),
    ]
}

/// A robot that accepted to join and heard `childs` strand.
fn joined(gossip: &GossipConfig, childs: Strand) -> Bench {
    let mut bench = Bench::with(gossip, FREE, 0.7);
    let [root, worker] = company();
    bench.step(&[root.clone(), worker.clone(), (WORKER, 1.2, join(FREE, 1))]);
    bench.step(&[root, worker, (WORKER, 1.2, Message::ChildStrand(childs))]);
    bench
}

fn is_settled(bench: &Bench) -> bool {
    matches!(&bench.robot.duty, Duty::Networker(networker) if networker.is_settled())
}

#[test]
fn a_relay_goes_free_when_its_childs_strand_outlives_its_time() {
    for (settings, role) in [
        ("()", Role::Networker),
        ("(strand: (time_to_live: Seconds(3.0)))", Role::Networker),
        ("(strand: (time_to_live: Seconds(1.0)))", Role::Free),
    ] {
        let mut bench = joined(&gossip(settings), strand(FREE, &[WORKER]));
        assert!(is_settled(&bench), "{settings}");
        bench.run(2.0, &company());
        assert_eq!(bench.role(), role, "{settings}");
    }
}

#[test]
fn a_parent_of_whom_only_statuses_are_heard_is_given_up_when_its_strand_outlives_its_time() {
    for (settings, parent) in [("()", FREE), ("(strand: (time_to_live: Seconds(1.0)))", ROOT)] {
        let mut worker = Bench::with(&gossip(settings), WORKER, 1.2);
        let root = (ROOT, 0.0, status(Role::Root, false, 0));
        let asked = worker.step(&[root.clone(), (FREE, 0.7, status(Role::Free, false, 0))]);
        let asked = requests(&asked).into_iter().find_map(|request| match request {
            Request::Join { sequence, .. } => Some(sequence),
            _ => None,
        });
        let yes = Message::Request(accept(WORKER, asked.expect("a free robot is asked")));
        let relay = (FREE, 0.7, status(Role::Networker, true, 1));
        worker.step(&[root.clone(), relay.clone(), (FREE, 0.7, yes)]);
        worker.step(&[root.clone(), relay.clone()]);
        assert_eq!(worker.robot.duty.slots()[0].parent, ActorId(FREE), "{settings}");
        worker.run(2.0, &[root, relay]);
        assert_eq!(worker.robot.duty.slots()[0].parent, ActorId(parent), "{settings}");
    }
}

#[test]
fn a_strand_that_names_more_robots_than_it_may_links_nobody() {
    for (settings, settled) in [("(strand: (hop_limit: 3))", true), ("(strand: (hop_limit: 2))", false)] {
        let bench = joined(&gossip(settings), strand(FREE, &[8, 9, WORKER]));
        assert_eq!(is_settled(&bench), settled, "{settings}");
    }
}

#[test]
fn a_status_that_does_not_change_is_said_again_only_after_the_longest_pause() {
    let mut bench = Bench::with(&gossip("(status: (send: OnChange(max_interval: 0.4)))"), FREE, 0.7);
    let said = |output: &Output<Message>| {
        output
            .broadcasts
            .iter()
            .any(|message| matches!(message, Message::Status(_)))
    };
    let quiet: Vec<bool> = (0..8).map(|_| said(&bench.step(&company()))).collect();
    assert_eq!(quiet, [true, false, false, false, true, false, false, false]);
    let [root, worker] = company();
    let joined = bench.step(&[root, worker, (WORKER, 1.2, join(FREE, 1))]);
    assert!(said(&joined) && !said(&bench.step(&company())), "its new role is news");
}

#[test]
fn an_order_is_passed_on_as_often_as_asked_and_a_newer_one_begins_anew() {
    // Five robots or fewer: a multiplier of 3 makes 3 messages.
    let settings = gossip("(relay: (interval: 0.1, retransmit: Multiplier(3)))");
    let order = |epoch| Order {
        epoch,
        dismantled: TargetSet::default(),
        reserve: 0,
    };
    let mut bench = Bench::with(&settings, WORKER, 1.2);
    let passed_on = |bench: &mut Bench, epoch| {
        let heard = (ROOT, 0.0, Message::Request(Request::Order(order(epoch))));
        let step = |_| requests(&bench.step(std::slice::from_ref(&heard)));
        let sent = (0..6)
            .map(step)
            .map(|requests| requests.contains(&Request::Order(order(epoch))));
        sent.filter(|sent| *sent).count()
    };
    assert_eq!([passed_on(&mut bench, 1), passed_on(&mut bench, 2)], [3, 3]);
    let old = bench.step(&[(ROOT, 0.0, Message::Request(Request::Order(order(1))))]);
    let duplicate = Note::Duplicate {
        topic: Topic(1),
        size: MessageSize::alone(4),
    };
    assert!(old.notes.contains(&duplicate), "an order that was had is heard in vain");
}

/// Refreshed every 8 turns: of 40 robots at random phases 5 begin with each number of turns on average; that all began with the
/// same, or that half of the numbers were missing, has a probability below 1e-9.
#[test]
fn robots_that_say_the_same_refresh_it_at_different_times_and_together_only_where_asked() {
    let settings = gossip("(status: (send: OnChange(max_interval: 0.8)))");
    let first_silences = |phase| {
        let control = ControlConfig {
            phase,
            ..ControlConfig::default()
        };
        let config = ron::from_str("(targets: Ring(count: 1, radius: 4.5))").unwrap();
        let poses = vec![Pose::default(); 40];
        let detector = DetectorConfig::default();
        let swarm = swarm(&config, &settings, &detector, &control, &poses, Streams::new(3, 0));
        let silences = swarm.into_iter().skip(2).map(|robot| {
            let mut bench = Bench::of(robot, 0.7);
            let said: Vec<bool> = (0..9).map(|_| !bench.step(&company()).broadcasts.is_empty()).collect();
            said[1..].iter().take_while(|said| !**said).count()
        });
        silences.collect::<std::collections::BTreeSet<usize>>()
    };
    assert_eq!(
        first_silences(PhaseConfig::Together).into_iter().collect::<Vec<_>>(),
        [7]
    );
    assert!(first_silences(PhaseConfig::Random).len() > 4);
}

/// A mission all of whose topics have a turn every 0.8 s, 8 steps, and are refreshed every 6.4 s, 8 turns.
fn mission_in_eighths(phase: PhaseConfig) -> Rc<Mission> {
    let topic = "interval: 0.8, send: OnChange(max_interval: 6.4)";
    let settings = format!("(status: ({topic}), strand: ({topic}), request: (interval: 0.8), relay: (interval: 0.8))");
    let control = ControlConfig {
        phase,
        ..ControlConfig::default()
    };
    let config = ron::from_str("(targets: Ring(count: 1, radius: 4.5))").unwrap();
    let poses = vec![Pose::default(); 40];
    let (detector, streams) = (DetectorConfig::default(), Streams::new(3, 0));
    let robots = swarm(&config, &gossip(&settings), &detector, &control, &poses, streams);
    Rc::clone(&robots[0].known.mission)
}

/// That some two of 40 robots begin at none of 8 steps, or that two topics begin together in all of them, is as good as impossible:
/// a step is left out by all with probability (7/8)^40 = 0.005, four of them by less than 1e-7.
fn assert_spread(begin: impl Fn(u32) -> [u64; 4], topics: usize) {
    let by_robot: Vec<[u64; 4]> = (0..40).map(begin).collect();
    for topic in 0..topics {
        let steps: std::collections::BTreeSet<u64> = by_robot.iter().map(|steps| steps[topic]).collect();
        assert!(steps.len() > 4, "topic {topic}: {by_robot:?}");
        for other in 0..topic {
            assert!(
                by_robot.iter().any(|steps| steps[topic] != steps[other]),
                "{topic} goes with {other}"
            );
        }
    }
}

#[test]
fn every_topic_of_a_robot_begins_at_a_step_of_its_own_and_together_only_where_asked() {
    let begin = |mission: &Mission, robot: u32| {
        let parameters = &mission.parameters;
        let topics = [
            parameters.status_turns,
            parameters.strand_turns,
            parameters.request_turns,
            parameters.relay_turns,
        ];
        topics.map(|turns| (0..8).find(|&step| turns.is_due(ActorId(robot), step)).unwrap())
    };
    let random = mission_in_eighths(PhaseConfig::Random);
    assert_spread(|robot| begin(&random, robot), 4);
    let together = mission_in_eighths(PhaseConfig::Together);
    assert!((0..40).all(|robot| begin(&together, robot) == [0; 4]));
}

#[test]
fn what_a_robot_says_of_its_strands_is_refreshed_at_a_turn_of_its_own_and_apart_from_its_status() {
    let begin = |mission: &Mission, robot: u32| {
        let parameters = &mission.parameters;
        let mut said = Said::nothing(ActorId(robot), parameters);
        let Message::Status(word) = status(Role::Free, false, 0) else {
            panic!("a status")
        };
        // Said at the first turn, and then refreshed.
        let first = |due: &mut dyn FnMut() -> bool| {
            assert!(due());
            (1..=8).find(|_| due()).unwrap()
        };
        [
            first(&mut || said.status.is_due(parameters.status_repetition, &word)),
            first(&mut || said.strands.is_due(parameters.strand_repetition, &Vec::new())),
            0,
            0,
        ]
    };
    let random = mission_in_eighths(PhaseConfig::Random);
    assert_spread(|robot| begin(&random, robot), 2);
    let together = mission_in_eighths(PhaseConfig::Together);
    assert!((0..40).all(|robot| begin(&together, robot) == [8, 8, 0, 0]));
}
