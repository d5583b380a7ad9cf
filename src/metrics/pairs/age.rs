//! Age of information (Kaul, Yates and Gruteser, 2012): how old the newest status that a robot has of another is, from the first that arrived
//! until the end of the run, also while the two are out of range or down. An arrival brings it down to that status's own age.

use crate::engine::{SimTime, Span};
use crate::metrics::noted::Values;

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
    /// The ages to which it fell, and those up to which it grew then, seconds: between the two it passes every age at the same pace.
    from: Values,
    to: Option<Values>,
}

/// What is told of it at the end, in seconds.
#[derive(Debug, Default)]
pub(super) struct Ages {
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
            from: Values::one(at.since(sent).as_secs()),
            to: None,
        }
    }

    /// A status that was sent at `sent` arrived at `at`, no earlier than those before. One that is no newer changes nothing.
    pub(super) fn arrived(&mut self, sent: SimTime, at: SimTime) {
        if sent <= self.newest {
            return;
        }
        let peak = self.grow(at);
        self.peaks += 1;
        self.peak_sum += u128::from(peak.as_nanos());
        self.newest = sent;
        self.fell = at;
        self.from.add(at.since(sent).as_secs());
    }

    /// Counts how it has grown since it fell, and answers how old it is at `now`.
    fn grow(&mut self, now: SimTime) -> Span {
        let [low, high] = [self.fell, now].map(|at| at.since(self.newest));
        let [a, b] = [low, high].map(|age| u128::from(age.as_nanos()));
        self.twice_area += b * b - a * a;
        self.known += b - a;
        let high_s = high.as_secs();
        match &mut self.to {
            Some(to) => to.add(high_s),
            none => *none = Some(Values::one(high_s)),
        }
        high
    }

    /// What is to be told of it at the end of the run.
    pub(super) fn told(mut self, end: SimTime) -> Ages {
        self.grow(end);
        let seconds = |nanos: f64| nanos / 1e9;
        Ages {
            mean: (self.known > 0).then(|| seconds(self.twice_area as f64 / 2.0 / self.known as f64)),
            peak: (self.peaks > 0).then(|| seconds(self.peak_sum as f64 / self.peaks as f64)),
            p95: self.to.and_then(|to| quantile(&self.from, &to, 0.95)),
        }
    }
}

/// The age that is not exceeded for a share `q` of the time, where it grew from each of `from` to each of `to`. The time spent below an age x
/// is ∑ (x − a)⁺ over the former less ∑ (x − b)⁺ over the latter.
fn quantile(from: &Values, to: &Values, q: f64) -> Option<f64> {
    let turns = |values: &Values, pace: f64| {
        let (min, max) = (values.min, values.max);
        let turn = move |(age, count): (f64, u64)| (middle(age).clamp(min, max), pace * count as f64);
        values.buckets().map(turn).collect::<Vec<_>>()
    };
    let mut turns = [turns(from, 1.0), turns(to, -1.0)].concat();
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

/// The middle of a bucket whose end nearer to zero is this.
fn middle(end: f64) -> f64 {
    end * (1.0 + 1.0 / 256.0)
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
        // 1 s to 6 s in five seconds, then 2 s to 6 s in four.
        let told = age.told(at(10.0));
        assert_eq!((told.mean, told.peak), (Some((17.5 + 16.0) / 9.0), Some(6.0)));
        // Of the nine seconds 0.45 are spent above it, at a pace of two ages a second.
        let p95 = told.p95.unwrap();
        assert!((p95 - 5.775).abs() < 0.05, "{p95}");
    }

    #[test]
    fn a_single_status_ages_until_the_end_and_has_no_peak() {
        let told = Age::since(at(2.0), at(2.5)).told(at(12.5));
        assert_eq!((told.mean, told.peak), (Some(5.5), None));
        assert!((told.p95.unwrap() - 10.0).abs() < 0.08);
        let none = Age::since(at(2.0), at(2.5)).told(at(2.5));
        assert_eq!((none.mean, none.peak, none.p95), (None, None, None));
    }
}
