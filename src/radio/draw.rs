//! What keys the randomness of a reception.

use std::convert::Infallible;

use rand::TryRng;
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

/// The bits of a copy's stream after those that decide its loss. Nearly every latency takes 64 of them, which came with the
/// loss in one block of the generator.
#[derive(Debug)]
pub(super) struct LatencyBits {
    first: u64,
    drawn: u32,
    copy: FrameCopy,
    streams: KeyedStreams,
}

impl LatencyBits {
    /// Those of `copy`, of which `first` are the first, from its stream among `streams`.
    #[inline]
    pub fn new(first: u64, copy: FrameCopy, streams: KeyedStreams) -> Self {
        Self {
            first,
            drawn: 0,
            copy,
            streams,
        }
    }

    #[inline]
    fn bits(&mut self) -> u64 {
        self.drawn += 1;
        if self.drawn == 1 {
            return self.first;
        }
        let FrameCopy {
            sender,
            receiver,
            sequence,
        } = self.copy;
        later_bits(sender.0, receiver.0, sequence, self.streams, self.drawn)
    }
}

/// The `nth` word of a stream. Apart, and told all that it needs, so that what is drawn once stays in registers.
#[cold]
#[inline(never)]
fn later_bits(sender: u32, receiver: u32, sequence: u32, streams: KeyedStreams, nth: u32) -> u64 {
    streams.word([sender, receiver, sequence], nth)
}

impl TryRng for LatencyBits {
    type Error = Infallible;

    /// The low half of 64 bits; the other half goes unused.
    #[inline]
    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        Ok(self.bits() as u32)
    }

    #[inline]
    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        Ok(self.bits())
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        for chunk in bytes.chunks_mut(8) {
            chunk.copy_from_slice(&self.bits().to_le_bytes()[..chunk.len()]);
        }
        Ok(())
    }
}

/// 64 random bits as a number in [0, 1), on a grid of 2⁻⁵³: below 1, so that a probability of 1 always happens, and not
/// below 0, so that one of 0 never does.
#[inline]
pub(in crate::radio) fn unit_interval(bits: u64) -> f64 {
    (bits >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
}
