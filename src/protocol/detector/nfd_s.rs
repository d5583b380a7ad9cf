//! NFD-S, the new failure detector with synchronised clocks (Chen, Toueg and Aguilera, *On the quality of service of failure
//! detectors*, IEEE Transactions on Computers 51(5), 2002, figure 6).
//!
//! A status sent at σ has its freshness point at σ + δ, and the next one, sent an interval η later, has its own at σ + η + δ.
//! Between the two a robot is trusted if that status or a newer one has arrived. So it is suspected from σ + η + δ on, where σ
//! is the latest time of sending among the statuses that arrived, whenever they did. The clocks of all robots agree here, as
//! the simulator's do; on real robots the error of their synchronisation adds to the latency.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::watch::{Row, Rule};
use crate::engine::{SimTime, Span};
use crate::protocol::Reception;
use crate::quantity::Positive;

/// Settings of NFD-S.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct NfdSConfig {
    /// δ, the freshness shift, seconds: a robot is suspected this long after the first status that is missing should have
    /// been sent. A failure is detected at most δ and one status interval after it. Must be longer than the radio's latency,
    /// else every status comes too late; recommended: several status intervals more, for each loss in a row takes one.
    pub shift: Positive,
}

impl Default for NfdSConfig {
    fn default() -> Self {
        Self {
            shift: Positive::new(3.0),
        }
    }
}

impl NfdSConfig {
    /// From the sending of the last status that arrives to the suspicion.
    pub(super) fn silence(&self, status_interval: Span) -> Span {
        status_interval + Span::from_secs(self.shift.get())
    }
}

/// The rule of NFD-S.
#[derive(Debug)]
pub struct NfdS {
    /// η + δ.
    pub silence: Span,
}

impl Rule for NfdS {
    /// When the newest status that arrived was sent.
    type State = SimTime;

    fn first<M>(&self, status: &Reception<M>) -> SimTime {
        status.frame.sent_at
    }

    fn next<M>(&self, row: &mut Row<SimTime>, status: &Reception<M>) {
        row.state = row.state.max(status.frame.sent_at);
    }

    fn due(&self, row: &Row<SimTime>) -> SimTime {
        row.state + self.silence
    }
}
