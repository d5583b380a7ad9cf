//! What robots of local trees say, as payload bytes: where they are and whom they count on. The sender's own number is in the frame's header.

use std::rc::Rc;

use bytes::{Buf, BufMut, BytesMut};
use tokio_util::codec::{Decoder, Encoder};

use crate::engine::ActorId;
use crate::geometry::Vec2;
use crate::protocol::{CodecError, Form, Layout, Meaning, Part};

/// A robot's place and its tree.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    /// Where it is, metres from the arena's centre.
    pub at: [f32; 2],
    /// Those next to it in its tree.
    pub tree: Vec<ActorId>,
}

impl Message {
    /// [`at`](Self::at) as a vector.
    #[must_use]
    pub fn place(&self) -> Vec2 {
        Vec2::new(self.at[0].into(), self.at[1].into())
    }
}

/// What a receiver gets.
pub type Heard = Rc<Message>;

/// Bytes before the tree.
const HEAD: usize = 9;

/// The place in 8 bytes, the number of links in one, two bytes for each.
#[derive(Debug, Default)]
pub struct MessageCodec;

impl Encoder<Message> for MessageCodec {
    type Error = CodecError;

    fn encode(&mut self, message: Message, bytes: &mut BytesMut) -> Result<(), CodecError> {
        message.at.iter().for_each(|coordinate| bytes.put_f32_le(*coordinate));
        bytes.put_u8(message.tree.len() as u8);
        message.tree.iter().for_each(|robot| bytes.put_u16(robot.0 as u16));
        Ok(())
    }
}

impl Decoder for MessageCodec {
    type Item = Message;
    type Error = CodecError;

    fn decode(&mut self, bytes: &mut BytesMut) -> Result<Option<Message>, CodecError> {
        if bytes.len() < HEAD {
            return Ok(None);
        }
        let length = bytes.len();
        let at = [bytes.get_f32_le(), bytes.get_f32_le()];
        let links = usize::from(bytes.get_u8());
        if bytes.len() < 2 * links {
            return Err(CodecError::Truncated(length));
        }
        let tree = (0..links).map(|_| ActorId(bytes.get_u16().into())).collect();
        Ok(Some(Message { at, tree }))
    }
}

/// How messages lie in their bytes, for those who look at frames.
#[must_use]
pub fn layout() -> Layout {
    let coordinate = |name| Part::field(name, Form::Float(4), Meaning::Number);
    Layout::new(vec![
        coordinate("x"),
        coordinate("y"),
        Part::list("number of links", vec![Part::robot("robot", 2)]),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn message() -> impl Strategy<Value = Message> {
        let at = prop::array::uniform2(-50.0..50.0_f32);
        let tree = prop::collection::vec((0_u32..65_536).prop_map(ActorId), 0..7);
        (at, tree).prop_map(|(at, tree)| Message { at, tree })
    }

    proptest! {
        #[test]
        fn what_is_encoded_decodes_to_itself_is_described_and_has_two_bytes_a_link(message in message()) {
            let mut bytes = BytesMut::new();
            MessageCodec.encode(message.clone(), &mut bytes).unwrap();
            prop_assert_eq!(bytes.len(), 9 + 2 * message.tree.len());
            prop_assert_eq!(layout().read(&bytes).left, 0);
            prop_assert_eq!(MessageCodec.decode(&mut bytes).unwrap(), Some(message));
            prop_assert!(bytes.is_empty());
        }

        #[test]
        fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..64)) {
            let _ = MessageCodec.decode(&mut BytesMut::from(bytes.as_slice()));
        }
    }
}
