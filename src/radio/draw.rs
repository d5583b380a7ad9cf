//! What keys the randomness of a reception.

use rand_philox::{Philox, u32_to_unit_f64};

use crate::engine::{ActorId, KeyedStreams, Purpose};

/// The stream of a copy through the channel: its first 64 bits decide its loss, whether or not the model can lose it,
/// and what follows makes its latency.
pub(super) const CHANNEL: Purpose = Purpose::new("radio.channel");

/// One copy of a frame, on its way from its sender to one listener.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameCopy {
    /// Who transmits.
    pub sender: ActorId,
    /// Who listens.
    pub receiver: ActorId,
    /// Number of the frame among its sender's.
    pub sequence: u32,
}

impl FrameCopy {
    /// This copy's own stream among `streams`, those of one purpose.
    #[inline]
    pub fn stream(self, streams: KeyedStreams) -> Philox {
        streams.at(self.sender.0, self.receiver.0, self.sequence)
    }

    /// Whether something of this `probability` happens to this copy.
    ///
    /// One uniform decides, the same whatever the probability, so that what happens at 0.1 also happens at 0.3.
    /// What never or always happens draws nothing.
    #[inline]
    pub fn happens(self, probability: f64, streams: KeyedStreams) -> bool {
        if probability <= 0.0 {
            return false;
        }
        probability >= 1.0 || u32_to_unit_f64(self.stream(streams).next_u32()) < probability
    }
}
