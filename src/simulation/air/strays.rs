//! Frames that robots may get though they count as out of range: which of those in their inboxes are.
//!
//! Hardly any frame is, and over a disk none: so it is written down beside the inboxes and not in every frame.

use crate::engine::ActorId;
use crate::radio::FrameId;

/// Those in the inbox of each robot. No rows before the first.
#[derive(Default)]
pub(super) struct Strays(Vec<Vec<FrameId>>);

impl Strays {
    /// `frame` is in the inbox of `receiver`, one of so many robots.
    pub fn add(&mut self, receiver: ActorId, frame: FrameId, robots: usize) {
        if self.0.is_empty() {
            self.0.resize(robots, Vec::new());
        }
        self.0[receiver.index()].push(frame);
    }

    /// Those of `receiver`.
    #[inline]
    pub fn of(&self, receiver: ActorId) -> &[FrameId] {
        self.0.get(receiver.index()).map_or(&[], Vec::as_slice)
    }

    /// Whether a message in the inbox of `receiver` is of one.
    #[inline]
    pub fn has(&self, receiver: ActorId, sender: ActorId, sequence: u32) -> bool {
        self.of(receiver).iter().any(|frame| frame.holds(sender, sequence))
    }

    /// `frame` is no longer in the inbox of `receiver`: whether it was one.
    pub fn remove(&mut self, receiver: ActorId, frame: FrameId) -> bool {
        let Some(frames) = self.0.get_mut(receiver.index()) else {
            return false;
        };
        let place = frames.iter().position(|stray| stray.holds(frame.sender, frame.first()));
        place.map(|place| frames.swap_remove(place)).is_some()
    }

    /// A message is no longer in the inbox of `receiver`, nor is another of its frame.
    pub fn forget(&mut self, receiver: ActorId, sender: ActorId, sequence: u32) {
        if let Some(frames) = self.0.get_mut(receiver.index()) {
            frames.retain(|frame| !frame.holds(sender, sequence));
        }
    }
}
