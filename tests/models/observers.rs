//! What observers of a run are told: all of it, in order, the same under both drivers, and the run is none the wiser.

use desim::engine::{ActorId, SimTime, Span};
use desim::faults::Change;
use desim::geometry::{Pose, Vec2};
use desim::metrics::{TopicFates, TrialRecord};
use desim::motion::World;
use desim::protocol::control::PhaseConfig;
use desim::protocol::{Input, Note, Output, Protocol, Serialised, TimerId, Topic, Wake};
use desim::quantity::{NonNegative, Positive, Probability};
use desim::radio::{LatencyConfig, LossCause, LossConfig};
use desim::simulation::{Copy, DriverKind, Finished, Inbox, Observer, Sent, Setup};
use tokio_util::sync::CancellationToken;

/// Says one thing to all and another to its neighbour at each control step, and a third between two of them; counts what it does.
#[derive(Debug, Default, PartialEq)]
struct Talker {
    said: u8,
    heard: u64,
}

impl Protocol for Talker {
    type Message = (u8, u8);
    type Heard = (u8, u8);
    type Codec = Serialised<(u8, u8)>;
    const TOPICS: &'static [&'static str] = &["all", "one", "late"];
    const ROLES: &'static [&'static str] = &["robot"];

    fn topic(message: &(u8, u8)) -> Topic {
        Topic(message.0)
    }

    fn step(&mut self, now: SimTime, input: &mut Input<(u8, u8)>, output: &mut Output<(u8, u8)>) {
        self.heard += input.inbox.len() as u64;
        self.said = self.said.wrapping_add(1);
        output.velocity = Some(Vec2::new(0.001, 0.0));
        if input.wake == Wake::Timer(TimerId(0)) {
            output.broadcast((2, self.said));
            return;
        }
        output.broadcast((0, self.said));
        output.send(ActorId((input.me.0 + 1) % ROBOTS), (1, self.said));
        output.set_timer(TimerId(0), now + Span::from_secs(0.03));
        output.count("steps", 1);
    }
}

const ROBOTS: u32 = 8;

fn setup(piggyback: bool) -> Setup {
    let mut setup = Setup::lasting(Span::from_secs(20.0));
    setup.piggyback = piggyback;
    setup.control.phase = PhaseConfig::Random;
    setup.radio.range = Positive::new(2.5);
    setup.radio.loss = LossConfig::Bernoulli(Probability::new(0.2));
    setup.radio.latency = LatencyConfig::Normal {
        mean: NonNegative::new(0.05),
        std_dev: NonNegative::new(0.02),
        min: NonNegative::new(0.04),
    };
    let faults = "#![enable(unwrap_variant_newtypes, unwrap_newtypes)] [
        Deaf(robots: [2], at: 5.0, lasts: For(2.0)),
        Crash(robots: [4], at: 10.0, lasts: For(5.0)),
    ]";
    setup.faults = ron::from_str(faults).expect("faults");
    setup
}

fn observe<O: Observer>(setup: &Setup, driver: DriverKind, observer: O) -> Finished<Talker, O> {
    let pose = |robot| Pose {
        position: Vec2::new(f64::from(robot) - 3.5, 0.0),
        heading: 0.0,
    };
    let robots = (0..ROBOTS).map(|_| Talker::default()).collect();
    let poses = (0..ROBOTS).map(pose).collect();
    let finished = setup.observe(poses, robots, driver, &CancellationToken::new(), observer);
    finished.expect("the run reaches its end")
}

#[derive(Default)]
struct ByTopic([u64; 3]);

impl Observer for ByTopic {
    fn sent(&mut self, message: &Sent<'_>) {
        self.0[usize::from(message.topic.0)] += 1;
    }
}

#[test]
fn messages_counted_by_topic_are_those_of_the_record() {
    for piggyback in [false, true] {
        let Finished { record, observer, .. } = observe(&setup(piggyback), DriverKind::Inline, ByTopic::default());
        let sent = |topic| {
            let rows = record.traffic.iter().filter(|row| row.topic == topic);
            rows.map(|row| row.sent.frames).sum::<u64>()
        };
        assert_eq!(observer.0, [0, 1, 2].map(sent));
        assert!(observer.0.iter().all(|&sent| sent > 1000));
    }
}

/// Every happening in words, with its time.
#[derive(Default)]
struct Diary<const IN_ORDER: bool> {
    pages: Vec<(SimTime, String)>,
    samples: usize,
}

impl<const IN_ORDER: bool> Diary<IN_ORDER> {
    fn write(&mut self, now: SimTime, words: String) {
        self.pages.push((now, words));
    }
}

impl<const IN_ORDER: bool> Observer for Diary<IN_ORDER> {
    const IN_ORDER: bool = IN_ORDER;

    fn woke<H, M>(&mut self, now: SimTime, robot: ActorId, input: &Input<H>, output: &Output<M>) {
        assert_eq!(robot, input.me);
        let said = output.broadcasts.len() + output.sends.len();
        let words = format!(
            "{robot} woke: {:?}, {} read, {said} said",
            input.wake,
            input.inbox.len()
        );
        self.write(now, words);
    }

    fn noted<H>(&mut self, now: SimTime, robot: ActorId, note: &Note, inbox: &Inbox<'_, H>) {
        self.write(now, format!("{robot} notes {note:?}, {} waiting", inbox.waiting.len()));
    }

    fn sent(&mut self, message: &Sent<'_>) {
        assert_eq!(message.payload, [message.topic.0, message.payload[1]]);
        self.write(message.at, format!("{message:?}"));
    }

    fn spoke(&mut self, now: SimTime, robot: ActorId, world: &World) {
        self.write(now, format!("{robot} spoke at {}", world.position(robot, now)));
    }

    fn arrives(&mut self, copy: &Copy, at: SimTime) {
        self.write(copy.sent_at, format!("{copy:?} arrives at {at:?}"));
    }

    fn lost(&mut self, copy: &Copy, cause: LossCause, at: SimTime) {
        // What is lost at a robot that cannot hear is told later.
        let told = if cause == LossCause::ReceiverDown {
            self.pages.last().map_or(at, |page| page.0)
        } else {
            at
        };
        self.write(told, format!("{copy:?} lost at {at:?}: {cause:?}"));
    }

    fn delivered(&mut self, copy: &Copy, at: SimTime, read: Option<SimTime>) {
        let told = read.unwrap_or_else(|| self.pages.last().map_or(at, |page| page.0));
        assert!(at <= told && copy.sent_at < at);
        self.write(told, format!("{copy:?} delivered at {at:?}, read at {read:?}"));
    }

    fn in_flight(&mut self, copy: &Copy, at: Option<SimTime>) {
        let end = SimTime::from_secs(20.0);
        let at = at.expect("a disk radio knows");
        assert!(at > end);
        self.write(end, format!("{copy:?} in flight until {at:?}"));
    }

    fn fault(&mut self, now: SimTime, change: &Change, positions: &[Vec2]) {
        assert_eq!(positions.len(), ROBOTS as usize);
        self.write(now, format!("{change:?}"));
    }

    fn tick(&mut self, world: &World) {
        self.write(
            world.now(),
            format!("tick: {}", world.position(ActorId(0), world.now())),
        );
    }

    fn sample(&mut self, now: SimTime, positions: &[Vec2]) {
        self.samples += 1;
        self.write(now, format!("sample: {positions:?}"));
    }

    fn end(&mut self, end: SimTime) {
        self.write(end, "end".to_owned());
    }
}

fn count(diary: &[(SimTime, String)], words: &str) -> u64 {
    diary.iter().filter(|page| page.1.contains(words)).count() as u64
}

#[test]
fn observers_are_told_everything_in_order_and_the_same_under_both_drivers() {
    for piggyback in [false, true] {
        let inline = observe(&setup(piggyback), DriverKind::Inline, Diary::<true>::default());
        let actors = observe(&setup(piggyback), DriverKind::Actors, Diary::<true>::default());
        let pages = &inline.observer.pages;
        assert_eq!(*pages, actors.observer.pages);
        assert_eq!(inline.record, actors.record);
        assert_eq!(inline.robots, actors.robots);
        assert!(pages.is_sorted_by_key(|page| page.0));
        assert_eq!(pages.last().map(|page| page.1.as_str()), Some("end"));

        // As many of each as the record says.
        let sum = |of: fn(&TopicFates) -> u64| inline.record.ledger.iter().map(of).sum::<u64>();
        assert_eq!(count(pages, "delivered at"), sum(|fates| fates.delivered));
        assert_eq!(count(pages, " lost at "), sum(|fates| fates.lost.iter().sum()));
        assert_eq!(count(pages, "in flight until"), sum(|fates| fates.in_flight));
        for cause in LossCause::ALL {
            let lost = inline
                .record
                .ledger
                .iter()
                .map(|fates| fates.lost[cause as usize])
                .sum::<u64>();
            assert_eq!(count(pages, &format!(": {cause:?}")), lost, "{cause:?}");
        }
        let down = sum(|fates| fates.lost[LossCause::ReceiverDown as usize]);
        let arriving = sum(|fates| fates.delivered + fates.in_flight) + down;
        assert_eq!(count(pages, "arrives at"), arriving);
        assert!(down > 0 && sum(|fates| fates.in_flight) > 0);
        assert_eq!(inline.observer.samples, inline.record.connectivity.len());
        // Two failures begin and end.
        assert_eq!(count(pages, "Change {"), 4);
        // A robot that crashed for 5 s of 20 took 50 control steps fewer.
        let steps = inline.record.robots.iter().map(|robot| robot.steps).sum::<u64>();
        assert_eq!(count(pages, "notes Count"), steps - 50);
        assert_eq!(count(pages, "woke: ControlStep"), steps - 50);
        let heard: u64 = inline.robots.iter().map(|robot| robot.heard).sum();
        assert_eq!(count(pages, "read at Some"), heard);
    }
}

#[test]
fn nobody_can_tell_from_a_run_whether_it_was_watched() {
    let unwatched = |setup: &Setup| observe(setup, DriverKind::Inline, ()).record;
    for piggyback in [false, true] {
        let setup = setup(piggyback);
        let expected: TrialRecord = unwatched(&setup);
        assert_eq!(
            observe(&setup, DriverKind::Inline, Diary::<true>::default()).record,
            expected
        );
        let mut diary = Diary::<false>::default();
        let mut topics = Some(ByTopic::default());
        let finished = observe(&setup, DriverKind::Inline, (&mut diary, &mut topics));
        assert_eq!(finished.record, expected);
        // In rounds other things are told at other times, but the same.
        let mut in_order = observe(&setup, DriverKind::Inline, Diary::<true>::default())
            .observer
            .pages;
        let said = |pages: &mut Vec<(SimTime, String)>| {
            pages.sort();
            pages
                .iter()
                .map(|page| page.1.clone())
                .filter(|page| !page.contains("lost"))
                .collect::<Vec<_>>()
        };
        let waiting = |page: &String| !page.contains("waiting");
        let [mut in_order, mut in_rounds] = [said(&mut in_order), said(&mut diary.pages)];
        in_order.retain(waiting);
        in_rounds.retain(waiting);
        assert_eq!(in_order, in_rounds);
        assert!(topics.is_some_and(|topics| topics.0[0] > 1000));
    }
}

/// Ends the run at its tenth control step.
struct Impatient(Vec<u64>);

impl Observer for Impatient {
    fn judges(&self) -> bool {
        true
    }

    fn judge(&mut self, step: u64, positions: &[Vec2]) -> bool {
        assert_eq!(positions.len(), ROBOTS as usize);
        self.0.push(step);
        step == 9
    }
}

#[test]
fn an_observer_that_judges_ends_the_run() {
    let mut impatient = Impatient(Vec::new());
    let finished = observe(&setup(false), DriverKind::Inline, (&mut impatient, ByTopic::default()));
    assert_eq!(finished.record.simulated, SimTime::from_secs(0.9));
    assert_eq!(finished.record.steps, 10);
    assert_eq!(impatient.0, (0..10).collect::<Vec<_>>());
}
