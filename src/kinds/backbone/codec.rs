//! Messages as payload bytes.
//!
//! | message | bytes |
//! |---|---|
//! | status | role, previous role, parent need, target chain |
//! | join, adopt | kind, to, sequence, chain |
//! | work | kind, to, sequence, target |
//! | replace | kind, to, child, sequence, chain, number of robots beyond |
//! | accept, refuse | kind, to, sequence |
//! | release | kind, to |
//! | order | kind, epoch, number of bytes, a bit for each target, set if it is dismantled |
//! | order with a reserve | kind, relays in reserve, and on as an order |
//! | bid | kind, robot, term, distance in two bytes, big-endian |
//! | strand | kind, chain, next, number of robots, robots |
//! | probe | as the detector has it |
//!
//! The first byte tells messages apart: 0 to 3 is a status, which begins with its role. A robot's id is one byte if all
//! ids in the message are below 256, else two, big-endian, and then the kind's top bit is set. The bit below begins a probe.

use bytes::{Buf, BufMut, BytesMut};
use tokio_util::codec::{Decoder, Encoder};

use crate::engine::ActorId;
use crate::protocol::CodecError;
use crate::protocol::detector::{Monitored as _, Probe};

use super::message::{Bid, Message, Order, Request, Role, Status, Strand, TargetSet};

pub(super) const JOIN: u8 = 0x10;
pub(super) const ACCEPT: u8 = 0x11;
pub(super) const REFUSE: u8 = 0x12;
pub(super) const RELEASE: u8 = 0x13;
pub(super) const ORDER: u8 = 0x14;
pub(super) const ADOPT: u8 = 0x15;
pub(super) const WORK: u8 = 0x16;
pub(super) const REPLACE: u8 = 0x17;
pub(super) const ORDER_WITH_RESERVE: u8 = 0x18;
pub(super) const BID: u8 = 0x19;
pub(super) const PARENT_STRAND: u8 = 0x20;
pub(super) const CHILD_STRAND: u8 = 0x21;
pub(super) const WIDE_IDS: u8 = 0x80;

/// The codec of [`Message`].
#[derive(Debug, Default)]
pub struct BackboneCodec;

impl Encoder<Message> for BackboneCodec {
    type Error = CodecError;

    fn encode(&mut self, message: Message, bytes: &mut BytesMut) -> Result<(), CodecError> {
        match message {
            Message::Status(status) => put_status(status, bytes),
            Message::Request(request) => put_request(request, bytes),
            Message::ParentStrand(strand) => put_strand(PARENT_STRAND, &strand, bytes),
            Message::ChildStrand(strand) => put_strand(CHILD_STRAND, &strand, bytes),
            Message::Probe(probe) => probe.encode(bytes),
        }
        Ok(())
    }
}

fn put_status(status: Status, bytes: &mut BytesMut) {
    bytes.put_slice(&[
        status.role as u8,
        status.previous as u8,
        u8::from(status.need),
        status.chain,
    ]);
}

fn put_request(request: Request, bytes: &mut BytesMut) {
    match request {
        Request::Join { to, sequence, chain } => {
            put_addressed(JOIN, to, bytes);
            bytes.put_slice(&[sequence, chain]);
        }
        Request::Adopt { to, sequence, chain } => {
            put_addressed(ADOPT, to, bytes);
            bytes.put_slice(&[sequence, chain]);
        }
        Request::Work { to, sequence, target } => {
            put_addressed(WORK, to, bytes);
            bytes.put_slice(&[sequence, target]);
        }
        Request::Replace {
            to,
            sequence,
            chain,
            child,
            beyond,
        } => {
            let wide = is_wide(to) || is_wide(child);
            bytes.put_u8(if wide { REPLACE | WIDE_IDS } else { REPLACE });
            put_id(to, wide, bytes);
            put_id(child, wide, bytes);
            bytes.put_slice(&[sequence, chain, beyond]);
        }
        Request::Accept { to, sequence } => {
            put_addressed(ACCEPT, to, bytes);
            bytes.put_u8(sequence);
        }
        Request::Refuse { to, sequence } => {
            put_addressed(REFUSE, to, bytes);
            bytes.put_u8(sequence);
        }
        Request::Release { to } => put_addressed(RELEASE, to, bytes),
        Request::Bid(Bid { term, distance, robot }) => {
            put_addressed(BID, robot, bytes);
            bytes.put_u8(term);
            bytes.put_u16(distance);
        }
        Request::Order(order) => {
            let dismantled = order.dismantled.bytes();
            match order.reserve {
                0 => bytes.put_u8(ORDER),
                reserve => bytes.put_slice(&[ORDER_WITH_RESERVE, reserve]),
            }
            bytes.put_slice(&[order.epoch, dismantled.len() as u8]);
            bytes.put_slice(dismantled);
        }
    }
}

fn put_addressed(kind: u8, to: ActorId, bytes: &mut BytesMut) {
    let wide = is_wide(to);
    bytes.put_u8(if wide { kind | WIDE_IDS } else { kind });
    put_id(to, wide, bytes);
}

fn put_strand(kind: u8, strand: &Strand, bytes: &mut BytesMut) {
    let wide = is_wide(strand.next) || strand.robots.iter().copied().any(is_wide);
    bytes.put_u8(if wide { kind | WIDE_IDS } else { kind });
    bytes.put_u8(strand.chain);
    put_id(strand.next, wide, bytes);
    bytes.put_u8(strand.robots.len() as u8);
    for &robot in &*strand.robots {
        put_id(robot, wide, bytes);
    }
}

const fn is_wide(id: ActorId) -> bool {
    id.0 > 0xff
}

fn put_id(id: ActorId, wide: bool, bytes: &mut BytesMut) {
    if wide {
        bytes.put_u16(id.0 as u16);
    } else {
        bytes.put_u8(id.0 as u8);
    }
}

impl Decoder for BackboneCodec {
    type Item = Message;
    type Error = CodecError;

    fn decode(&mut self, bytes: &mut BytesMut) -> Result<Option<Message>, CodecError> {
        let Some(first) = bytes.first() else {
            return Ok(None);
        };
        if Probe::begins_with(*first) {
            return Probe::decode(bytes).map(|probe| Some(Message::probe(probe)));
        }
        let length = bytes.len();
        let mut reader = Reader { bytes, length };
        let first = reader.byte()?;
        if let Some(role) = Role::ALL.get(usize::from(first)) {
            return reader.status(*role).map(Some);
        }
        let wide = first & WIDE_IDS != 0;
        let message = match first & !WIDE_IDS {
            JOIN => Message::Request(Request::Join {
                to: reader.id(wide)?,
                sequence: reader.byte()?,
                chain: reader.byte()?,
            }),
            ADOPT => Message::Request(Request::Adopt {
                to: reader.id(wide)?,
                sequence: reader.byte()?,
                chain: reader.byte()?,
            }),
            WORK => Message::Request(Request::Work {
                to: reader.id(wide)?,
                sequence: reader.byte()?,
                target: reader.byte()?,
            }),
            REPLACE => Message::Request(Request::Replace {
                to: reader.id(wide)?,
                child: reader.id(wide)?,
                sequence: reader.byte()?,
                chain: reader.byte()?,
                beyond: reader.byte()?,
            }),
            ACCEPT => Message::Request(Request::Accept {
                to: reader.id(wide)?,
                sequence: reader.byte()?,
            }),
            REFUSE => Message::Request(Request::Refuse {
                to: reader.id(wide)?,
                sequence: reader.byte()?,
            }),
            RELEASE => Message::Request(Request::Release { to: reader.id(wide)? }),
            kind @ (ORDER | ORDER_WITH_RESERVE) => Message::Request(Request::Order(Order {
                reserve: if kind == ORDER { 0 } else { reader.byte()? },
                epoch: reader.byte()?,
                dismantled: reader.targets()?,
            })),
            BID => Message::Request(Request::Bid(Bid {
                robot: reader.id(wide)?,
                term: reader.byte()?,
                distance: u16::from_be_bytes([reader.byte()?, reader.byte()?]),
            })),
            PARENT_STRAND => Message::ParentStrand(reader.strand(wide)?),
            CHILD_STRAND => Message::ChildStrand(reader.strand(wide)?),
            _ => {
                return Err(CodecError::Unknown {
                    field: "message kind",
                    value: first,
                });
            }
        };
        Ok(Some(message))
    }
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

    fn id(&mut self, wide: bool) -> Result<ActorId, CodecError> {
        let id = if wide {
            let wide = self.bytes.try_get_u16();
            wide.map_err(|_| CodecError::Truncated(self.length))?.into()
        } else {
            self.byte()?.into()
        };
        Ok(ActorId(id))
    }

    fn status(&mut self, role: Role) -> Result<Message, CodecError> {
        let previous = self.byte()?;
        let unknown = |field, value| CodecError::Unknown { field, value };
        let previous = *Role::ALL
            .get(usize::from(previous))
            .ok_or(unknown("previous role", previous))?;
        let need = match self.byte()? {
            0 => false,
            1 => true,
            other => return Err(unknown("parent need", other)),
        };
        let chain = self.byte()?;
        Ok(Message::Status(Status {
            role,
            previous,
            need,
            chain,
        }))
    }

    fn targets(&mut self) -> Result<TargetSet, CodecError> {
        let length = self.byte()?;
        let too_many = CodecError::Unknown {
            field: "number of target bytes",
            value: length,
        };
        let mut bytes = [0; TargetSet::BYTES];
        let bytes = bytes.get_mut(..length.into()).ok_or(too_many)?;
        for byte in &mut *bytes {
            *byte = self.byte()?;
        }
        Ok(TargetSet::from_bytes(bytes).unwrap_or_default())
    }

    fn strand(&mut self, wide: bool) -> Result<Strand, CodecError> {
        let chain = self.byte()?;
        let next = self.id(wide)?;
        let robots = self.byte()?;
        // The capacity is bounded by what is there, not by what the payload claims.
        let mut strand = Vec::with_capacity(usize::from(robots).min(self.bytes.len()));
        for _ in 0..robots {
            strand.push(self.id(wide)?);
        }
        Ok(Strand {
            chain,
            next,
            robots: strand.into(),
        })
    }
}

#[cfg(test)]
mod tests;
