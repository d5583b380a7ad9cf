//! What robots say of rumours, as payload bytes.
//!
//! | message | bytes |
//! |---|---|
//! | rumour | kind, to, number, as many bytes as the rumour is long |
//! | request | kind, to, a bit for each rumour that the sender knows, without zero bytes at the end |
//!
//! The address is two bytes, big-endian, and left out where the kind says that a message is for everyone. How long a
//! payload is the message's header says.

use bytes::{Buf, BufMut, BytesMut};
use tokio_util::codec::{Decoder, Encoder};

use crate::engine::ActorId;
use crate::protocol::{CodecError, Layout, Part};

const RUMOR: u8 = 0;
const REQUEST: u8 = 1;
/// Bit of the kind of a message that names a robot.
const ADDRESSED: u8 = 0x80;

/// A message, for one robot or for everyone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Message {
    /// A rumour.
    Rumor {
        /// The robot that it is for; `None` for everyone.
        to: Option<ActorId>,
        /// Its number, below 64.
        rumor: u8,
        /// Its length in bytes.
        size: u16,
    },
    /// Asks for the rumours that the sender does not know.
    Request {
        /// The robot that is asked; `None` for everyone.
        to: Option<ActorId>,
        /// The rumours that the sender knows, a bit each.
        known: u64,
    },
}

/// The codec of [`Message`].
#[derive(Debug, Default)]
pub struct RumorCodec;

impl Encoder<Message> for RumorCodec {
    type Error = CodecError;

    fn encode(&mut self, message: Message, bytes: &mut BytesMut) -> Result<(), CodecError> {
        match message {
            Message::Rumor { to, rumor, size } => {
                put_head(RUMOR, to, bytes);
                bytes.put_u8(rumor);
                bytes.put_bytes(rumor, size.into());
            }
            Message::Request { to, known } => {
                put_head(REQUEST, to, bytes);
                let length = (u64::BITS - known.leading_zeros()).div_ceil(8);
                bytes.put_slice(&known.to_le_bytes()[..length as usize]);
            }
        }
        Ok(())
    }
}

fn put_head(kind: u8, to: Option<ActorId>, bytes: &mut BytesMut) {
    match to {
        Some(to) => {
            bytes.put_u8(kind | ADDRESSED);
            bytes.put_u16(to.0 as u16);
        }
        None => bytes.put_u8(kind),
    }
}

/// How messages lie in their bytes, for those who look at frames.
pub fn layout() -> Layout {
    const MESSAGES: &[(u64, &str)] = &[
        (RUMOR as u64, "rumor"),
        (REQUEST as u64, "request"),
        ((RUMOR | ADDRESSED) as u64, "rumor to one"),
        ((REQUEST | ADDRESSED) as u64, "request to one"),
    ];
    let case = |kind: u8, parts: Vec<Part>| {
        let to = (kind & ADDRESSED != 0).then(|| Part::robot("to", 2));
        let head = std::iter::once(Part::named("message", MESSAGES)).chain(to);
        (kind..=kind, head.chain(parts).collect())
    };
    let rumor = || vec![Part::number("rumor", 1), Part::rest("body")];
    let request = || vec![Part::rest("known")];
    Layout::new(vec![Part::OneOf(vec![
        case(RUMOR, rumor()),
        case(RUMOR | ADDRESSED, rumor()),
        case(REQUEST, request()),
        case(REQUEST | ADDRESSED, request()),
    ])])
}

impl Decoder for RumorCodec {
    type Item = Message;
    type Error = CodecError;

    fn decode(&mut self, bytes: &mut BytesMut) -> Result<Option<Message>, CodecError> {
        if bytes.is_empty() {
            return Ok(None);
        }
        let length = bytes.len();
        let truncated = |_| CodecError::Truncated(length);
        let kind = bytes.get_u8();
        let to = if kind & ADDRESSED == 0 {
            None
        } else {
            Some(ActorId(bytes.try_get_u16().map_err(truncated)?.into()))
        };
        let unknown = |field, value| CodecError::Unknown { field, value };
        match kind & !ADDRESSED {
            RUMOR => {
                let rumor = bytes.try_get_u8().map_err(truncated)?;
                if u32::from(rumor) >= u64::BITS {
                    return Err(unknown("number of a rumour", rumor));
                }
                let size = bytes.len() as u16;
                bytes.clear();
                Ok(Some(Message::Rumor { to, rumor, size }))
            }
            REQUEST => {
                let mut known = [0; 8];
                let given = bytes.len() as u8;
                let held = known
                    .get_mut(..bytes.len())
                    .ok_or(unknown("number of rumour bytes", given))?;
                bytes.copy_to_slice(held);
                let known = u64::from_le_bytes(known);
                Ok(Some(Message::Request { to, known }))
            }
            _ => Err(unknown("message kind", kind)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn message() -> impl Strategy<Value = Message> {
        let to = || prop::option::of((0_u32..65_536).prop_map(ActorId));
        prop_oneof![
            (to(), 0_u8..64, 0_u16..2000).prop_map(|(to, rumor, size)| Message::Rumor { to, rumor, size }),
            (to(), any::<u64>(), 0_u32..64).prop_map(|(to, known, shift)| Message::Request {
                to,
                known: known >> shift
            }),
        ]
    }

    fn encoded(message: Message) -> BytesMut {
        let mut bytes = BytesMut::new();
        RumorCodec.encode(message, &mut bytes).unwrap();
        bytes
    }

    proptest! {
        #[test]
        fn what_is_encoded_decodes_to_itself_and_leaves_nothing_over(message in message()) {
            let mut bytes = encoded(message);
            prop_assert_eq!(RumorCodec.decode(&mut bytes).unwrap(), Some(message));
            prop_assert!(bytes.is_empty());
        }

        #[test]
        fn the_layout_leaves_no_byte_undescribed(message in message()) {
            prop_assert_eq!(layout().read(&encoded(message)).left, 0);
        }

        #[test]
        fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..64)) {
            let _ = RumorCodec.decode(&mut BytesMut::from(bytes.as_slice()));
        }
    }

    #[test]
    fn a_message_for_everyone_saves_the_address_and_a_request_its_zero_bytes() {
        let to = Some(ActorId(0x0102));
        let rumor = |to| Message::Rumor { to, rumor: 3, size: 2 };
        assert_eq!(&encoded(rumor(to))[..], [0x80, 1, 2, 3, 3, 3]);
        assert_eq!(&encoded(rumor(None))[..], [0, 3, 3, 3]);
        assert_eq!(&encoded(Message::Request { to, known: 0b101 })[..], [0x81, 1, 2, 5]);
        assert_eq!(&encoded(Message::Request { to: None, known: 0 })[..], [1]);
        let words = |message| layout().read(&encoded(message)).to_string();
        assert_eq!(
            words(rumor(to)),
            "message rumor to one, to 258, rumor 3, body (2 bytes)"
        );
        assert_eq!(
            words(Message::Request { to: None, known: 0b101 }),
            "message request, known (1 byte)"
        );
    }
}
