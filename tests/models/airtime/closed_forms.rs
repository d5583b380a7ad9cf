//! Pure ALOHA against its closed forms.

use desim::engine::{ActorId, SimTime, Span};
use desim::geometry::Pose;
use desim::protocol::{Input, Output, Protocol, Serialised, TimerId, Wake};
use desim::radio::LossCause;
use desim::simulation::{Copy, DriverKind, Finished, Observer};
use rand::RngExt as _;
use tokio_util::sync::CancellationToken;

use super::aloha::Aloha;
use super::{HEADERS, Scripted, line, run, setup};

const PAYLOAD: usize = 32;

/// 802.15.4's.
const BIT_RATE: f64 = 250e3;

/// Says something at the instants of a Poisson process.
struct Poisson {
    rate: f64,
}

impl Protocol for Poisson {
    type Message = [u8; PAYLOAD];
    type Heard = [u8; PAYLOAD];
    type Codec = Serialised<[u8; PAYLOAD]>;
    const TOPICS: &'static [&'static str] = &["status"];
    const ROLES: &'static [&'static str] = &["robot"];

    fn step(&mut self, now: SimTime, input: &mut Input<[u8; PAYLOAD]>, output: &mut Output<[u8; PAYLOAD]>) {
        let begins = input.wake == Wake::ControlStep && now == SimTime::ZERO;
        let due = input.wake == Wake::Timer(TimerId(0));
        if due {
            output.broadcast([7; PAYLOAD]);
        }
        if begins || due {
            let uniform: f64 = input.random.random();
            output.set_timer(TimerId(0), now + Span::from_secs(-(1.0 - uniform).ln() / self.rate));
        }
    }
}

/// A frame is received by nobody or by all: whoever sends meanwhile is in range of all. With n robots that each load the channel by ρ, another one is not
/// on air when a frame begins with probability 1 − ρ, and does not begin while it lasts with e^−ρ, so that a frame is received with
/// p = ((1 − ρ) e^−ρ)^(n−1), which is e^−2G for many robots that together load the channel by G.
///
/// For these, with a Poisson process of frames and q = e^−G, a frame is clean if the gaps on both its sides are long enough, each with probability q: clean
/// frames next to each other share a gap, others none, so the number of clean ones among N has the variance N (q²(1 − q²) + 2(q³ − q⁴)).
#[test]
fn frames_of_poisson_senders_are_received_as_often_as_in_pure_aloha() {
    let radio = Aloha {
        range: 2.0,
        bit_rate: BIT_RATE,
    };
    let airtime = radio.airtime(HEADERS + PAYLOAD as u32).as_secs();
    let (robots, seconds) = (50, 60.0);
    for rate in [1.0, 4.0, 10.0] {
        let load = rate * airtime;
        let senders = (0..robots).map(|_| Poisson { rate }).collect();
        let poses = vec![Pose::default(); robots];
        let record = run(&setup(seconds, radio), poses, senders, DriverKind::Inline).record;
        let fates = &record.ledger[0];
        let frames = fates.offered as f64 / (robots - 1) as f64;
        let expected = ((1.0 - load) * (-load).exp()).powf((robots - 1) as f64);
        let q = (-load * robots as f64).exp();
        let variance = (q * q * (1.0 - q * q) + 2.0 * (q.powi(3) - q.powi(4))) / frames;
        let received = fates.delivered as f64 / fates.offered as f64;
        let allowed = 4.0 * variance.sqrt();
        assert!(
            (received - expected).abs() < allowed,
            "at {rate} /s: {received}, not {expected} ± {allowed}"
        );
        assert!(
            (frames / (rate * seconds * robots as f64) - 1.0).abs() < 4.0 / frames.sqrt(),
            "{frames} frames at {rate} /s"
        );
        let causes = LossCause::ALL.map(|cause| fates.lost[cause as usize]);
        assert_eq!(causes[LossCause::Channel as usize], causes.iter().sum::<u64>());
    }
}

#[test]
fn a_frame_takes_as_long_as_its_bytes() {
    for bit_rate in [250e3, 1e3] {
        let radio = Aloha { range: 2.0, bit_rate };
        let robots = vec![Scripted::new(&[1, 3, 8]), Scripted::new(&[])];
        let Finished { record, robots, .. } = run(&setup(2.0, radio), line(2, 1.0), robots, DriverKind::Inline);
        let airtime = radio.airtime(HEADERS + 1);
        let heard = |step: u64| SimTime::ZERO + Span::from_secs(0.1) * step + airtime;
        let arrivals: Vec<SimTime> = robots[1].heard.iter().map(|heard| heard.0).collect();
        assert_eq!(arrivals, [1, 3, 8].map(heard));
        assert_eq!(
            (record.latency.min(), record.latency.max()),
            (Some(airtime), Some(airtime))
        );
    }
}

/// What became of a frame of 48 bits at 100 bit/s, handed over at 0.1 s, when the run ends at `end` seconds.
#[derive(Default)]
struct Fate {
    told: Vec<&'static str>,
}

impl Observer for Fate {
    fn arrives(&mut self, _: &Copy, _: SimTime) {
        self.told.push("arrives");
    }

    fn delivered(&mut self, _: &Copy, _: SimTime, read: Option<SimTime>) {
        self.told.push(if read.is_some() { "read" } else { "unread" });
    }

    fn in_flight(&mut self, _: &Copy, at: Option<SimTime>) {
        self.told.push(if at.is_some() { "to arrive" } else { "open" });
    }
}

#[test]
fn a_frame_that_is_on_air_when_the_run_ends_is_in_flight_and_nobody_knows_whether_it_would_have_arrived() {
    let radio = Aloha {
        range: 2.0,
        bit_rate: 100.0,
    };
    // It lasts from 0.1 to 0.58 s, and is read at 0.6 s.
    for (end, told) in [
        (0.57, &["open"][..]),
        (0.58, &["arrives", "unread"]),
        (0.59, &["arrives", "unread"]),
        (0.6, &["arrives", "read"]),
    ] {
        let robots = vec![Scripted::new(&[1]), Scripted::new(&[])];
        let stop = CancellationToken::new();
        let finished = setup(end, radio).observe(line(2, 1.0), robots, DriverKind::Inline, &stop, Fate::default());
        let Finished { record, observer, .. } = finished.expect("the run reaches its end");
        assert_eq!(observer.told, told, "end at {end}");
        let fates = &record.ledger[0];
        let open = u64::from(told == ["open"]);
        assert_eq!((fates.offered, fates.in_flight, fates.delivered), (1, open, 1 - open));
        assert_eq!(record.latency.max().is_some(), open == 0);
    }
}

/// Four in a line, of whom each hears its neighbours.
#[test]
fn what_overlaps_at_a_receiver_is_lost_there_and_nowhere_else() {
    let radio = Aloha {
        range: 1.5,
        bit_rate: 1e3,
    };
    let say = |scripts: [&[u8]; 4]| {
        let robots = scripts.map(Scripted::new).to_vec();
        let Finished { record, robots, .. } = run(&setup(1.0, radio), line(4, 1.0), robots, DriverKind::Inline);
        assert!(record.ledger[0].is_balanced());
        robots.iter().map(Scripted::words).collect::<Vec<_>>()
    };
    // Hidden from each other, heard by one.
    assert_eq!(say([&[1], &[], &[1], &[]]), [vec![], vec![], vec![], vec![(2, 1)]]);
    // The ends, of whom nobody hears both.
    assert_eq!(
        say([&[1], &[], &[], &[1]]),
        [vec![], vec![(0, 1)], vec![(3, 1)], vec![]]
    );
    // Neighbours hear nothing while they send themselves; the others hear them.
    assert_eq!(
        say([&[], &[1], &[1], &[]]),
        [vec![(1, 1)], vec![], vec![], vec![(2, 1)]]
    );
    // One after the other.
    assert_eq!(
        say([&[1], &[2], &[], &[]]),
        [vec![(1, 2)], vec![(0, 1)], vec![(1, 2)], vec![]]
    );
}

#[test]
fn a_robot_with_two_things_to_say_says_one_after_the_other() {
    /// Says two things at its first control step.
    #[derive(Default)]
    struct Twice(Vec<SimTime>);
    impl Protocol for Twice {
        type Message = u8;
        type Heard = u8;
        type Codec = Serialised<u8>;
        const TOPICS: &'static [&'static str] = &["word"];
        const ROLES: &'static [&'static str] = &["robot"];

        fn step(&mut self, now: SimTime, input: &mut Input<u8>, output: &mut Output<u8>) {
            self.0.extend(input.inbox.iter().map(|reception| reception.at));
            if now == SimTime::ZERO && input.me == ActorId(0) {
                output.broadcast(1);
                output.broadcast(2);
            }
        }
    }
    let radio = Aloha {
        range: 2.0,
        bit_rate: 1e3,
    };
    let mut setup = setup(1.0, radio);
    for (piggyback, bytes) in [(false, [6, 12]), (true, [10, 10])] {
        setup.piggyback = piggyback;
        let robots = vec![Twice::default(), Twice::default()];
        let finished = run(&setup, line(2, 1.0), robots, DriverKind::Inline);
        // Two frames of 2 + 3 + 1 bytes; or one of 2 + 2 · (3 + 1).
        assert_eq!(
            finished.robots[1].0,
            bytes.map(|bytes| SimTime::ZERO + radio.airtime(bytes))
        );
        assert_eq!(finished.record.ledger[0].delivered, 2);
    }
}
