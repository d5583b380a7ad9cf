//! Clocks of actors that are not quite right.

use std::sync::Arc;

use super::{ActorId, KeyedStreams, SimTime};

/// What the clock of each actor shows. All clocks show 0 at the start; from then on each is fast or slow by a share of its own.
///
/// ```
/// use desim::engine::{ActorId, Clocks, SimTime};
///
/// let clocks = Clocks::of([0.0, 20e-6]); // right, and fast by 20 parts in a million
/// let fast = ActorId(1);
/// assert_eq!(clocks.reading(fast, SimTime::from_secs(100.0)), SimTime::from_secs(100.002));
/// assert_eq!(clocks.when(fast, SimTime::from_secs(100.002)), SimTime::from_secs(100.0));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Clocks(Option<Arc<[f64]>>);

impl Clocks {
    /// Clocks that are all right.
    #[must_use]
    pub const fn right() -> Self {
        Self(None)
    }

    /// Clocks that are fast by these shares, each above −1, in order of actors; slow by those below 0.
    #[must_use]
    pub fn of(skews: impl IntoIterator<Item = f64>) -> Self {
        let skews: Arc<[f64]> = skews.into_iter().collect();
        Self(skews.iter().any(|skew| *skew != 0.0).then_some(skews))
    }

    /// The clocks of `actors` actors, each fast or slow by up to `most`, a share, all of that as likely; drawn from `draws` by actor.
    #[must_use]
    pub fn drawn(most: f64, actors: usize, draws: KeyedStreams) -> Self {
        if most == 0.0 {
            return Self::right();
        }
        let share = |word: u64| (word >> 11) as f64 / (1_u64 << 53) as f64;
        Self::of((0..actors as u32).map(|actor| most * (2.0 * share(draws.first_two(actor, 0, 0)[0]) - 1.0)))
    }

    /// Whether all are right.
    #[must_use]
    pub const fn are_right(&self) -> bool {
        self.0.is_none()
    }

    /// By how much each is fast, as a share; empty where all are right.
    #[must_use]
    pub fn skews(&self) -> &[f64] {
        self.0.as_deref().unwrap_or_default()
    }

    /// What the clock of `actor` shows at an instant.
    #[must_use]
    pub fn reading(&self, actor: ActorId, at: SimTime) -> SimTime {
        match self.skews().get(actor.index()) {
            Some(skew) if at != SimTime::NEVER => shown(at.as_nanos(), *skew),
            _ => at,
        }
    }

    /// The first instant at which the clock of `actor` shows `reading` or more.
    #[must_use]
    pub fn when(&self, actor: ActorId, reading: SimTime) -> SimTime {
        let Some(skew) = self.skews().get(actor.index()).filter(|_| reading != SimTime::NEVER) else {
            return reading;
        };
        // Rounding leaves this within a nanosecond or two.
        let mut nanos = (reading.as_nanos() as f64 / (1.0 + skew)) as u64;
        while shown(nanos, *skew) < reading {
            nanos += 1;
        }
        while nanos > 0 && shown(nanos - 1, *skew) >= reading {
            nanos -= 1;
        }
        SimTime::from_nanos(nanos)
    }
}

/// What a clock shows so many nanoseconds after the start.
fn shown(nanos: u64, skew: f64) -> SimTime {
    // Not `floor`, which comes from the machine's maths library.
    let ahead = nanos as f64 * skew;
    let whole = ahead as i64;
    let ahead = if (whole as f64) > ahead { whole - 1 } else { whole };
    SimTime::from_nanos(nanos.saturating_add_signed(ahead))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::{Purpose, Streams};
    use super::*;

    #[test]
    fn right_clocks_show_what_it_is() {
        let clocks = Clocks::of([0.0, 0.0]);
        assert!(clocks.are_right());
        let at = SimTime::from_secs(7.5);
        assert_eq!((clocks.reading(ActorId(1), at), clocks.when(ActorId(1), at)), (at, at));
        assert!(clocks.skews().is_empty());
    }

    /// A uniform law of half-width w has the standard deviation w/√3: over n clocks the mean has w/√(3n).
    #[test]
    fn drawn_clocks_are_spread_evenly() {
        let draws = Streams::new(3, 0).keyed(Purpose::new("test.clocks"));
        let clocks = Clocks::drawn(50e-6, 3000, draws);
        let skews = clocks.skews();
        assert!(skews.iter().all(|skew| skew.abs() <= 50e-6));
        let mean = skews.iter().sum::<f64>() / 3000.0;
        let square = skews.iter().map(|skew| skew * skew).sum::<f64>() / 3000.0;
        assert!(mean.abs() < 4.0 * 50e-6 / 9000.0_f64.sqrt(), "{mean}");
        assert!(
            (square.sqrt() / (50e-6 / 3.0_f64.sqrt()) - 1.0).abs() < 0.04,
            "{square}"
        );
    }

    proptest! {
        /// `when` is the least instant that shows a reading, and clocks never go back.
        #[test]
        fn readings_and_instants_belong_together(nanos in 0_u64..10_u64.pow(15), skew in -0.01..0.01) {
            let clocks = Clocks::of([skew]);
            let (actor, at) = (ActorId(0), SimTime::from_nanos(nanos));
            let reading = clocks.reading(actor, at);
            let next = clocks.reading(actor, SimTime::from_nanos(nanos + 1));
            prop_assert!(next >= reading);
            prop_assert!(clocks.when(actor, reading) <= at);
            let when = clocks.when(actor, at);
            prop_assert!(clocks.reading(actor, when) >= at);
            if when > SimTime::ZERO {
                prop_assert!(clocks.reading(actor, SimTime::from_nanos(when.as_nanos() - 1)) < at);
            }
        }
    }
}
