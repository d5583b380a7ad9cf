//! From what a robot says to the bytes of a frame, and to what its receivers make of them.

use std::any::type_name;

use tokio_util::codec::{Decoder, Encoder};

use super::{Air, Numbers, Spoken};
use crate::engine::{ActorId, SimTime};
use crate::happenings::{Observer, Sent};
use crate::protocol::{Address, CodecError, Frame, MessageSize, Protocol, Topic};
use crate::simulation::error::RunError;

impl<P: Protocol> Air<P> {
    /// The bytes of `message`, and what its receivers make of them.
    #[inline]
    pub(super) fn encode(
        &mut self,
        now: SimTime,
        sender: ActorId,
        to: Option<ActorId>,
        message: P::Message,
        observer: &mut impl Observer,
    ) -> Result<Spoken<P::Heard>, RunError> {
        let topic = P::topic(&message);
        self.payload.clear();
        let encoded = self.codec.encode(message, &mut self.payload);
        let bytes = self.payload.len();
        encoded.map_err(|source| codec_error::<P>(topic, bytes, source))?;
        let size = MessageSize {
            payload_bytes: u16::try_from(bytes).map_err(|_| RunError::TooLong {
                protocol: type_name::<P>(),
                topic: topic_name::<P>(topic),
                bytes,
            })?,
            rides: !self.aboard.is_empty(),
        };
        if let Some(to) = to {
            self.check_addressee(sender, to, topic)?;
        }
        let sequence = Numbers::next(&mut self.numbers[sender.index()].message);
        observer.sent(&Sent {
            at: now,
            sender,
            to,
            topic,
            size,
            sequence,
            copies: self.copies(to),
            overheard: P::OVERHEARS,
            payload: &self.payload,
        });
        // Every receiver gets the same bytes, so they are decoded once for all.
        let message = self.decode(topic)?;
        let frame = Frame {
            sender,
            sequence,
            sent_at: now,
            payload_bytes: size.payload_bytes,
            rides: size.rides,
            address: Address::Everyone,
            message: message.into(),
        };
        Ok(Spoken { frame, to })
    }

    /// How many robots a message to `to`, or to everyone, is offered to: its addressee, in range or not, and whoever else hears it.
    fn copies(&self, to: Option<ActorId>) -> u64 {
        let in_range = self.listeners.len() as u64;
        match to {
            None => in_range,
            Some(to) if P::OVERHEARS => in_range + u64::from(!self.is_in_range(to)),
            Some(_) => 1,
        }
    }

    pub(super) fn is_in_range(&self, robot: ActorId) -> bool {
        self.listeners.iter().any(|listener| listener.id == robot)
    }

    /// Whether `sender` may send to `to`: another robot of the swarm.
    fn check_addressee(&self, sender: ActorId, to: ActorId, topic: Topic) -> Result<(), RunError> {
        let robots = self.inboxes.len();
        if to == sender || to.index() >= robots {
            return Err(RunError::Addressee {
                protocol: type_name::<P>(),
                topic: topic_name::<P>(topic),
                sender,
                to,
                last: robots - 1,
            });
        }
        Ok(())
    }

    /// What receivers make of the payload of a message on `topic`.
    fn decode(&mut self, topic: Topic) -> Result<P::Message, RunError> {
        let bytes = self.payload.len();
        let (protocol, name) = (type_name::<P>(), topic_name::<P>);
        let decoded = self.codec.decode(&mut self.payload);
        let decoded = decoded.map_err(|source| codec_error::<P>(topic, bytes, source))?;
        let message = decoded.ok_or(RunError::Undecodable {
            protocol,
            topic: name(topic),
            bytes,
        })?;
        let read = P::topic(&message);
        if read != topic {
            return Err(RunError::OtherTopic {
                protocol,
                topic: name(topic),
                bytes,
                read: name(read),
            });
        }
        if !self.payload.is_empty() {
            return Err(RunError::Unread {
                protocol,
                topic: name(topic),
                bytes,
                read: bytes - self.payload.len(),
            });
        }
        Ok(message)
    }
}

/// What the protocol calls `topic`.
fn topic_name<P: Protocol>(topic: Topic) -> &'static str {
    P::TOPICS.get(usize::from(topic.0)).unwrap_or(&"that it does not name")
}

fn codec_error<P: Protocol>(topic: Topic, bytes: usize, source: CodecError) -> RunError {
    RunError::Codec {
        protocol: type_name::<P>(),
        topic: topic_name::<P>(topic),
        bytes,
        source,
    }
}
