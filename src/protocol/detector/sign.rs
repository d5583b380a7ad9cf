//! What messages are to a failure detector, and how they carry what it says.

use std::any::type_name;
use std::convert::Infallible;
use std::rc::Rc;

use super::swim::Probe;
use crate::protocol::TimerId;

/// The one timer that a detector sets: a protocol that runs one keeps it free.
pub const TIMER: TimerId = TimerId(0);

/// A message of a protocol whose robots run a failure detector.
pub trait Monitored: Sized {
    /// What it is to the detector.
    fn sign(&self) -> Sign<'_>;

    /// A message that carries what the detector says, on the topic [`Protocol::PROBE`](crate::protocol::Protocol::PROBE). Not to be
    /// written for messages without one: scenarios then refuse detectors that [send](super::DetectorConfig::sends).
    ///
    /// # Panics
    /// If it is not written.
    #[must_use]
    fn probe(probe: Probe) -> Self {
        let _ = probe;
        panic!(
            "{} carries nothing of a failure detector that sends messages",
            type_name::<Self>()
        )
    }
}

/// How a message carries what a detector says. Protocols that are measured for their speed have messages without that, for
/// scenarios whose detector says nothing: `Infallible` carries nothing and takes no room.
pub trait Carried: Clone + std::fmt::Debug + 'static {
    /// Carries `probe`, if that can be.
    fn of(probe: Probe) -> Option<Self>;

    /// What it carries.
    fn probe(&self) -> &Probe;
}

impl Carried for Rc<Probe> {
    fn of(probe: Probe) -> Option<Self> {
        Some(Self::new(probe))
    }

    fn probe(&self) -> &Probe {
        self
    }
}

impl Carried for Infallible {
    fn of(_: Probe) -> Option<Self> {
        None
    }

    fn probe(&self) -> &Probe {
        match *self {}
    }
}

/// What a message is to a failure detector.
#[derive(Clone, Copy, Debug)]
pub enum Sign<'a> {
    /// A status: a sign that its sender is alive, repeated as long as it is.
    Status,
    /// What another robot's detector says.
    Probe(&'a Probe),
    /// Nothing that concerns it.
    Other,
}
