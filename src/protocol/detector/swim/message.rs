//! What robots that run SWIM say to each other, and its bytes.
//!
//! | part | bytes |
//! |---|---|
//! | kind | 1: 0x40 ping, 0x41 request, 0x42 ack |
//! | to | an id; of a request the number of robots asked, their ids, and the id of the robot to be probed |
//! | number | 2 |
//! | news | number of pieces, and of each: 0 alive, 1 suspected, 2 down; an id; the incarnation |
//!
//! Ids and incarnations take seven bits a byte, the lowest first, the top bit set in all but the last.

use std::ops::RangeInclusive;

use bytes::{Buf, BufMut, BytesMut};
use serde::{Deserialize, Serialize};

use crate::engine::ActorId;
use crate::protocol::{CodecError, Part};

const MARK: u8 = 0x40;
const PING: u8 = 0x40;
const REQUEST: u8 = 0x41;
const ACK: u8 = 0x42;
/// What kinds are called.
const KINDS: &[(u64, &str)] = &[(PING as u64, "ping"), (REQUEST as u64, "request"), (ACK as u64, "ack")];
/// Bytes of the longest number.
const LONGEST: usize = 5;

/// A message of SWIM. All are broadcast and name whom they are for; the news in it is for everybody. Its bytes are those of
/// [`encode`](Self::encode), or, in a message that is [`Serialised`](crate::protocol::Serialised), as many or a few more.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Probe {
    /// What it asks or answers.
    pub call: Call,
    /// Number of the probe among those of the robot that waits for its acknowledgement.
    pub number: u16,
    /// What the sender passes on.
    pub news: Vec<News>,
}

/// What a message asks or answers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Call {
    /// Asks a robot to acknowledge.
    Ping {
        /// Which.
        to: ActorId,
    },
    /// Asks others to ping a robot and to pass its acknowledgement on.
    Request {
        /// Who is asked.
        to: Vec<ActorId>,
        /// Whom to ping.
        target: ActorId,
    },
    /// Acknowledges a ping, or passes an acknowledgement on.
    Ack {
        /// Who waits for it.
        to: ActorId,
    },
}

/// A claim about a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct News {
    /// The robot.
    pub about: ActorId,
    /// What is claimed.
    pub claim: Claim,
    /// The incarnation of the robot that it is claimed of. A robot raises its own when it denies a claim.
    pub incarnation: u32,
}

/// What is claimed of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Claim {
    /// It says itself that it is alive.
    Alive,
    /// It did not acknowledge.
    Suspected,
    /// It did not deny that either.
    Down,
}

impl Probe {
    /// Whether a payload that begins with `first` is one. Protocols whose other messages never have this bit in their first
    /// byte can tell them apart.
    #[must_use]
    pub const fn begins_with(first: u8) -> bool {
        first & MARK != 0
    }

    /// How its bytes lie: for the layout of a protocol that carries it, a case for each kind.
    #[must_use]
    pub fn layout() -> Vec<(RangeInclusive<u8>, Vec<Part>)> {
        let kind = Part::named("probe", KINDS);
        let to = || vec![Part::robot_varint("to")];
        let request = vec![Part::list("number asked", to()), Part::robot_varint("probed")];
        let claims = Part::named("claim", &[(0, "alive"), (1, "suspected"), (2, "down")]);
        let news = vec![claims, Part::robot_varint("about"), Part::varint("incarnation")];
        let rest = [Part::number("number", 2), Part::list("pieces of news", news)];
        let case = |first: u8, called: Vec<Part>| {
            let parts = std::iter::once(kind.clone()).chain(called).chain(rest.clone());
            (first..=first, parts.collect())
        };
        vec![case(PING, to()), case(REQUEST, request), case(ACK, to())]
    }

    /// Appends its bytes.
    pub fn encode(&self, bytes: &mut BytesMut) {
        match &self.call {
            Call::Ping { to } => {
                bytes.put_u8(PING);
                put(to.0, bytes);
            }
            Call::Request { to, target } => {
                bytes.put_slice(&[REQUEST, to.len() as u8]);
                for robot in to {
                    put(robot.0, bytes);
                }
                put(target.0, bytes);
            }
            Call::Ack { to } => {
                bytes.put_u8(ACK);
                put(to.0, bytes);
            }
        }
        bytes.put_u16(self.number);
        bytes.put_u8(self.news.len() as u8);
        for news in &self.news {
            bytes.put_u8(news.claim as u8);
            put(news.about.0, bytes);
            put(news.incarnation, bytes);
        }
    }

    /// Takes its bytes.
    ///
    /// # Errors
    /// If they are cut short, or a field does not know its value.
    pub fn decode(bytes: &mut BytesMut) -> Result<Self, CodecError> {
        let mut reader = Reader {
            length: bytes.len(),
            bytes,
        };
        let kind = reader.byte()?;
        let call = match kind {
            PING => Call::Ping { to: reader.id()? },
            REQUEST => Call::Request {
                to: reader.ids()?,
                target: reader.id()?,
            },
            ACK => Call::Ack { to: reader.id()? },
            _ => return Err(unknown("message kind", kind)),
        };
        let number = u16::from_be_bytes([reader.byte()?, reader.byte()?]);
        let count = reader.byte()?;
        // The capacity is bounded by what is there, not by what the payload claims.
        let mut news = Vec::with_capacity(usize::from(count).min(reader.bytes.len()));
        for _ in 0..count {
            news.push(reader.news()?);
        }
        Ok(Self { call, number, news })
    }
}

fn unknown(field: &'static str, value: u8) -> CodecError {
    CodecError::Unknown { field, value }
}

fn put(mut number: u32, bytes: &mut BytesMut) {
    while number > 0x7f {
        bytes.put_u8(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.put_u8(number as u8);
}

/// Reads a payload, and knows how long it was for its errors.
struct Reader<'a> {
    bytes: &'a mut BytesMut,
    length: usize,
}

impl Reader<'_> {
    fn byte(&mut self) -> Result<u8, CodecError> {
        self.bytes.try_get_u8().map_err(|_| CodecError::Truncated(self.length))
    }

    fn number(&mut self) -> Result<u32, CodecError> {
        let mut number = 0;
        for place in 0..LONGEST {
            let byte = self.byte()?;
            if place + 1 == LONGEST && byte > 0x0f {
                return Err(unknown("last byte of a number", byte));
            }
            number |= u32::from(byte & 0x7f) << (7 * place);
            if byte & 0x80 == 0 {
                break;
            }
        }
        Ok(number)
    }

    fn id(&mut self) -> Result<ActorId, CodecError> {
        self.number().map(ActorId)
    }

    fn ids(&mut self) -> Result<Vec<ActorId>, CodecError> {
        let count = self.byte()?;
        (0..count).map(|_| self.id()).collect()
    }

    fn news(&mut self) -> Result<News, CodecError> {
        let claim = match self.byte()? {
            0 => Claim::Alive,
            1 => Claim::Suspected,
            2 => Claim::Down,
            other => return Err(unknown("claim", other)),
        };
        Ok(News {
            claim,
            about: self.id()?,
            incarnation: self.number()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::Layout;
    use proptest::prelude::*;

    fn id() -> impl Strategy<Value = ActorId> {
        prop_oneof![0_u32..300, any::<u32>()].prop_map(ActorId)
    }

    fn news() -> impl Strategy<Value = News> {
        let claim = prop_oneof![Just(Claim::Alive), Just(Claim::Suspected), Just(Claim::Down)];
        (id(), claim, any::<u32>()).prop_map(|(about, claim, incarnation)| News {
            about,
            claim,
            incarnation,
        })
    }

    fn probe() -> impl Strategy<Value = Probe> {
        let call = prop_oneof![
            id().prop_map(|to| Call::Ping { to }),
            (prop::collection::vec(id(), 0..5), id()).prop_map(|(to, target)| Call::Request { to, target }),
            id().prop_map(|to| Call::Ack { to }),
        ];
        (call, any::<u16>(), prop::collection::vec(news(), 0..9)).prop_map(|(call, number, news)| Probe {
            call,
            number,
            news,
        })
    }

    fn encoded(probe: &Probe) -> BytesMut {
        let mut bytes = BytesMut::new();
        probe.encode(&mut bytes);
        bytes
    }

    proptest! {
        #[test]
        fn what_is_encoded_decodes_to_itself_and_leaves_nothing_over(probe in probe()) {
            let mut bytes = encoded(&probe);
            prop_assert!(Probe::begins_with(bytes[0]));
            let content = Layout::new(vec![Part::OneOf(Probe::layout())]).read(&bytes);
            prop_assert_eq!(content.left, 0, "{}", content);
            let claims = content.fields.iter().filter(|(field, _)| field.name == "claim");
            prop_assert_eq!(claims.count(), probe.news.len());
            prop_assert_eq!(Probe::decode(&mut bytes).unwrap(), probe);
            prop_assert!(bytes.is_empty());
        }

        #[test]
        fn a_payload_cut_short_is_refused(probe in probe(), cut in 1_usize..100) {
            let mut bytes = encoded(&probe);
            let kept = bytes.len().saturating_sub(cut);
            bytes.truncate(kept);
            prop_assert!(matches!(Probe::decode(&mut bytes), Err(CodecError::Truncated(n)) if n == kept));
        }

        #[test]
        fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..64)) {
            let _ = Probe::decode(&mut BytesMut::from(bytes.as_slice()));
        }
    }

    #[test]
    fn a_ping_without_news_is_five_bytes_long() {
        let probe = Probe {
            call: Call::Ping { to: ActorId(9) },
            number: 258,
            news: Vec::new(),
        };
        assert_eq!(&encoded(&probe)[..], [0x40, 9, 1, 2, 0]);
    }
}
