//! Traffic over time: what robots sent and received from one sample to the next.
//!
//! The table of traffic is summed at samples alone, so the series costs a reception nothing.

use crate::engine::SimTime;
use crate::spool::{Scratch, Spool};

use super::record::{RobotBytes, SeriesEntry};
use super::traffic::{RobotTraffic, Traffic};

/// The series of one run, as far as it has come.
#[derive(Debug)]
pub(super) struct Series {
    /// Samples from one entry to the next; 0 for no series.
    every: u32,
    /// Samples still to skip.
    skipped: u32,
    /// What the table held at the last entry, or at the first sample, from which the series starts.
    last: Option<(SimTime, Vec<RobotTraffic>)>,
    entries: Spool<SeriesEntry>,
}

impl Series {
    pub(super) fn new(every: u32, scratch: &Scratch) -> Self {
        Self {
            every,
            skipped: 0,
            last: None,
            entries: Spool::new(scratch),
        }
    }

    /// Samples `traffic`; whether an entry ends here.
    pub(super) fn sample(&mut self, now: SimTime, traffic: &Traffic) -> bool {
        if self.every == 0 {
            return false;
        }
        if self.skipped > 0 {
            self.skipped -= 1;
            return false;
        }
        self.skipped = self.every - 1;
        let present = traffic.by_robot_and_topic();
        let last = self.last.take();
        let ends = last.is_some();
        if let Some((since, before)) = last {
            self.entries
                .push(&entry(since, now, &before, &present, traffic.topics()));
        }
        self.last = Some((now, present));
        ends
    }

    pub(super) fn into_entries(self) -> Spool<SeriesEntry> {
        self.entries
    }
}

/// What came in between two states of the table.
fn entry(since: SimTime, at: SimTime, before: &[RobotTraffic], present: &[RobotTraffic], topics: usize) -> SeriesEntry {
    let spreads = |bytes: fn(&RobotTraffic) -> u64| {
        let grown: Vec<u64> = present
            .iter()
            .zip(before)
            .map(|(now, then)| bytes(now) - bytes(then))
            .collect();
        let of_topic = |topic: usize| RobotBytes::of(grown.iter().skip(topic).step_by(topics).copied().collect());
        let all = grown.chunks(topics.max(1)).map(|robot| robot.iter().sum());
        (0..topics)
            .map(of_topic)
            .chain([RobotBytes::of(all.collect())])
            .collect()
    };
    SeriesEntry {
        since,
        at,
        sent: spreads(|robot| robot.sent_bytes),
        received: spreads(|robot| robot.received_bytes),
    }
}

impl RobotBytes {
    /// How bytes spread over robots.
    fn of(mut robots: Vec<u64>) -> Self {
        robots.sort_unstable();
        let middle = |rank: usize| robots.get(rank).copied().unwrap_or(0) as f64;
        Self {
            total: robots.iter().sum(),
            min: robots.first().copied().unwrap_or(0),
            median: f64::midpoint(middle(robots.len().saturating_sub(1) / 2), middle(robots.len() / 2)),
            max: robots.last().copied().unwrap_or(0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::ActorId;
    use crate::metrics::traffic::HeaderBytes;
    use crate::protocol::{MessageSize, Role, Topic};

    const HEADER: u64 = 5;

    fn at(secs: u32) -> SimTime {
        SimTime::from_secs(f64::from(secs))
    }

    /// Three robots, two roles, two topics.
    fn traffic() -> Traffic {
        Traffic::new(3, 2, 2, HeaderBytes { frame: 2, message: 3 })
    }

    #[test]
    fn an_entry_holds_what_came_since_the_sample_before_in_whatever_role() {
        let (mut series, mut traffic) = (Series::new(1, &Scratch::default()), traffic());
        traffic.sent(ActorId(0), Topic(0), MessageSize::alone(100));
        series.sample(at(0), &traffic);
        traffic.sent(ActorId(0), Topic(0), MessageSize::alone(4));
        traffic.enter(ActorId(0), Role(1));
        traffic.sent(ActorId(0), Topic(0), MessageSize::alone(6));
        traffic.sent(ActorId(1), Topic(1), MessageSize::alone(10));
        traffic.received(ActorId(2), Topic(1), MessageSize::alone(10));
        series.sample(at(1), &traffic);
        let entries = series.into_entries();
        let spread = |total, min, median, max| RobotBytes {
            total,
            min,
            median,
            max,
        };
        let entries: Vec<_> = entries.iter().collect();
        let [entry] = &entries[..] else {
            panic!("the first sample is where the series starts from")
        };
        assert_eq!((entry.since, entry.at), (at(0), at(1)));
        // Robot 0: 4 + 5 and 6 + 5 B on topic 0; robot 1: 10 + 5 B on topic 1.
        assert_eq!(
            entry.sent,
            [spread(20, 0, 0.0, 20), spread(15, 0, 0.0, 15), spread(35, 0, 15.0, 20)]
        );
        assert_eq!(entry.received[2], spread(15, 0, 0.0, 15));
    }

    #[test]
    fn entries_add_up_to_the_traffic_between_the_first_and_the_last_of_their_samples() {
        let (mut series, mut traffic) = (Series::new(2, &Scratch::default()), traffic());
        for second in 0..8 {
            traffic.received(ActorId(second % 3), Topic(0), MessageSize::alone(second as u16));
            series.sample(at(second), &traffic);
        }
        let entries = series.into_entries();
        let times: Vec<_> = entries.iter().map(|entry| (entry.since, entry.at)).collect();
        assert_eq!(times, [(at(0), at(2)), (at(2), at(4)), (at(4), at(6))]);
        let bytes: u64 = entries.iter().map(|entry| entry.received[0].total).sum();
        assert_eq!(bytes, (1..=6).map(|second| second + HEADER).sum::<u64>());
    }

    #[test]
    fn a_series_every_0_samples_is_none() {
        let mut series = Series::new(0, &Scratch::default());
        assert!((0..3).all(|second| !series.sample(at(second), &traffic())));
        assert!(series.into_entries().is_empty());
    }

    #[test]
    fn the_median_of_an_even_number_of_robots_lies_between_the_middle_two() {
        assert_eq!(RobotBytes::of(vec![9, 1, 4, 3]).median.to_bits(), 3.5_f64.to_bits());
    }
}
