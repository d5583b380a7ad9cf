//! Codecs that do not give back what they were given: the run says so, and does not go on with what is left.

use bytes::{Buf, BufMut, BytesMut};
use desim::engine::{SimTime, Span};
use desim::geometry::{Pose, Vec2};
use desim::protocol::{CodecError, Input, Output, Protocol, Serialised, Topic};
use desim::simulation::{DriverKind, RunError, Setup};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use tokio_util::codec::{Decoder, Encoder};
use tokio_util::sync::CancellationToken;

/// A robot whose messages name their topic, in `WRITTEN` bytes of which it reads `READ`; what it reads is on topic `TOPIC` if that is one.
struct Talker<const WRITTEN: usize, const READ: usize, const TOPIC: u8>;

#[derive(Default)]
struct Bytes<const WRITTEN: usize, const READ: usize, const TOPIC: u8>;

impl<const WRITTEN: usize, const READ: usize, const TOPIC: u8> Encoder<u8> for Bytes<WRITTEN, READ, TOPIC> {
    type Error = CodecError;

    fn encode(&mut self, topic: u8, bytes: &mut BytesMut) -> Result<(), CodecError> {
        bytes.put_bytes(topic, WRITTEN);
        Ok(())
    }
}

impl<const WRITTEN: usize, const READ: usize, const TOPIC: u8> Decoder for Bytes<WRITTEN, READ, TOPIC> {
    type Item = u8;
    type Error = CodecError;

    fn decode(&mut self, bytes: &mut BytesMut) -> Result<Option<u8>, CodecError> {
        if bytes.len() < READ {
            return Ok(None);
        }
        let topic = bytes[0];
        bytes.advance(READ);
        Ok(Some(if TOPIC < 2 { TOPIC } else { topic }))
    }
}

impl<const WRITTEN: usize, const READ: usize, const TOPIC: u8> Protocol for Talker<WRITTEN, READ, TOPIC> {
    type Message = u8;
    type Heard = u8;
    type Codec = Bytes<WRITTEN, READ, TOPIC>;
    const TOPICS: &'static [&'static str] = &["greeting", "news"];
    const ROLES: &'static [&'static str] = &["robot"];

    fn topic(message: &u8) -> Topic {
        Topic(*message)
    }

    fn step(&mut self, _: SimTime, _: &mut Input<u8>, output: &mut Output<u8>) {
        output.broadcasts.push(1);
    }
}

fn run<const WRITTEN: usize, const READ: usize, const TOPIC: u8>() -> Result<u64, RunError> {
    let pose = |x| Pose {
        position: Vec2::new(x, 0.0),
        heading: 0.0,
    };
    let robots = vec![Talker::<WRITTEN, READ, TOPIC>, Talker::<WRITTEN, READ, TOPIC>];
    let setup = Setup::lasting(Span::from_secs(2.0));
    let record = setup.run(
        vec![pose(0.0), pose(1.0)],
        robots,
        DriverKind::Inline,
        &CancellationToken::new(),
    )?;
    Ok(record.ledger[1].delivered)
}

#[track_caller]
fn assert_refused(run: Result<u64, RunError>, words: &[&str]) {
    let message = run.expect_err("the codec is refused").to_string();
    for words in words {
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn a_codec_that_leaves_bytes_unread_is_refused_by_name_topic_and_bytes() {
    assert_refused(run::<21, 1, 9>(), &["Talker", "reads 1 of its own 21 bytes", "`news`"]);
    assert_refused(run::<2, 1, 9>(), &["reads 1 of its own 2 bytes"]);
    assert!(run::<21, 21, 9>().unwrap() > 0);
}

#[test]
fn a_codec_that_changes_the_topic_is_refused_with_both() {
    assert_refused(
        run::<3, 3, 0>(),
        &["Talker", "topic `greeting`", "topic `news`", "3 bytes"],
    );
    assert!(run::<3, 3, 1>().unwrap() > 0, "the same topic is no other");
}

#[test]
fn a_codec_that_waits_for_more_than_it_wrote_and_a_message_too_long_are_refused_by_name() {
    assert_refused(run::<3, 4, 9>(), &["Talker", "3 bytes", "`news`", "whole message"]);
    assert_refused(run::<70000, 1, 9>(), &["Talker", "70000 bytes", "`news`", "65535"]);
}

/// A robot with a codec that it did not write: it greets, or says what does not come back as it was.
struct Borrower(Said);

#[derive(Clone, Copy, Debug)]
enum Said {
    Greeting,
    Long,
    Spoilt,
}

impl Serialize for Said {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Greeting => 0_u8.serialize(serializer),
            Self::Long => (1_u8, 0_u8, 0_u8).serialize(serializer),
            Self::Spoilt => 9_u8.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for Said {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match u8::deserialize(deserializer)? {
            0 => Ok(Self::Greeting),
            1 => Ok(Self::Long),
            _ => Err(D::Error::custom("spoilt")),
        }
    }
}

impl Protocol for Borrower {
    type Message = Said;
    type Heard = Said;
    type Codec = Serialised<Said>;
    const TOPICS: &'static [&'static str] = &["greeting", "news"];
    const ROLES: &'static [&'static str] = &["robot"];

    fn topic(said: &Said) -> Topic {
        Topic(u8::from(!matches!(said, Said::Greeting)))
    }

    fn step(&mut self, _: SimTime, _: &mut Input<Said>, output: &mut Output<Said>) {
        output.broadcast(self.0);
    }
}

#[test]
fn a_message_that_serde_reads_otherwise_than_it_writes_is_refused_by_name_topic_and_bytes() {
    let run = |said| {
        let robots = vec![Borrower(said), Borrower(said)];
        let setup = Setup::lasting(Span::from_secs(2.0));
        let poses = vec![Pose::default(); 2];
        let record = setup.run(poses, robots, DriverKind::Inline, &CancellationToken::new())?;
        Ok(record.ledger[0].delivered)
    };
    assert!(run(Said::Greeting).unwrap() > 0);
    assert_refused(run(Said::Long), &["Borrower", "reads 1 of its own 3 bytes", "`news`"]);
    assert_refused(run(Said::Spoilt), &["Borrower", "`news`", "1 bytes", "postcard"]);
}
