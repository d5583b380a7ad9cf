//! What a medium is told, and what becomes of what it says.

use std::sync::{Arc, Mutex};

use desim::engine::{ActorId, SimTime, Span};
use desim::geometry::Vec2;
use desim::metrics::TrialRecord;
use desim::protocol::control::{PhaseConfig, WakeConfig};
use desim::protocol::{Input, Note, Output, Protocol, Serialised};
use desim::quantity::{NonNegative, Positive, Probability};
use desim::radio::{
    Fate, Fates, LatencyConfig, LossConfig, Medium, Places, RadioConfig, RadioKind, RadioSite, Reach, Transmission,
};
use desim::simulation::{DriverKind, Finished, Inbox, Observer, Setup};
use tokio_util::sync::CancellationToken;

use super::aloha::Aloha;
use super::late::Late;
use super::{Scripted, chatters, line, run, setup};

/// What it was handed: sender, number, bytes, for whom, from where, and who listens.
type Handed = (u32, u32, u32, Option<u32>, Vec2, Vec<u32>);

/// Everything arrives at once, and is written down.
#[derive(Clone, Debug, Default)]
struct Tapped(Arc<Mutex<Vec<Handed>>>);

impl RadioKind for Tapped {
    fn medium(&self, _: &RadioSite) -> Box<dyn Medium> {
        Box::new(self.clone())
    }
}

impl Medium for Tapped {
    fn reach(&self) -> Reach {
        Reach::Disk(1.5)
    }

    fn lookahead(&self) -> Span {
        Span::ZERO
    }

    fn transmit(&mut self, frame: &Transmission<'_>, _: &dyn Places, fates: &mut Fates) {
        let ears = frame.listeners.iter().map(|listener| listener.id.0).collect();
        self.0.lock().unwrap().push((
            frame.frame.sender.0,
            frame.frame.number,
            frame.bytes,
            frame.to.map(|to| to.0),
            frame.position,
            ears,
        ));
        let arrives = Fate::Arrives {
            at: frame.at,
            displacement: [0.0; 2],
        };
        frame
            .listeners
            .iter()
            .for_each(|listener| fates.push(listener.id, arrives));
    }
}

/// Robot 1 of a line says things to its neighbours, and to one that is far away.
struct Middle;

impl Protocol for Middle {
    type Message = Vec<u8>;
    type Heard = Arc<Vec<u8>>;
    type Codec = Serialised<Vec<u8>>;
    const TOPICS: &'static [&'static str] = &["word"];
    const ROLES: &'static [&'static str] = &["robot"];

    fn step(&mut self, now: SimTime, input: &mut Input<Arc<Vec<u8>>>, output: &mut Output<Vec<u8>>) {
        if input.me != ActorId(1) {
            return;
        }
        if now == SimTime::ZERO {
            output.broadcast(vec![0; 4]);
            output.send(ActorId(2), vec![0; 9]);
            output.send(ActorId(4), vec![0; 1]);
        } else if now == SimTime::from_secs(0.1) {
            output.send(ActorId(2), vec![0; 9]);
            output.send(ActorId(2), vec![0; 2]);
        } else {
            output.send(ActorId(2), vec![0; 3]);
            output.send(ActorId(0), vec![0; 7]);
        }
    }
}

/// The bytes of a payload of so many: its length goes before it.
const fn payload(bytes: u32) -> u32 {
    1 + bytes
}

#[test]
fn a_medium_is_told_how_long_a_frame_is_and_whose_and_for_whom_it_is() {
    let told = |piggyback| {
        let tapped = Tapped::default();
        let mut setup = setup(0.2, tapped.clone());
        setup.piggyback = piggyback;
        run(
            &setup,
            line(5, 1.0),
            (0..5).map(|_| Middle).collect(),
            DriverKind::Inline,
        );
        let mut told = tapped.0.lock().unwrap().clone();
        for frame in &mut told {
            assert_eq!((frame.0, frame.4), (1, Vec2::new(1.0, 0.0)));
            frame.5.sort_unstable();
        }
        told.into_iter()
            .map(|(_, number, bytes, to, _, ears)| (number, bytes, to, ears))
            .collect::<Vec<_>>()
    };
    let alone = [
        (0, 5 + payload(4), None, vec![0, 2]),
        (1, 5 + payload(9), Some(2), vec![2]),
        (2, 5 + payload(1), Some(4), vec![]),
        (3, 5 + payload(9), Some(2), vec![2]),
        (4, 5 + payload(2), Some(2), vec![2]),
        (5, 5 + payload(3), Some(2), vec![2]),
        (6, 5 + payload(7), Some(0), vec![0]),
    ];
    assert_eq!(told(false), alone);
    let together = [
        (0, 2 + 3 * 3 + payload(4) + payload(9) + payload(1), None, vec![0, 2]),
        (1, 2 + 2 * 3 + payload(9) + payload(2), Some(2), vec![2]),
        (2, 2 + 2 * 3 + payload(3) + payload(7), None, vec![0, 2]),
    ];
    assert_eq!(told(true), together);
}

/// Lossy, late and noisy, but with a latency that no copy falls short of.
fn disk() -> RadioConfig {
    let mut disk = RadioConfig {
        range: Positive::new(1.5),
        loss: LossConfig::Bernoulli(Probability::new(0.3)),
        latency: LatencyConfig::Normal {
            mean: NonNegative::new(0.03),
            std_dev: NonNegative::new(0.02),
            min: NonNegative::new(0.012),
        },
        ..RadioConfig::default()
    };
    disk.sensing.range_noise = NonNegative::new(0.1);
    disk
}

fn faults() -> &'static str {
    "#![enable(unwrap_variant_newtypes, unwrap_newtypes)] [
        Deaf(robots: [2], at: 1.013, lasts: For(0.5)),
        Mute(robots: [3], at: 1.5, lasts: For(0.71)),
        Crash(robots: [4], at: 2.0, lasts: For(0.333)),
        Partition(line: ((2.5, 0.0), (2.5, 1.0)), during: Between(0.5, 1.0)),
        Burst(links: Of([5]), loss: 0.5, during: From(2.0)),
    ]"
}

/// What no observer, no robot and no report should see a difference in: but for when it was told, and what of it at the end.
fn seen<P>(finished: Finished<P, ()>) -> (u128, Vec<u64>, desim::metrics::LatencyHistogram, Vec<P>) {
    let TrialRecord {
        digest,
        ledger,
        latency,
        ..
    } = finished.record;
    (
        digest,
        ledger.iter().map(|fates| fates.delivered).collect(),
        latency,
        finished.robots,
    )
}

fn assert_late_is_disk<const OVERHEARS: bool>(change: impl Fn(&mut Setup)) {
    let mut on_disk = Setup {
        own_radio: None,
        radio: disk(),
        ..setup(4.0, disk())
    };
    on_disk.control.phase = PhaseConfig::Random;
    on_disk.faults = ron::from_str(faults()).expect("faults");
    change(&mut on_disk);
    let chat = |setup: &Setup, driver| seen(run(setup, line(8, 0.7), chatters::<OVERHEARS>(8), driver));
    let expected = chat(&on_disk, DriverKind::Inline);
    assert!(expected.1.iter().all(|&delivered| delivered > 50), "{:?}", expected.1);
    for tells in [false, true] {
        let late = Setup {
            own_radio: Some(Arc::new(Late { disk: disk(), tells })),
            ..on_disk.clone()
        };
        for driver in [DriverKind::Inline, DriverKind::Actors] {
            // A copy that would arrive later may still be open when the run ends.
            let found = chat(&late, driver);
            assert_eq!((found.0, &found.1, &found.3), (expected.0, &expected.1, &expected.3));
        }
    }
}

/// Fates that come later change nothing, whatever shares a frame, whoever overhears it, and whatever wakes and fails meanwhile.
#[test]
fn a_disk_radio_that_tells_late_is_the_same_run() {
    for piggyback in [false, true] {
        for wake in [WakeConfig::ControlStep, WakeConfig::OnReception] {
            let change = |setup: &mut Setup| {
                setup.piggyback = piggyback;
                setup.control.wake = wake;
            };
            assert_late_is_disk::<false>(change);
            assert_late_is_disk::<true>(change);
        }
    }
}

#[test]
fn there_is_at_most_one_event_a_frame_and_none_a_copy() {
    let robots = || (0..12).map(|_| Scripted::new(&[0, 3, 4, 7, 15])).collect::<Vec<_>>();
    let aloha = Aloha {
        range: 50.0,
        bit_rate: 1e5,
    };
    let mut over_air = setup(3.0, aloha);
    over_air.control.phase = PhaseConfig::Random;
    let mut at_once = over_air.clone();
    at_once.own_radio = None;
    let [over_air, at_once] = [over_air, at_once].map(|setup| {
        let record = run(&setup, line(12, 0.1), robots(), DriverKind::Inline).record;
        (record.events, record.ledger[0].offered)
    });
    let (frames, copies) = (5 * 12, 5 * 12 * 11);
    assert_eq!((over_air.1, at_once.1), (copies, copies));
    // The robots wake for nothing but their control steps, so that all else is the same.
    let events = over_air.0 - at_once.0;
    assert!(events <= frames && events > frames / 2, "{events} events");
}

#[test]
fn the_same_seed_is_the_same_run_under_both_drivers_and_another_is_another() {
    let mut setup = setup(
        5.0,
        Aloha {
            range: 2.0,
            bit_rate: 2e4,
        },
    );
    setup.control.phase = PhaseConfig::Random;
    setup.control.wake = WakeConfig::OnReception;
    let chat = |setup: &Setup, driver| run(setup, line(10, 0.5), chatters::<true>(10), driver);
    let first = chat(&setup, DriverKind::Inline);
    for driver in [DriverKind::Inline, DriverKind::Actors] {
        let again = chat(&setup, driver);
        assert_eq!(again.record, first.record);
        assert_eq!(again.robots, first.robots);
    }
    assert!(
        first
            .record
            .ledger
            .iter()
            .all(|fates| fates.lost[0] > 0 && fates.delivered > 0)
    );
    setup.seed = 2;
    assert_ne!(chat(&setup, DriverKind::Inline).record.digest, first.record.digest);
}

/// A frame lasts for 0.48 s, in which its receiver goes from 1.4 m to 1.64 m, out of range.
#[test]
fn robots_that_move_while_a_frame_lasts_are_where_they_were_when_it_was_handed_over() {
    let aloha = Aloha {
        range: 1.5,
        bit_rate: 100.0,
    };
    let mut setup = setup(3.0, aloha);
    setup.motion.max_speed = Positive::new(0.5);
    let leaves = Scripted {
        velocity: Vec2::new(0.5, 0.0),
        ..Scripted::default()
    };
    let robots = vec![Scripted::new(&[0, 20]), leaves];
    let finished = run(&setup, line(2, 1.4), robots, DriverKind::Inline);
    assert!(finished.record.robots[1].pose.position.x > 1.64);
    let heard = &finished.robots[1].heard;
    assert_eq!(heard.len(), 1, "out of range from then on");
    let [x, y] = heard[0].3;
    assert!((x + 1.4).abs() < 1e-6 && y.abs() < 1e-6, "sensed at {x}, {y}");
}

#[test]
#[should_panic(expected = "where none is open")]
fn a_radio_that_decides_twice_is_caught() {
    #[derive(Clone, Debug)]
    struct Twice;
    struct Again(Option<desim::radio::FrameId>, SimTime);
    impl RadioKind for Twice {
        fn medium(&self, _: &RadioSite) -> Box<dyn Medium> {
            Box::new(Again(None, SimTime::NEVER))
        }
    }
    impl Medium for Again {
        fn reach(&self) -> Reach {
            Reach::Disk(1.5)
        }
        fn lookahead(&self) -> Span {
            Span::ZERO
        }
        fn transmit(&mut self, frame: &Transmission<'_>, _: &dyn Places, fates: &mut Fates) {
            fates.push(ActorId(1), Fate::Lost(desim::radio::LossCause::Channel));
            *self = Self(Some(frame.frame), frame.at);
        }
        fn next(&self) -> SimTime {
            self.1
        }
        fn advance(&mut self, _: SimTime, _: &dyn Places, fates: &mut Fates) -> Option<desim::radio::FrameId> {
            self.1 = SimTime::NEVER;
            fates.push(ActorId(1), Fate::Lost(desim::radio::LossCause::Channel));
            self.0
        }
    }
    let robots = vec![Scripted::new(&[0]), Scripted::new(&[])];
    run(&setup(1.0, Twice), line(2, 1.0), robots, DriverKind::Inline);
}

/// Notes that it wakes.
struct Awake;

impl Protocol for Awake {
    type Message = u8;
    type Heard = u8;
    type Codec = Serialised<u8>;
    const TOPICS: &'static [&'static str] = &["word"];
    const ROLES: &'static [&'static str] = &["robot"];

    fn step(&mut self, now: SimTime, input: &mut Input<u8>, output: &mut Output<u8>) {
        if input.me == ActorId(0) && now == SimTime::from_secs(0.1) {
            output.broadcast(1);
        }
        output.count("steps", 1);
    }
}

/// What robot 1 reads and waits for at each of its steps.
#[derive(Default)]
struct Waiting(Vec<(usize, Vec<SimTime>)>);

impl Observer for Waiting {
    fn noted<H>(&mut self, _: SimTime, robot: ActorId, _: &Note, inbox: &Inbox<'_, H>) {
        if robot == ActorId(1) {
            let waiting = inbox.waiting.iter().map(|reception| reception.at);
            self.0.push((inbox.read.len(), waiting.collect()));
        }
    }
}

/// Whoever asks what became of a message finds it on its way while it is on air: not lost, not out of range.
#[test]
fn a_frame_on_air_is_on_its_way_to_its_receivers_before_anybody_knows_whether_it_arrives() {
    let seen = |bit_rate| {
        let setup = setup(0.5, Aloha { range: 1.5, bit_rate });
        let (robots, stop) = (vec![Awake, Awake], CancellationToken::new());
        let finished = setup.observe(line(2, 1.0), robots, DriverKind::Inline, &stop, Waiting::default());
        finished.expect("the run reaches its end").observer.0
    };
    let [open, read, none] = [(0, vec![SimTime::NEVER]), (1, vec![]), (0, vec![])];
    // On air from 0.1 to 0.34 s.
    assert_eq!(
        seen(200.0),
        [&none, &open, &open, &open, &read, &none].map(Clone::clone)
    );
    // To 0.3 s: a robot that wakes at that very instant reads it.
    assert_eq!(
        seen(240.0),
        [&none, &open, &open, &read, &none, &none].map(Clone::clone)
    );
}
