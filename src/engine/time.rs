//! Virtual time: instants and spans as whole nanoseconds, so that adding them never rounds.

use std::fmt;
use std::ops::{Add, AddAssign, Div, Mul, Sub};

use serde::{Deserialize, Serialize};

const NANOS_PER_SECOND: f64 = 1e9;

/// An instant of simulated time, in nanoseconds since the start of the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SimTime(u64);

/// A span of simulated time, in nanoseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Span(u64);

impl SimTime {
    /// The start of every run.
    pub const ZERO: Self = Self(0);
    /// Later than anything that happens.
    pub const NEVER: Self = Self(u64::MAX);

    /// An instant `nanos` nanoseconds after the start.
    #[must_use]
    pub const fn from_nanos(nanos: u64) -> Self {
        Self(nanos)
    }

    /// An instant `seconds` after the start, rounded to the nearest nanosecond; negative and NaN become zero.
    #[must_use]
    pub fn from_secs(seconds: f64) -> Self {
        Self(Span::from_secs(seconds).0)
    }

    /// Nanoseconds since the start.
    #[must_use]
    pub const fn as_nanos(self) -> u64 {
        self.0
    }

    /// Seconds since the start.
    #[must_use]
    pub fn as_secs(self) -> f64 {
        self.0 as f64 / NANOS_PER_SECOND
    }

    /// The span from `earlier` to `self`, zero if `earlier` is later.
    #[must_use]
    pub const fn since(self, earlier: Self) -> Span {
        Span(self.0.saturating_sub(earlier.0))
    }
}

impl Span {
    /// No time at all.
    pub const ZERO: Self = Self(0);

    /// A span of `nanos` nanoseconds.
    #[must_use]
    pub const fn from_nanos(nanos: u64) -> Self {
        Self(nanos)
    }

    /// A span of `seconds`, rounded to the nearest nanosecond; negative and NaN become zero.
    #[must_use]
    pub fn from_secs(seconds: f64) -> Self {
        // Adding a half and cutting off is rounding for what is not negative, without a call to the maths library.
        Self((seconds * NANOS_PER_SECOND + 0.5) as u64)
    }

    /// The number of `period`s that it takes, rounded up. What is longer by a nanosecond and a share of 1e-9 is none longer: a
    /// period that no decimal holds, such as a third of a second, goes three times into a second.
    #[must_use]
    pub const fn in_periods(self, period: Self) -> u64 {
        let period = if period.0 == 0 { 1 } else { period.0 };
        let (whole, left) = (self.0 / period, self.0 % period);
        let is_rounding = whole > 0 && left <= 1 + self.0 / 1_000_000_000;
        if left == 0 || is_rounding { whole } else { whole + 1 }
    }

    /// What is left of it without `other`, zero if that is longer.
    #[must_use]
    pub const fn less(self, other: Self) -> Self {
        Self(self.0.saturating_sub(other.0))
    }

    /// Length in nanoseconds.
    #[must_use]
    pub const fn as_nanos(self) -> u64 {
        self.0
    }

    /// Length in seconds.
    #[must_use]
    pub fn as_secs(self) -> f64 {
        self.0 as f64 / NANOS_PER_SECOND
    }
}

impl Add<Span> for SimTime {
    type Output = Self;
    fn add(self, span: Span) -> Self {
        Self(self.0.saturating_add(span.0))
    }
}

impl AddAssign<Span> for SimTime {
    fn add_assign(&mut self, span: Span) {
        *self = *self + span;
    }
}

impl Sub<Span> for SimTime {
    type Output = Self;
    fn sub(self, span: Span) -> Self {
        Self(self.0.saturating_sub(span.0))
    }
}

impl Add for Span {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0.saturating_add(other.0))
    }
}

impl Mul<u64> for Span {
    type Output = Self;
    fn mul(self, times: u64) -> Self {
        Self(self.0.saturating_mul(times))
    }
}

impl Div<u64> for Span {
    type Output = Self;
    fn div(self, parts: u64) -> Self {
        Self(self.0 / parts)
    }
}

impl fmt::Display for SimTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.3} s", self.as_secs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thousand_steps_of_a_tenth_of_a_second_are_exactly_a_hundred_seconds() {
        let step = Span::from_secs(0.1);
        let end = (0..1000).fold(SimTime::ZERO, |now, _| now + step);
        assert_eq!(end, SimTime::from_secs(100.0));
    }

    #[test]
    fn a_span_takes_as_many_periods_as_a_person_counts_and_rounds_up_what_is_really_more() {
        let periods = |span, period| Span::from_secs(span).in_periods(Span::from_secs(period));
        for period in [0.1, 0.3, 0.7, 1.1, 1.0 / 3.0, 1.0 / 7.0, 0.025] {
            for count in 1..200_u32 {
                assert_eq!(
                    periods(f64::from(count) * period, period),
                    u64::from(count),
                    "{count} × {period}"
                );
            }
        }
        assert_eq!(
            (periods(1.0, 1.0 / 3.0), periods(1.0, 0.333), periods(1.0, 0.3)),
            (3, 4, 4)
        );
        assert_eq!(
            (periods(0.0, 0.1), periods(1e-9, 0.1), periods(1.000_001, 1.0)),
            (0, 1, 2)
        );
    }

    #[test]
    fn never_stays_never_whatever_is_added() {
        assert_eq!(SimTime::NEVER + Span::from_secs(1.0), SimTime::NEVER);
    }

    #[test]
    fn negative_and_undefined_seconds_become_zero() {
        assert_eq!(Span::from_secs(-1.0), Span::ZERO);
        assert_eq!(Span::from_secs(f64::NAN), Span::ZERO);
    }
}
