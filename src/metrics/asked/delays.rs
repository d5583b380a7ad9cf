//! How long copies took, by topic, over time.

use crate::engine::{SimTime, Span};
use crate::metrics::latency::LatencyHistogram;
use crate::protocol::Topic;
use crate::spool::{Scratch, Spool};

use super::record::DelayEntry;
use super::windows::{Window, Windows};

/// Latencies by topic.
type ByTopic = Vec<LatencyHistogram>;

/// The delays of a run, as far as it has come. Memory does not grow with the copies: a window is a histogram a topic.
#[derive(Debug)]
pub(super) struct Delays {
    present: ByTopic,
    windows: Windows<ByTopic>,
    entries: Spool<DelayEntry>,
}

impl Delays {
    pub(super) fn new(topics: usize, scratch: &Scratch) -> Self {
        Self {
            present: none(topics),
            windows: Windows::new(),
            entries: Spool::new(scratch),
        }
    }

    pub(super) fn delivered(&mut self, topic: Topic, latency: Span) {
        self.present[usize::from(topic.0)].record(latency);
    }

    pub(super) fn window_ends(&mut self, now: SimTime) {
        let next = none(self.present.len());
        let present = std::mem::replace(&mut self.present, next);
        let before = self.windows.end(now, present);
        self.entries.extend(before.iter().flat_map(entries_of));
    }

    pub(super) fn into_entries(self, end: SimTime) -> Spool<DelayEntry> {
        let mut entries = self.entries;
        let left = self.windows.finish(end, self.present, |window, more| {
            for (mine, theirs) in window.iter_mut().zip(&more) {
                mine.merge(theirs);
            }
        });
        entries.extend(left.iter().flat_map(entries_of));
        entries
    }
}

fn none(topics: usize) -> ByTopic {
    vec![LatencyHistogram::default(); topics]
}

/// The entries of a window, of the topics on which anything was delivered.
fn entries_of(window: &Window<ByTopic>) -> impl Iterator<Item = DelayEntry> {
    (0..).zip(&window.state).filter_map(|(topic, latencies)| {
        Some(DelayEntry {
            since: window.since,
            at: window.at,
            topic,
            copies: latencies.count(),
            mean_s: latencies.mean_secs()?,
            min: latencies.min()?,
            median: latencies.quantile(0.5)?,
            p95: latencies.quantile(0.95)?,
            p99: latencies.quantile(0.99)?,
            max: latencies.max()?,
        })
    })
}
