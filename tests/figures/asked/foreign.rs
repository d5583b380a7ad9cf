//! Tables of a protocol from outside, whose robots move, say things to all and to one, and note what they know and what they are.

use std::collections::BTreeSet;

use desim::engine::{ActorId, SimTime, Span};
use desim::geometry::{Pose, Vec2};
use desim::metrics::{AskedTable, Hop, TrialRecord};
use desim::motion::World;
use desim::protocol::{Input, Note, Output, Protocol, Role, Serialised, Topic};
use desim::quantity::{NonNegative, Positive};
use desim::radio::{LatencyConfig, LossCause};
use desim::simulation::{Copy, DriverKind, Observer, Setup};
use tokio_util::sync::CancellationToken;

use super::{assert_degree, assert_delays, assert_delivery, assert_hops, assert_roles, assert_traffic};

/// Robot 0 begins a rumour, and whoever hears it says it once and is a teller from then on; all go east, the farther the faster. Each says hello to the next one.
#[derive(Default)]
struct Teller {
    knows: bool,
}

impl Protocol for Teller {
    type Message = u8;
    type Heard = u8;
    type Codec = Serialised<u8>;
    const TOPICS: &'static [&'static str] = &["rumour", "hello"];
    const ROLES: &'static [&'static str] = &["listener", "teller"];

    fn topic(message: &u8) -> Topic {
        Topic(*message)
    }

    fn step(&mut self, now: SimTime, input: &mut Input<u8>, output: &mut Output<u8>) {
        let heard = input.inbox.iter().find(|reception| reception.frame.message == 0);
        let learnt = match heard {
            Some(reception) if !self.knows => Some((reception.at, Some(reception.frame.sender))),
            None if !self.knows && input.me.0 == 0 => Some((now, None)),
            _ => None,
        };
        if let Some((at, from)) = learnt {
            self.knows = true;
            output.notes.push(Note::Informed { rumor: 0, at, from });
            output.enter(Role(1));
            output.broadcast(0);
        }
        output.send(ActorId((input.me.0 + 1) % ROBOTS), 1);
        output.velocity = Some(Vec2::new(0.02 * f64::from(input.me.0), 0.0));
    }
}

const ROBOTS: u32 = 5;
const STEP: f64 = 0.1;
const LATENCY: f64 = 0.03;

/// Five robots in a row, 1 m apart, that hear their neighbours alone at first.
fn setup(tables: &[AskedTable], piggyback: bool) -> Setup {
    let mut setup = Setup::lasting(Span::from_secs(4.0));
    setup.metrics.record = tables.iter().copied().collect();
    setup.metrics.sample_interval = NonNegative::new(0.5);
    setup.radio.range = Positive::new(1.1);
    setup.radio.latency = LatencyConfig::Constant(NonNegative::new(LATENCY));
    setup.control.period = Positive::new(STEP);
    setup.motion.max_speed = Positive::new(1.0);
    setup.piggyback = piggyback;
    setup.rumors = 1;
    setup
}

const ALL: [AskedTable; 6] = [
    AskedTable::Delivery,
    AskedTable::Delays,
    AskedTable::Degree,
    AskedTable::Hops,
    AskedTable::Traffic,
    AskedTable::Roles,
];

fn run<O: Observer>(setup: &Setup, observer: O) -> (TrialRecord, O) {
    let place = |robot: u32| Pose {
        position: Vec2::new(f64::from(robot) - 2.0, 0.0),
        heading: 0.0,
    };
    let poses = (0..ROBOTS).map(place).collect();
    let robots = std::iter::repeat_with(Teller::default).take(ROBOTS as usize).collect();
    let finished = setup.observe(poses, robots, DriverKind::Inline, &CancellationToken::new(), observer);
    let finished = finished.expect("the run reaches its end");
    (finished.record, finished.observer)
}

/// Step by step along the row: a hop is over one robot, and takes a step.
#[test]
fn a_rumour_goes_down_a_row_hop_by_hop_and_each_robot_has_it_from_the_one_before() {
    let (record, ()) = run(&setup(&ALL, false), ());
    let hops: Vec<Hop> = record.asked.hops.iter().collect();
    assert_eq!(hops.len(), ROBOTS as usize);
    for (number, hop) in (0..).zip(&hops) {
        assert_eq!((hop.rumor, hop.robot.0, hop.hops), (0, number, number));
        assert_eq!(hop.parent, number.checked_sub(1).map(ActorId));
        let roles = record.asked.roles.iter().filter(|change| change.robot == hop.robot);
        let [start, teller] = roles.collect::<Vec<_>>().try_into().expect("one change");
        assert_eq!((start.at, start.before, start.role), (SimTime::ZERO, None, 0));
        assert_eq!((teller.before, teller.role), (Some(0), 1));
        assert!(
            teller.at >= hop.at && teller.at.since(hop.at).as_secs() < STEP,
            "it noted both at once"
        );
    }
    for pair in hops.windows(2) {
        let step = pair[1].at.since(pair[0].at).as_secs();
        assert!((LATENCY..=STEP + LATENCY + 1e-9).contains(&step), "{step} s");
    }
}

/// Holds the distance of every copy against where robots are as it is on air.
#[derive(Default)]
struct Tape {
    offered: Vec<(ActorId, f64)>,
    known: BTreeSet<(ActorId, ActorId, u32)>,
    far: u32,
    settled: u32,
}

impl Observer for Tape {
    fn offered(&mut self, copy: &Copy, distance: f64) {
        self.offered.push((copy.receiver, distance));
        assert!(
            self.known.insert((copy.sender, copy.receiver, copy.sequence)),
            "offered once"
        );
    }

    fn lost(&mut self, copy: &Copy, cause: LossCause, _: SimTime) {
        assert!(
            self.known.remove(&(copy.sender, copy.receiver, copy.sequence)),
            "offered before"
        );
        self.far += u32::from(cause == LossCause::BelowSensitivity);
    }

    fn delivered(&mut self, copy: &Copy, _: SimTime, _: Option<SimTime>) {
        assert!(
            self.known.remove(&(copy.sender, copy.receiver, copy.sequence)),
            "offered before"
        );
        self.settled += 1;
    }

    fn spoke(&mut self, now: SimTime, robot: ActorId, world: &World) {
        for (receiver, distance) in self.offered.drain(..) {
            let true_distance = (world.position(receiver, now) - world.position(robot, now)).norm();
            assert!(
                (distance - true_distance).abs() < 1e-9,
                "{distance} m and {true_distance} m"
            );
        }
    }
}

#[test]
fn distances_are_those_at_which_copies_are_sent_however_robots_move_and_far_ones_too() {
    for piggyback in [false, true] {
        let (record, tape) = run(&setup(&ALL, piggyback), Tape::default());
        assert!(tape.far > 30 && tape.settled > 60, "{} and {}", tape.far, tape.settled);
        for assert in [
            assert_delivery,
            assert_delays,
            assert_degree,
            assert_hops,
            assert_roles,
            assert_traffic,
        ] {
            assert(&record);
        }
        // The last robot says hello to the first one, 4 m away and more, as they part; the others to the next, which part too.
        let hello: Vec<_> = record.asked.delivery.iter().filter(|band| band.topic == 1).collect();
        let far = |from: f64| hello.iter().filter(move |band| band.from_m >= from);
        let lost = |from: f64| {
            far(from)
                .map(|band| band.fates.lost[LossCause::BelowSensitivity as usize])
                .sum::<u64>()
        };
        let steps = record.robots[ROBOTS as usize - 1].steps;
        let offered = far(3.0).map(|band| band.fates.offered).sum::<u64>();
        assert_eq!((lost(3.0), offered), (steps, steps));
        assert_eq!(lost(0.0), u64::from(tape.far));
    }
}

#[test]
fn nobody_is_told_of_offers_if_nobody_heeds_them() {
    let (_, tape) = run(
        &setup(&[AskedTable::Hops, AskedTable::Traffic], false),
        Silent::default(),
    );
    assert_eq!(tape.0, 0);
}

#[derive(Default)]
struct Silent(u32);

impl Observer for Silent {
    fn offered(&mut self, _: &Copy, _: f64) {
        self.0 += 1;
    }
}
