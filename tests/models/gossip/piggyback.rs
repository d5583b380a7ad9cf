//! Messages that share a frame: one header and one fate for all of them.

use desim::engine::{SimTime, Span};
use desim::geometry::{Pose, Vec2};
use desim::metrics::{TopicFates, TrialRecord};
use desim::protocol::control::PhaseConfig;
use desim::protocol::{CodecError, Input, Note, Output, Protocol, Role, Topic, Wake};
use desim::quantity::{NonNegative, Positive, Probability};
use desim::radio::{LatencyConfig, LossConfig};
use desim::simulation::{DriverKind, Setup};

use bytes::{Buf, BufMut, BytesMut};
use tokio_util::codec::{Decoder, Encoder};

/// Says three numbers a control step, on three topics, and checks that it hears those of a frame together and in order.
#[derive(Default)]
struct Chatter {
    said: u8,
    heard_apart: bool,
}

impl Protocol for Chatter {
    type Message = u8;
    type Heard = u8;
    type Codec = Numbers;
    const TOPICS: &'static [&'static str] = &["first", "second", "third"];
    const ROLES: &'static [&'static str] = &["together", "apart"];

    fn topic(number: &u8) -> Topic {
        Topic(number % 3)
    }

    fn step(&mut self, _now: SimTime, input: &mut Input<u8>, output: &mut Output<u8>) {
        let (frames, rest) = input.inbox.as_chunks::<3>();
        let is_whole = |[a, b, c]: &[desim::protocol::Reception<u8>; 3]| {
            let first = a.frame.message;
            (a.at, a.at) == (b.at, c.at)
                && first % 3 == 0
                && [b.frame.message, c.frame.message] == [first + 1, first + 2]
                && [b.frame.sequence, c.frame.sequence] == [a.frame.sequence + 1, a.frame.sequence + 2]
        };
        let together = rest.is_empty() && frames.iter().all(is_whole);
        if !together && !self.heard_apart {
            self.heard_apart = true;
            output.notes.push(Note::Role(Role(1)));
        }
        if input.wake == Wake::ControlStep {
            output.broadcasts.extend((0..3).map(|number| self.said + number));
            self.said = (self.said + 3) % 252;
        }
    }
}

#[derive(Default)]
struct Numbers;

impl Encoder<u8> for Numbers {
    type Error = CodecError;
    fn encode(&mut self, number: u8, bytes: &mut BytesMut) -> Result<(), CodecError> {
        bytes.put_u8(number);
        Ok(())
    }
}

impl Decoder for Numbers {
    type Item = u8;
    type Error = CodecError;
    fn decode(&mut self, bytes: &mut BytesMut) -> Result<Option<u8>, CodecError> {
        Ok(bytes.try_get_u8().ok())
    }
}

const STEPS: u64 = 501;

/// 50 s of two robots that hear each other.
fn chat(piggyback: bool, loss: LossConfig) -> TrialRecord {
    let mut setup = Setup::lasting(Span::from_secs(50.0));
    setup.piggyback = piggyback;
    setup.control.phase = PhaseConfig::Together;
    setup.radio.loss = loss;
    setup.radio.latency = LatencyConfig::Exponential {
        mean: Positive::new(0.1),
    };
    setup.metrics.sample_interval = NonNegative::new(0.0);
    let poses = [0.0, 1.0].map(|x| Pose {
        position: Vec2::new(x, 0.0),
        heading: 0.0,
    });
    let robots = vec![Chatter::default(), Chatter::default()];
    let run = setup.run(poses.to_vec(), robots, DriverKind::Inline, &Default::default());
    run.expect("the run reaches its end")
}

fn bernoulli() -> LossConfig {
    LossConfig::Bernoulli(Probability::new(0.5))
}

#[test]
fn all_messages_of_a_wake_share_one_fate_and_are_read_together_in_order() {
    let fates = |record: &TrialRecord| -> Vec<TopicFates> { record.ledger.clone() };
    let together = chat(true, bernoulli());
    assert!(together.robots.iter().all(|robot| robot.role == 0));
    let [first, second, third] = &fates(&together)[..] else {
        panic!("three topics")
    };
    assert_eq!((first, first), (second, third));
    assert!(first.is_balanced() && first.delivered > 0 && first.lost[0] > 0);
    let apart = chat(false, bernoulli());
    assert!(
        apart.robots.iter().all(|robot| robot.role == 1),
        "a frame each, they are not"
    );
    let [first, second, _] = &fates(&apart)[..] else {
        panic!("three topics")
    };
    assert_ne!(first.delivered, second.delivered);
}

/// 501 control steps of two robots: 1,002 frames with a header of 2 bytes, for which the first message answers, and 3
/// messages each with a header of 3.
#[test]
fn a_frame_has_one_header_for_which_its_first_message_answers() {
    let headers = |record: &TrialRecord, topic| -> u64 {
        let rows = record.traffic.iter().filter(|row| row.topic == topic);
        rows.map(|row| row.sent.header_bytes).sum()
    };
    let (together, apart) = (chat(true, bernoulli()), chat(false, bernoulli()));
    assert_eq!(
        [0, 1, 2].map(|topic| headers(&together, topic)),
        [5, 3, 3].map(|bytes| bytes * 2 * STEPS)
    );
    assert_eq!(
        [0, 1, 2].map(|topic| headers(&apart, topic)),
        [5, 5, 5].map(|bytes| bytes * 2 * STEPS)
    );
    let received = |record: &TrialRecord| -> [u64; 2] {
        let rows = record.traffic.iter().filter(|row| row.topic == 1);
        rows.fold([0, 0], |[frames, bytes], row| {
            [frames + row.received.frames, bytes + row.received.header_bytes]
        })
    };
    let [frames, bytes] = received(&together);
    assert_eq!(bytes, 3 * frames);
}

/// A Gilbert–Elliott chain steps once a frame: mean burst 1/0.25 = 4 frames, whether a frame holds one message or three. The
/// lost share of 1,002 copies is 0.5, σ √(0.25/1002 · 1.5/0.5) = 0.027. Four σ.
#[test]
fn a_burst_of_loss_lasts_as_many_frames_however_many_messages_they_hold() {
    let chain = LossConfig::GilbertElliott {
        good_to_bad: Probability::new(0.25),
        bad_to_good: Probability::new(0.25),
        good_loss: Probability::new(0.0),
        bad_loss: Probability::new(1.0),
    };
    let record = chat(true, chain);
    let lost = record.ledger[2].lost[0] as f64 / record.ledger[2].offered as f64;
    assert!((lost - 0.5).abs() < 4.0 * 0.027, "{lost}");
}
