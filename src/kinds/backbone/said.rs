//! What a robot last said, so that it repeats what is due and no more.

use super::message::{Message, Order, Status};
use super::mission::Parameters;
use crate::engine::ActorId;
use crate::protocol::control::Rhythm;
use crate::protocol::gossip::Repeat;

/// What the robot last said, topic by topic, and what it passes on.
#[derive(Debug)]
pub struct Said {
    pub status: Repeat<Status>,
    pub strands: Repeat<Vec<Message>>,
    /// The order that it passes on, and how often it has.
    pub order: (Order, u64),
}

impl Said {
    /// Nothing yet.
    pub fn nothing(robot: ActorId, parameters: &Parameters) -> Self {
        let Parameters {
            status_repetition,
            strand_repetition,
            phases,
            ..
        } = *parameters;
        Self {
            status: Repeat::new(status_repetition, Rhythm::StatusRefresh, phases, robot),
            strands: Repeat::new(strand_repetition, Rhythm::StrandRefresh, phases, robot),
            order: Default::default(),
        }
    }

    /// Whether `order` is to be passed on once more, of at most `limit` times.
    pub fn passes_on(&mut self, order: Order, limit: u64) -> bool {
        if self.order.0 != order {
            self.order = (order, 0);
        }
        self.order.1 += 1;
        self.order.1 <= limit
    }
}
