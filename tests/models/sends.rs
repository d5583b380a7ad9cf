//! Messages to one robot: who hears them, in what order, what they cost, and what is counted when nobody can.

use std::cell::RefCell;
use std::rc::Rc;

use desim::engine::{ActorId, SimTime, Span};
use desim::geometry::{Pose, Vec2};
use desim::metrics::{Amount, TopicFates, TrafficRow, TrialRecord};
use desim::protocol::control::{PhaseConfig, WakeConfig};
use desim::protocol::{Address, Input, Output, Protocol, Serialised, Start, TimerId, Topic, Wake};
use desim::quantity::{NonNegative, Positive, Probability};
use desim::radio::{LatencyConfig, LossCause, LossConfig};
use desim::simulation::{DriverKind, RunError, Setup};
use serde::{Deserialize, Serialize};
use tokio_util::sync::CancellationToken;

/// The headers of a radio by default, bytes.
const FRAME_HEADER: u64 = 2;
const MESSAGE_HEADER: u64 = 3;

/// A message on the topic of its own number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Word {
    topic: u8,
    number: u8,
}

/// What one robot heard: when, from whom, for whom, and the number in it.
type Heard = (SimTime, u32, Address, u8);

/// What all robots heard, in the order in which they read it; and what they were told before the run.
#[derive(Clone, Debug, Default)]
struct Ears(Rc<RefCell<Vec<(u32, Heard)>>>, Rc<RefCell<Vec<Start>>>);

/// Says what `script` has it say at its first control step, and writes down what it hears. `OVERHEARS`: also what is for others.
struct Speaker<const OVERHEARS: bool> {
    script: fn(ActorId, &mut Output<Word>),
    ears: Ears,
}

impl<const OVERHEARS: bool> Protocol for Speaker<OVERHEARS> {
    type Message = Word;
    type Heard = Word;
    type Codec = Serialised<Word>;
    const TOPICS: &'static [&'static str] = &["call", "answer"];
    const ROLES: &'static [&'static str] = &["robot"];
    const OVERHEARS: bool = OVERHEARS;

    fn topic(word: &Word) -> Topic {
        Topic(word.topic)
    }

    fn start(&mut self, start: Start) {
        self.ears.1.borrow_mut().push(start);
    }

    fn step(&mut self, now: SimTime, input: &mut Input<Word>, output: &mut Output<Word>) {
        for reception in &input.inbox {
            let frame = &reception.frame;
            let heard = (reception.at, frame.sender.0, frame.address, frame.message.number);
            self.ears.0.borrow_mut().push((input.me.0, heard));
        }
        if now < SimTime::from_secs(0.1) && input.wake == Wake::ControlStep {
            (self.script)(input.me, output);
        }
    }
}

fn word(number: u8) -> Word {
    Word { topic: 0, number }
}

/// Two seconds of robots on a line, a metre apart, with a radio of 1.5 m.
fn setup() -> Setup {
    let mut setup = Setup::lasting(Span::from_secs(2.0));
    setup.control.phase = PhaseConfig::Together;
    setup.radio.range = Positive::new(1.5);
    setup.metrics.sample_interval = NonNegative::new(0.0);
    setup
}

fn line(robots: u32) -> Vec<Pose> {
    let pose = |robot| Pose {
        position: Vec2::new(f64::from(robot), 0.0),
        heading: 0.0,
    };
    (0..robots).map(pose).collect()
}

fn run<const OVERHEARS: bool>(
    setup: &Setup,
    robots: u32,
    driver: DriverKind,
    script: fn(ActorId, &mut Output<Word>),
) -> Result<(TrialRecord, Ears), RunError> {
    let ears = Ears::default();
    let speakers = (0..robots).map(|_| Speaker::<OVERHEARS> {
        script,
        ears: ears.clone(),
    });
    let record = setup.run(line(robots), speakers.collect(), driver, &CancellationToken::new())?;
    Ok((record, ears))
}

fn hear<const OVERHEARS: bool>(
    setup: &Setup,
    robots: u32,
    script: fn(ActorId, &mut Output<Word>),
) -> (TrialRecord, Vec<(u32, Address, u8)>) {
    let (record, ears) = run::<OVERHEARS>(setup, robots, DriverKind::Inline, script).expect("the run reaches its end");
    let heard = ears.0.borrow();
    let heard = heard.iter().map(|(reader, heard)| (*reader, heard.2, heard.3));
    (record, heard.collect())
}

/// Offered, delivered, lost for want of range, of all topics; each topic balances.
fn fates(record: &TrialRecord) -> [u64; 3] {
    assert!(record.ledger.iter().all(TopicFates::is_balanced));
    let below = LossCause::BelowSensitivity as usize;
    let sum = |of: fn(&TopicFates, usize) -> u64| record.ledger.iter().map(|fates| of(fates, below)).sum();
    [
        sum(|fates, _| fates.offered),
        sum(|fates, _| fates.delivered),
        sum(|fates, below| fates.lost[below]),
    ]
}

fn row(record: &TrialRecord, robot: u32, topic: u8) -> &TrafficRow {
    let found = record
        .traffic
        .iter()
        .find(|row| (row.robot.0, row.topic) == (robot, topic));
    found.expect("the robot has traffic on the topic")
}

#[test]
fn robots_know_who_they_are_and_how_many_there_are_before_the_run() {
    let (_, ears) = run::<false>(&setup(), 3, DriverKind::Inline, |_, _| {}).unwrap();
    let expected = [0, 1, 2].map(|me| Start {
        me: ActorId(me),
        robots: 3,
    });
    assert_eq!(*ears.1.borrow(), expected);
}

#[test]
fn a_message_to_one_robot_reaches_it_alone_and_a_broadcast_all_in_range() {
    let (record, heard) = hear::<false>(&setup(), 3, |me, output| {
        if me == ActorId(1) {
            output.send(ActorId(2), word(7));
        }
    });
    assert_eq!(heard, [(2, Address::Me, 7)]);
    assert_eq!(fates(&record), [1, 1, 0]);
    let (record, heard) = hear::<false>(&setup(), 3, |me, output| {
        if me == ActorId(1) {
            output.broadcast(word(7));
        }
    });
    assert_eq!(heard, [(0, Address::Everyone, 7), (2, Address::Everyone, 7)]);
    assert_eq!(fates(&record), [2, 2, 0]);
}

#[test]
fn robots_that_overhear_read_it_too_and_know_that_it_is_for_another() {
    let (record, heard) = hear::<true>(&setup(), 4, |me, output| {
        if me == ActorId(1) {
            output.send(ActorId(2), word(7));
        }
    });
    assert_eq!(heard, [(0, Address::Another, 7), (2, Address::Me, 7)]);
    assert_eq!(fates(&record), [2, 2, 0]);
}

#[test]
fn a_message_to_a_robot_out_of_range_is_lost_for_that_and_seen_to_be() {
    let script = |me, output: &mut Output<Word>| {
        if me == ActorId(0) {
            output.send(ActorId(3), word(7));
        }
    };
    let (record, heard) = hear::<false>(&setup(), 4, script);
    assert_eq!((heard, fates(&record)), (vec![], [1, 0, 1]));
    let lost = &row(&record, 3, 0).lost[LossCause::BelowSensitivity as usize];
    assert_eq!((lost.frames, lost.payload_bytes, lost.header_bytes), (1, 2, 5));
    let (record, heard) = hear::<true>(&setup(), 4, script);
    assert_eq!((heard, fates(&record)), (vec![(1, Address::Another, 7)], [2, 1, 1]));
}

/// Nobody hears either message: the two runs differ in whom it is for, and in nothing else.
#[test]
fn whom_a_message_is_for_is_in_the_digest() {
    let digest = |script| hear::<false>(&setup(), 5, script).0.digest;
    let to_3 = digest(|me, output| {
        if me == ActorId(0) {
            output.send(ActorId(3), word(7));
        }
    });
    let to_4 = digest(|me, output| {
        if me == ActorId(0) {
            output.send(ActorId(4), word(7));
        }
    });
    assert_ne!(to_3, to_4);
}

#[test]
fn a_message_to_oneself_or_to_no_robot_ends_the_run_with_a_word_about_it() {
    let complaint = |script: fn(ActorId, &mut Output<Word>)| {
        let ended = run::<false>(&setup(), 3, DriverKind::Inline, script);
        let error = ended.expect_err("the addressee is refused");
        assert!(matches!(error, RunError::Addressee { .. }));
        error.to_string()
    };
    let to_itself = complaint(|me, output| output.send(me, word(1)));
    for part in ["robot 0 of ", "Speaker", "`call`", "to robot 0", "from 0 to 2"] {
        assert!(to_itself.contains(part), "{to_itself}");
    }
    let to_nobody = complaint(|_, output| output.send(ActorId(3), Word { topic: 1, number: 1 }));
    for part in ["`answer`", "to robot 3"] {
        assert!(to_nobody.contains(part), "{to_nobody}");
    }
}

/// Robot 1 says seven things to all and to its two neighbours in turn.
fn in_turn(me: ActorId, output: &mut Output<Word>) {
    if me == ActorId(1) {
        output.send(ActorId(0), word(0));
        output.broadcast(word(1));
        output.send(ActorId(2), word(2));
        output.send(ActorId(0), word(3));
        output.broadcast(word(4));
        output.broadcast(word(5));
        output.send(ActorId(2), word(6));
    }
}

/// What each neighbour of robot 1 hears of it.
const IN_TURN: [(u32, &[u8]); 2] = [(0, &[0, 1, 3, 4, 5]), (2, &[1, 2, 4, 5, 6])];

#[test]
fn broadcasts_and_messages_to_one_keep_the_order_in_which_they_were_said() {
    for piggyback in [false, true] {
        let mut setup = setup();
        setup.piggyback = piggyback;
        let (record, heard) = hear::<false>(&setup, 3, in_turn);
        for (reader, numbers) in IN_TURN {
            let read: Vec<u8> = heard
                .iter()
                .filter(|heard| heard.0 == reader)
                .map(|heard| heard.2)
                .collect();
            assert_eq!(read, numbers, "{piggyback}");
        }
        assert_eq!(fates(&record), [10, 10, 0]);
    }
}

/// In one frame with others a message to one is offered to that one alone, and at each receiver the first message that is for it
/// answers for the frame's header.
#[test]
fn of_a_shared_frame_each_hears_what_is_for_it_with_one_header() {
    let mut setup = setup();
    setup.piggyback = true;
    let (record, _) = hear::<false>(&setup, 3, in_turn);
    let sent = row(&record, 1, 0).sent;
    assert_eq!((sent.frames, sent.header_bytes), (7, FRAME_HEADER + 7 * MESSAGE_HEADER));
    for (reader, numbers) in IN_TURN {
        let received = row(&record, reader, 0).received;
        let heard = numbers.len() as u64;
        assert_eq!((received.frames, received.payload_bytes), (heard, 2 * heard));
        assert_eq!(
            received.header_bytes,
            FRAME_HEADER + heard * MESSAGE_HEADER,
            "robot {reader}"
        );
    }
    // Nothing in this frame is for everyone: robot 0 hears one message of it, robot 2 the other, robot 5 none.
    let (record, heard) = hear::<false>(&setup, 6, |me, output| {
        if me == ActorId(1) {
            output.send(ActorId(2), word(2));
            output.send(ActorId(0), word(0));
            output.send(ActorId(5), word(5));
        }
    });
    assert_eq!(heard, [(0, Address::Me, 0), (2, Address::Me, 2)]);
    assert_eq!(fates(&record), [3, 2, 1]);
    for reader in [0, 2] {
        assert_eq!(
            row(&record, reader, 0).received.header_bytes,
            FRAME_HEADER + MESSAGE_HEADER
        );
    }
    let lost = row(&record, 5, 0).lost[LossCause::BelowSensitivity as usize];
    assert_eq!(lost.header_bytes, FRAME_HEADER + MESSAGE_HEADER);
}

#[test]
fn of_a_shared_frame_robots_that_overhear_hear_everything() {
    let mut setup = setup();
    setup.piggyback = true;
    let (record, heard) = hear::<true>(&setup, 3, in_turn);
    for reader in [0, 2] {
        let read: Vec<u8> = heard
            .iter()
            .filter(|heard| heard.0 == reader)
            .map(|heard| heard.2)
            .collect();
        assert_eq!(read, [0, 1, 2, 3, 4, 5, 6]);
        let for_it = heard.iter().filter(|heard| heard.0 == reader && heard.1 == Address::Me);
        assert_eq!(for_it.count(), 2);
    }
    assert_eq!(fates(&record), [14, 14, 0]);
}

/// Sends to its left neighbour and broadcasts, at every control step of a minute, over a bad radio.
struct Babbler<const OVERHEARS: bool>;

impl<const OVERHEARS: bool> Protocol for Babbler<OVERHEARS> {
    type Message = Word;
    type Heard = Word;
    type Codec = Serialised<Word>;
    const TOPICS: &'static [&'static str] = &["call", "answer"];
    const ROLES: &'static [&'static str] = &["robot"];
    const OVERHEARS: bool = OVERHEARS;

    fn topic(word: &Word) -> Topic {
        Topic(word.topic)
    }

    fn step(&mut self, _: SimTime, input: &mut Input<Word>, output: &mut Output<Word>) {
        let number = input.inbox.len() as u8;
        for other in [1, 3] {
            output.send(ActorId((input.me.0 + other) % 6), Word { topic: 1, number });
            output.broadcast(word(number));
        }
    }
}

fn babble<const OVERHEARS: bool>(piggyback: bool, driver: DriverKind, faults: &str) -> TrialRecord {
    let mut setup = setup();
    setup.time_limit = Span::from_secs(60.0);
    setup.piggyback = piggyback;
    setup.control.phase = PhaseConfig::Random;
    setup.radio.loss = LossConfig::Bernoulli(Probability::new(0.3));
    setup.radio.latency = LatencyConfig::Exponential {
        mean: Positive::new(0.2),
    };
    setup.faults = ron::from_str(faults).expect("faults");
    let robots = (0..6).map(|_| Babbler::<OVERHEARS>).collect();
    let run = setup.run(line(6), robots, driver, &CancellationToken::new());
    run.expect("the run reaches its end")
}

const TROUBLE: &str = "#![enable(unwrap_variant_newtypes, unwrap_newtypes)] [
    Deaf(robots: [2], at: 10.0, lasts: For(20.0)),
    Mute(robots: [4], at: 30.0),
    Burst(links: All, loss: 0.4, during: Between(5.0, 50.0)),
]";

fn assert_balanced_and_the_same<const OVERHEARS: bool>(piggyback: bool) {
    for faults in ["[]", TROUBLE] {
        let inline = babble::<OVERHEARS>(piggyback, DriverKind::Inline, faults);
        let actors = babble::<OVERHEARS>(piggyback, DriverKind::Actors, faults);
        assert_eq!(inline, actors);
        // The ledger itself is checked when the run ends; here that every fate occurs.
        let [_, delivered, below] = fates(&inline);
        let all = &inline.ledger[1];
        assert!(
            delivered > 0 && below > 0 && all.lost[0] > 0 && all.in_flight > 0,
            "{all}"
        );
        let hindered = [LossCause::LinkFault, LossCause::ReceiverDown].map(|cause| all.lost[cause as usize] > 0);
        assert_eq!(hindered, [faults != "[]"; 2]);
        // The third next is always out of range, and the first is from the last, for whom it is at the other end.
        if !OVERHEARS && faults == "[]" {
            let steps = inline.robots.iter().map(|robot| robot.steps).sum::<u64>();
            let last = inline.robots[5].steps;
            assert_eq!(all.offered, 2 * steps);
            assert_eq!(below, steps + last);
        }
    }
}

#[test]
fn whatever_becomes_of_messages_to_one_is_accounted_for_and_the_same_under_both_drivers() {
    assert_balanced_and_the_same::<false>(false);
    assert_balanced_and_the_same::<false>(true);
    assert_balanced_and_the_same::<true>(false);
    assert_balanced_and_the_same::<true>(true);
}

/// Passes a word on to the next robot, as soon as it has it: robot 0 has it at the start. Each counts what it passes on and measures
/// how long it took to get there.
struct Relay {
    robots: usize,
}

impl Protocol for Relay {
    type Message = Word;
    type Heard = Word;
    type Codec = Serialised<Word>;
    const TOPICS: &'static [&'static str] = &["word"];
    const ROLES: &'static [&'static str] = &["robot"];

    fn start(&mut self, start: Start) {
        self.robots = start.robots;
    }

    fn step(&mut self, now: SimTime, input: &mut Input<Word>, output: &mut Output<Word>) {
        let me = input.me;
        let begins = me == ActorId(0) && input.wake == Wake::Timer(TimerId(1));
        if me == ActorId(0) && now == SimTime::ZERO {
            output.set_timer(TimerId(0), SimTime::from_secs(0.5));
            output.set_timer(TimerId(1), SimTime::from_secs(0.25));
            output.cancel_timer(TimerId(0));
        }
        assert_ne!(input.wake, Wake::Timer(TimerId(0)), "a timer that was cancelled");
        for _ in &input.inbox {
            output.measure("arrival", now.as_secs());
        }
        if (begins || !input.inbox.is_empty()) && me.index() + 1 < self.robots {
            output.count("passed on", 1);
            output.send(ActorId(me.0 + 1), word(1));
        }
    }
}

/// Along a chain of n robots a word makes n − 1 hops, each a frame of 2 + 5 bytes that one robot sends and one receives, and takes n − 1
/// times the latency.
#[test]
fn a_chain_of_messages_to_one_costs_as_many_bytes_as_it_has_hops() {
    const ROBOTS: u32 = 9;
    let mut setup = setup();
    setup.control.wake = WakeConfig::OnReception;
    setup.radio.latency = LatencyConfig::Constant(NonNegative::new(0.01));
    for driver in [DriverKind::Inline, DriverKind::Actors] {
        let robots = (0..ROBOTS).map(|_| Relay { robots: 0 }).collect();
        let record = setup
            .run(line(ROBOTS), robots, driver, &CancellationToken::new())
            .expect("the run reaches its end");
        let hops = u64::from(ROBOTS) - 1;
        assert_eq!(fates(&record), [hops, hops, 0]);
        let sum = |of: fn(&TrafficRow) -> u64| record.traffic.iter().map(of).sum::<u64>();
        let bytes = hops * (2 + FRAME_HEADER + MESSAGE_HEADER);
        assert_eq!(
            [sum(|row| row.sent.bytes()), sum(|row| row.received.bytes())],
            [bytes; 2]
        );
        assert_eq!(
            sum(|row| row.sent.frames.max(row.received.frames)),
            hops + 1,
            "one each"
        );

        let arrivals: Vec<_> = record.noted.iter().filter(|noted| noted.name == "arrival").collect();
        assert_eq!(arrivals.len() as u64, hops);
        for noted in arrivals {
            let Amount::Values(values) = &noted.amount else {
                panic!("arrivals are measured")
            };
            let at = 0.25 + 0.01 * f64::from(noted.robot.0);
            assert!(values.count == 1 && (values.sum - at).abs() < 1e-9, "{noted:?}");
        }
        let passed: Vec<_> = record.noted.iter().filter(|noted| noted.name == "passed on").collect();
        assert!(passed.iter().all(|noted| noted.amount == Amount::Count(1)));
        assert_eq!(passed.len() as u64, hops);
    }
}

#[test]
fn what_is_measured_must_be_a_finite_number() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let script: fn(ActorId, &mut Output<Word>) = match value {
            value if value.is_nan() => |_, output| output.measure("hops", f64::NAN),
            value if value > 0.0 => |_, output| output.measure("hops", f64::INFINITY),
            _ => |_, output| output.measure("hops", f64::NEG_INFINITY),
        };
        let error = run::<false>(&setup(), 2, DriverKind::Inline, script).expect_err("it is refused");
        let words = error.to_string();
        for part in ["robot 0 of ", "Speaker", "`hops`", &value.to_string()] {
            assert!(words.contains(part), "{words}");
        }
    }
}
