//! What a log of a run has: frames, their copies, events.

use crate::engine::{ActorId, SimTime};
use crate::faults::Effect;
use crate::protocol::{Address, Topic};
use crate::radio::{LossCause, Outcome};

/// A frame, with all that became of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// When its sender handed it to its radio.
    pub at: SimTime,
    /// Who sent it.
    pub sender: ActorId,
    /// Its number among its sender's frames, from 0.
    pub number: u32,
    /// The messages in it, one at least.
    pub messages: Vec<Message>,
    /// Their payloads, one after the other.
    pub payloads: Vec<u8>,
    /// What its sender's radio did with it, over a radio on which frames take time, unless the run ended first.
    pub sending: Option<Sending>,
    /// How many copies of its messages there were, one for each robot that one is offered to.
    pub offered: u64,
    /// How many of them arrived.
    pub delivered: u64,
    /// How many of them were lost, by [`LossCause`] in the order of their numbers.
    pub lost: [u32; LossCause::ALL.len()],
}

/// A message in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Message {
    /// Its number among its sender's messages, from 0.
    pub sequence: u32,
    /// Its topic.
    pub topic: Topic,
    /// For whom: one robot, or all in range.
    pub to: Option<ActorId>,
    /// Bytes of its payload.
    pub payload_bytes: u16,
}

/// What a radio on which frames take time did with a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sending {
    /// When it first went on air, if it did.
    pub began: Option<SimTime>,
    /// How often it was on air.
    pub attempts: u32,
    /// How it ended.
    pub outcome: Outcome,
}

impl Frame {
    /// The robot that all in it is for, if there is one.
    #[must_use]
    pub fn to(&self) -> Option<ActorId> {
        let first = self.messages.first()?.to;
        first.filter(|_| self.messages.iter().all(|message| message.to == first))
    }

    /// Its messages, each with its payload.
    pub fn contents(&self) -> impl Iterator<Item = (&Message, &[u8])> {
        let mut begin = 0;
        self.messages.iter().map(move |message| {
            let payload = &self.payloads[begin..begin + usize::from(message.payload_bytes)];
            begin += payload.len();
            (message, payload)
        })
    }

    /// How many of its copies were lost.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost.iter().map(|&copies| u64::from(copies)).sum()
    }
}

/// A copy of a message, with what became of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CopyRecord {
    /// The message at this receiver.
    pub copy: super::super::Copy,
    /// The number of its frame among its sender's.
    pub frame: u32,
    /// What became of it.
    pub fate: Fate,
    /// When it arrived, was to arrive, or was lost; `None` if the run ended before anybody knew.
    pub at: Option<SimTime>,
    /// When its receiver read it, if it did.
    pub read: Option<SimTime>,
    /// The power with which it arrived, dBm, over a radio that knows powers.
    pub power: Option<f32>,
    /// How far its sender was away, metres, over such a radio.
    pub distance: Option<f32>,
}

/// What became of a copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// It arrived.
    Delivered,
    /// It was lost.
    Lost(LossCause),
    /// It is under way at the end.
    InFlight,
    /// It arrived at a robot that counted as out of range, and was offered to nobody.
    Strayed,
}

impl Fate {
    /// What tables call it; a loss has its cause beside.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Delivered => "delivered",
            Self::Lost(_) => "lost",
            Self::InFlight => "in_flight",
            Self::Strayed => "strayed",
        }
    }

    /// Why it was lost, if it was.
    #[must_use]
    pub const fn cause(self) -> Option<LossCause> {
        match self {
            Self::Lost(cause) => Some(cause),
            Self::Delivered | Self::InFlight | Self::Strayed => None,
        }
    }
}

/// What tables call an address.
#[must_use]
pub const fn address_name(address: Address) -> &'static str {
    match address {
        Address::Everyone => "everyone",
        Address::Me => "me",
        Address::Another => "another",
    }
}

/// Something that happened.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// When.
    pub at: SimTime,
    /// To whom, or who did it; `None` for what befalls links.
    pub robot: Option<ActorId>,
    /// What.
    pub what: What,
}

/// What happened.
#[derive(Clone, Debug, PartialEq)]
pub enum What {
    /// The robot fails.
    Fails(Effect),
    /// This does not ail it any longer.
    Recovers(Effect),
    /// Links begin to fail: a partition or a burst.
    LinksFail(&'static str),
    /// Links are well again.
    LinksRecover(&'static str),
    /// It watches this robot from now on.
    Watches(ActorId),
    /// It believes this robot to be down, last heard then.
    Suspects(ActorId, SimTime),
    /// It believes that no longer.
    Trusts(ActorId),
    /// It has this role from now on.
    Enters(u8),
    /// It works for this target, or for none.
    Serves(Option<u16>),
    /// It relies on these.
    ReliesOn(Vec<ActorId>),
    /// It knows this rumour, from this robot if it has not begun it.
    Learns(u16, Option<ActorId>),
    /// It counted so many more of something.
    Counts(&'static str, u64),
    /// It measured something.
    Measures(&'static str, f64),
}

impl What {
    /// What tables call it.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Fails(_) => "fails",
            Self::Recovers(_) => "recovers",
            Self::LinksFail(_) => "links_fail",
            Self::LinksRecover(_) => "links_recover",
            Self::Watches(_) => "watches",
            Self::Suspects(..) => "suspects",
            Self::Trusts(_) => "trusts",
            Self::Enters(_) => "enters",
            Self::Serves(_) => "serves",
            Self::ReliesOn(_) => "relies_on",
            Self::Learns(..) => "learns",
            Self::Counts(..) => "counts",
            Self::Measures(..) => "measures",
        }
    }

    /// The other robot that it is about, if there is one.
    #[must_use]
    pub const fn about(&self) -> Option<ActorId> {
        match self {
            Self::Watches(other) | Self::Suspects(other, _) | Self::Trusts(other) | Self::Learns(_, Some(other)) => {
                Some(*other)
            }
            _ => None,
        }
    }
}
