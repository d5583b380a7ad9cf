//! What codecs may complain of, and a codec for protocols that do not write their own.

use std::marker::PhantomData;

use bytes::{Buf, BufMut, BytesMut};
use serde::Serialize;
use serde::de::DeserializeOwned;
use tokio_util::codec::{Decoder, Encoder};

/// Payload bytes that are no message of the protocol.
#[derive(Debug, thiserror::Error)]
pub enum CodecError {
    /// The bytes end before the message does.
    #[error("payload ends after {0} bytes, in the middle of a message")]
    Truncated(usize),
    /// A byte has a value that its field does not know.
    #[error("{field} cannot be {value}")]
    Unknown {
        /// The field's name.
        field: &'static str,
        /// The byte found.
        value: u8,
    },
    /// The bytes do not make sense to [`Serialised`], or it cannot write the message.
    #[error("no message as postcard writes it: {0}")]
    Serialised(#[from] postcard::Error),
    /// Required by the codec traits; reading memory does not fail.
    #[error(transparent)]
    Io(#[from] std::io::Error),
}

/// Writes and reads any message that serde does, in the format of postcard: no field names, whole numbers of seven bits a byte,
/// so that a small number costs one; `u8`, `f32` and `f64` as they are. `type Codec = Serialised<Message>` is all that a protocol says.
///
/// ```
/// use bytes::BytesMut;
/// use desim::protocol::Serialised;
/// use tokio_util::codec::Encoder as _;
///
/// #[derive(serde::Serialize, serde::Deserialize)]
/// enum Message {
///     Beacon { hops: u32, at: (f32, f32) },
///     Bye,
/// }
///
/// let bytes = |message| {
///     let mut bytes = BytesMut::new();
///     Serialised::default().encode(message, &mut bytes).map(|()| bytes.len())
/// };
/// assert_eq!(bytes(Message::Beacon { hops: 3, at: (0.5, -2.0) })?, 1 + 1 + 8);
/// assert_eq!(bytes(Message::Bye)?, 1);
/// # Ok::<(), desim::protocol::CodecError>(())
/// ```
///
/// A message of which the wire format is part of the question has a codec of its own, of the traits of tokio-util: bytes by hand may be
/// fewer. Here a direction in one byte, to 1.4 degrees; all bytes that are there belong to one message:
///
/// ```
/// use bytes::{Buf as _, BufMut as _, BytesMut};
/// use desim::protocol::CodecError;
/// use tokio_util::codec::{Decoder, Encoder};
///
/// #[derive(Default)]
/// struct InOneByte;
///
/// impl Encoder<f64> for InOneByte {
///     type Error = CodecError;
///
///     fn encode(&mut self, degrees: f64, bytes: &mut BytesMut) -> Result<(), CodecError> {
///         bytes.put_u8((degrees / 360.0 * 256.0).round() as u8);
///         Ok(())
///     }
/// }
///
/// impl Decoder for InOneByte {
///     type Item = f64;
///     type Error = CodecError;
///
///     fn decode(&mut self, bytes: &mut BytesMut) -> Result<Option<f64>, CodecError> {
///         let byte = bytes.try_get_u8().map_err(|_| CodecError::Truncated(bytes.len()))?;
///         Ok(Some(f64::from(byte) / 256.0 * 360.0))
///     }
/// }
///
/// let mut bytes = BytesMut::new();
/// InOneByte.encode(90.3, &mut bytes)?;
/// assert_eq!((bytes.len(), InOneByte.decode(&mut bytes)?), (1, Some(90.0)));
/// # Ok::<(), CodecError>(())
/// ```
///
/// # Errors
/// Of the encoder: a message that postcard cannot write, such as a list whose length is not known. Of the decoder: bytes that end within a
/// message, or that are none.
#[derive(Debug)]
pub struct Serialised<M>(PhantomData<fn(M) -> M>);

impl<M> Default for Serialised<M> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

impl<M: Serialize> Encoder<M> for Serialised<M> {
    type Error = CodecError;

    fn encode(&mut self, message: M, bytes: &mut BytesMut) -> Result<(), CodecError> {
        let mut writer = std::mem::take(bytes).writer();
        let written = postcard::to_io(&message, &mut writer).map(|_| ());
        *bytes = writer.into_inner();
        Ok(written?)
    }
}

impl<M: DeserializeOwned> Decoder for Serialised<M> {
    type Item = M;
    type Error = CodecError;

    fn decode(&mut self, bytes: &mut BytesMut) -> Result<Option<M>, CodecError> {
        let length = bytes.len();
        let (message, rest) = postcard::take_from_bytes(bytes).map_err(|error| match error {
            postcard::Error::DeserializeUnexpectedEnd => CodecError::Truncated(length),
            other => CodecError::Serialised(other),
        })?;
        let read = length - rest.len();
        bytes.advance(read);
        Ok(Some(message))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use serde::Deserialize;

    use super::*;

    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    enum Message {
        Beacon { hops: u8, at: (f32, f32) },
        Names(Vec<String>),
        Nothing,
    }

    fn messages() -> impl Strategy<Value = Message> {
        prop_oneof![
            (any::<u8>(), -1e9_f32..1e9, -1e9_f32..1e9).prop_map(|(hops, x, y)| Message::Beacon { hops, at: (x, y) }),
            prop::collection::vec(".{0,9}", 0..4).prop_map(Message::Names),
            Just(Message::Nothing),
        ]
    }

    fn encoded(message: &Message) -> BytesMut {
        let mut bytes = BytesMut::new();
        Serialised::default()
            .encode(message.clone(), &mut bytes)
            .expect("it can be written");
        bytes
    }

    proptest! {
        #[test]
        fn a_message_comes_back_and_leaves_nothing(message in messages()) {
            let mut bytes = encoded(&message);
            prop_assert_eq!(Serialised::default().decode(&mut bytes).unwrap(), Some(message));
            prop_assert!(bytes.is_empty());
        }

        #[test]
        fn bytes_that_end_too_early_are_an_error(message in messages(), cut in any::<prop::sample::Index>()) {
            let mut bytes = encoded(&message);
            let kept = cut.index(bytes.len());
            bytes.truncate(kept);
            let read = Serialised::<Message>::default().decode(&mut bytes);
            prop_assert!(matches!(read, Err(CodecError::Truncated(length)) if length == kept), "{:?}", read);
        }

        #[test]
        fn bytes_beyond_the_message_are_left(message in messages(), more in prop::collection::vec(any::<u8>(), 1..5)) {
            let mut bytes = encoded(&message);
            bytes.extend_from_slice(&more);
            prop_assert_eq!(Serialised::default().decode(&mut bytes).unwrap(), Some(message));
            prop_assert_eq!(&bytes[..], &more[..]);
        }
    }

    #[test]
    fn the_bytes_are_those_of_the_format() {
        let beacon = Message::Beacon {
            hops: 200,
            at: (1.0, -2.0),
        };
        assert_eq!(encoded(&beacon)[..], [0, 200, 0, 0, 0x80, 0x3f, 0, 0, 0, 0xc0]);
        assert_eq!(encoded(&Message::Names(vec!["ab".into()]))[..], [1, 1, 2, b'a', b'b']);
        assert_eq!(encoded(&Message::Nothing)[..], [2]);
    }

    #[test]
    fn a_variant_that_does_not_exist_is_an_error() {
        let read = Serialised::<Message>::default().decode(&mut BytesMut::from(&[9][..]));
        assert!(matches!(read, Err(CodecError::Serialised(_))), "{read:?}");
    }
}
