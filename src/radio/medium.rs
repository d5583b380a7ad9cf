//! The shared medium.

use super::config::RadioConfig;
use super::draw::FrameCopy;
use super::latency::Latency;
use super::loss::Loss;
use super::sensing::Sensing;
use super::{Fate, Listener, LossCause};
use crate::engine::{ActorId, SimTime, Streams};

/// The radio of one run: settles the fate of every copy of every frame.
#[derive(Debug)]
pub struct Medium {
    range: f64,
    /// For each robot the number of its next frame.
    sequences: Vec<u32>,
    loss: Loss,
    latency: Latency,
    sensing: Sensing,
}

impl Medium {
    /// The radio that `config` describes, for robots 0 to `robots` − 1, drawing from the `streams` of their trial.
    ///
    /// # Panics
    /// If `config` has [`problems`](RadioConfig::problems): a scenario is checked before it is run.
    #[must_use]
    pub fn new(config: &RadioConfig, streams: &Streams, robots: usize) -> Self {
        let problems = config.problems();
        assert!(
            problems.is_empty(),
            "the radio's configuration is unusable: {problems:?}"
        );
        let range = config.range.get();
        Self {
            range,
            sequences: vec![0; robots],
            loss: Loss::new(&config.loss, range, streams, robots),
            latency: Latency::new(&config.latency, streams),
            sensing: Sensing::new(&config.sensing, streams),
        }
    }

    /// Communication range in metres: a robot at exactly this distance still listens (paper section 3.1).
    #[must_use]
    pub fn range(&self) -> f64 {
        self.range
    }

    /// The number that the next frame of `sender` will have.
    ///
    /// # Panics
    /// If `sender` is not one of the medium's robots.
    #[must_use]
    pub fn upcoming(&self, sender: ActorId) -> u32 {
        self.sequences[sender.index()]
    }

    /// Transmits the next frame of `sender` at `now`, and returns the frame's number among that sender's, from 0.
    ///
    /// `listeners` are the other robots within [`range`](Self::range) at that instant. `receive` is called once for
    /// each, in their order, with what becomes of its copy. An arrival is never before `now`; copies of successive
    /// frames may arrive in another order than they were sent.
    ///
    /// # Panics
    /// If `sender` is not one of the medium's robots.
    pub fn transmit(
        &mut self,
        now: SimTime,
        sender: ActorId,
        listeners: impl IntoIterator<Item = Listener>,
        mut receive: impl FnMut(ActorId, Fate),
    ) -> u32 {
        let sequence = self.next_sequence(sender);
        for listener in listeners {
            let copy = FrameCopy {
                sender,
                receiver: listener.id,
                sequence,
            };
            receive(listener.id, self.fate(now, copy, listener));
        }
        sequence
    }

    fn next_sequence(&mut self, sender: ActorId) -> u32 {
        let next = &mut self.sequences[sender.index()];
        let sequence = *next;
        *next = sequence.wrapping_add(1);
        sequence
    }

    #[inline]
    fn fate(&mut self, now: SimTime, copy: FrameCopy, listener: Listener) -> Fate {
        if self.loss.drops(copy, listener.sender.norm_squared()) {
            return Fate::Lost(LossCause::Channel);
        }
        Fate::Arrives {
            at: now + self.latency.of(copy),
            displacement: self.sensing.displacement(copy, listener.sender),
        }
    }
}
