//! Age of information (Kaul, Yates and Gruteser, 2012): how old the newest status that a robot has of another is, from the first that arrived
//! to the last: that the two have parted since, or one has failed, other figures tell. An arrival brings it down to that status's own age.

use crate::engine::{SimTime, Span};
use crate::metrics::latency::{bounds_of, bucket_of};

/// The age of one robot's information on another.
#[derive(Debug)]
pub(super) struct Age {
    /// When the newest status was sent.
    newest: SimTime,
    /// When the age fell last.
    fell: SimTime,
    /// Its integral over time, twice, in square nanoseconds.
    twice_area: u128,
    /// For how long it has been known, nanoseconds.
    known: u128,
    peaks: u64,
    /// Sum of the ages from which it fell, nanoseconds.
    peak_sum: u128,
    /// The ages to which it fell before it grew, and those up to which it grew then: between the two it passes every age at the same pace.
    from: Ages,
    to: Ages,
}

/// What is told of it at the end, in seconds; nothing of a single status.
#[derive(Debug, Default)]
pub(super) struct Told {
    /// Mean over time.
    pub mean: Option<f64>,
    /// Mean of the ages from which it fell.
    pub peak: Option<f64>,
    /// What it is no more than 95 % of the time, within 1/128.
    pub p95: Option<f64>,
}

impl Age {
    /// The first status that was sent at `sent` arrived at `at`.
    pub(super) fn since(sent: SimTime, at: SimTime) -> Self {
        Self {
            newest: sent,
            fell: at,
            twice_area: 0,
            known: 0,
            peaks: 0,
            peak_sum: 0,
            from: Ages::default(),
            to: Ages::default(),
        }
    }

    /// A status that was sent at `sent` arrived at `at`, no earlier than those before. One that is no newer changes nothing.
    pub(super) fn arrived(&mut self, sent: SimTime, at: SimTime) {
        if sent <= self.newest {
            return;
        }
        let [low, high] = [self.fell, at].map(|at| at.since(self.newest));
        let [a, b] = [low, high].map(|age| u128::from(age.as_nanos()));
        self.twice_area += b * b - a * a;
        self.known += b - a;
        self.peaks += 1;
        self.peak_sum += b;
        self.from.add(low);
        self.to.add(high);
        (self.newest, self.fell) = (sent, at);
    }

    /// What is to be told of it at the end of the run.
    pub(super) fn told(&self) -> Told {
        let seconds = |nanos: f64| nanos / 1e9;
        Told {
            mean: (self.known > 0).then(|| seconds(self.twice_area as f64 / 2.0 / self.known as f64)),
            peak: (self.peaks > 0).then(|| seconds(self.peak_sum as f64 / self.peaks as f64)),
            p95: quantile(&self.from, &self.to, 0.95).map(seconds),
        }
    }
}

/// How many ages there are in each bucket of fixed relative width that has some, in order. There are few, so that a search among neighbours
/// in memory is quick.
#[derive(Debug, Default)]
struct Ages(Vec<(u16, u32)>);

impl Ages {
    fn add(&mut self, age: Span) {
        let bucket = bucket_of(age.as_nanos()) as u16;
        match self.0.binary_search_by_key(&bucket, |(known, _)| *known) {
            Ok(place) => self.0[place].1 += 1,
            Err(place) => self.0.insert(place, (bucket, 1)),
        }
    }

    /// The middle of each bucket, nanoseconds, and how many ages it holds.
    fn iter(&self) -> impl Iterator<Item = (f64, f64)> {
        self.0.iter().map(|&(bucket, count)| {
            let (low, high) = bounds_of(usize::from(bucket));
            (f64::midpoint(low as f64, high as f64), f64::from(count))
        })
    }
}

/// The age that is not exceeded for a share `q` of the time, where it grew from each of `from` to each of `to`, nanoseconds. The time spent
/// below an age x is ∑ (x − a)⁺ over the former less ∑ (x − b)⁺ over the latter.
fn quantile(from: &Ages, to: &Ages, q: f64) -> Option<f64> {
    let starts = from.iter();
    let ends = to.iter().map(|(age, count)| (age, -count));
    let mut turns: Vec<(f64, f64)> = starts.chain(ends).collect();
    turns.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = turns.iter().map(|(age, pace)| -age * pace).sum();
    if total <= 0.0 {
        return None;
    }
    let (mut below, mut pace, mut reached) = (0.0, 0.0, 0.0);
    for (age, change) in turns {
        let next = below + pace * (age - reached);
        if next >= q * total && pace > 0.0 {
            return Some(reached + (q * total - below) / pace);
        }
        (below, pace, reached) = (next, pace + change, age);
    }
    Some(reached)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(seconds: f64) -> SimTime {
        SimTime::from_secs(seconds)
    }

    #[test]
    fn the_age_grows_with_time_and_falls_to_that_of_a_newer_status_alone() {
        let mut age = Age::since(at(0.0), at(1.0));
        age.arrived(at(4.0), at(6.0));
        age.arrived(at(3.0), at(7.0));
        age.arrived(at(9.0), at(10.0));
        // 1 s to 6 s in five seconds, then 2 s to 6 s in four.
        let told = age.told();
        assert_eq!((told.mean, told.peak), (Some((17.5 + 16.0) / 9.0), Some(6.0)));
        // Of the nine seconds 0.45 are spent above it, at a pace of two ages a second.
        let p95 = told.p95.unwrap();
        assert!((p95 - 5.775).abs() < 0.05, "{p95}");
    }

    #[test]
    fn a_single_status_tells_nothing_and_what_comes_after_the_last_does_not_count() {
        let mut age = Age::since(at(2.0), at(2.5));
        let none = age.told();
        assert_eq!((none.mean, none.peak, none.p95), (None, None, None));
        age.arrived(at(3.0), at(3.5));
        let told = age.told();
        assert_eq!((told.mean, told.peak), (Some(1.0), Some(1.5)));
    }
}
