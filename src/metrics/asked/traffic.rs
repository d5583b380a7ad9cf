//! What robots sent and received, by topic, over time.
//!
//! The table of traffic is summed where a window ends, so a reception costs nothing.

use crate::engine::{ActorId, SimTime};
use crate::metrics::traffic::{Flow, Traffic};
use crate::spool::{Scratch, Spool};

use super::record::TrafficEntry;
use super::windows::{Window, Windows};

/// The traffic of a run over time, as far as it has come.
#[derive(Debug)]
pub(super) struct TrafficOverTime {
    /// What the table held where the last window began that is written.
    before: Vec<Flow>,
    windows: Windows<Vec<Flow>>,
    entries: Spool<TrafficEntry>,
}

impl TrafficOverTime {
    /// Of so many cells: robots times topics.
    pub(super) fn new(cells: usize, scratch: &Scratch) -> Self {
        Self {
            before: vec![Flow::default(); cells],
            windows: Windows::new(),
            entries: Spool::new(scratch),
        }
    }

    pub(super) fn window_ends(&mut self, now: SimTime, traffic: &Traffic) {
        let before = self.windows.end(now, traffic.flows());
        if let Some(window) = before {
            write(&mut self.entries, &mut self.before, window, traffic.topics());
        }
    }

    pub(super) fn into_entries(self, end: SimTime, traffic: &Traffic) -> Spool<TrafficEntry> {
        let Self {
            mut before,
            windows,
            mut entries,
        } = self;
        // The table's sums never fall: what it holds at last is what it held, and more.
        for window in windows.finish(end, traffic.flows(), |held, more| *held = more) {
            write(&mut entries, &mut before, window, traffic.topics());
        }
        entries
    }
}

/// Writes what came into the table in a `window`, which held `before` where it began.
fn write(entries: &mut Spool<TrafficEntry>, before: &mut Vec<Flow>, window: Window<Vec<Flow>>, topics: usize) {
    let Window { since, at, state } = window;
    for (cell, (now, then)) in state.iter().zip(&*before).enumerate() {
        if now != then {
            entries.push(&TrafficEntry {
                since,
                at,
                robot: ActorId((cell / topics) as u32),
                topic: (cell % topics) as u8,
                sent_frames: now.sent_frames - then.sent_frames,
                sent_bytes: now.sent_bytes - then.sent_bytes,
                received_frames: now.received_frames - then.received_frames,
                received_bytes: now.received_bytes - then.received_bytes,
            });
        }
    }
    *before = state;
}
