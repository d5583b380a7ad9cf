//! An observer and a subject that it watches, and what is counted of all of them.

use std::num::NonZeroU32;

use crate::engine::{ActorId, SimTime};
use crate::spool::{Entry, Scratch, Spool};

use super::record::{FailureOutcome, ObservedFailure, Suspicion, Verdict};

/// What has been counted.
#[derive(Debug)]
pub struct Tally {
    pub monitored_nanos: u128,
    pub mistaken_nanos: u128,
    pub suspicions: Spool<Suspicion>,
    pub failures: Spool<ObservedFailure>,
}

/// A subject, at its observer.
#[derive(Debug)]
pub struct Pair {
    pub subject: ActorId,
    /// Since when the pair is monitored, in one stretch and with one belief, or from when on it will be; `NEVER` while it is not.
    /// There is a pair for every link of the swarm, so it is kept small.
    pub since: SimTime,
    /// When the two have been in range for as long as the detector waits; `NEVER` while they are not in range.
    pub settled: SimTime,
    /// The suspicion in force.
    pub suspicion: Option<Place>,
    /// The failure that is to be detected.
    pub failure: Option<Place>,
    /// Whether the suspicion is, or from `since` on will be, one of a robot that is well and within range.
    pub mistaken: bool,
}

/// A place in a list, counted from 1: so `None` takes no room.
pub type Place = NonZeroU32;

/// The place of what is next added to `list`.
pub fn next_place<T>(list: &Spool<T>) -> Place {
    Place::MIN.saturating_add(list.len() as u32)
}

/// Changes what is at `place`, and answers how it is then.
pub fn change<T: Entry>(list: &mut Spool<T>, place: Place, change: impl FnOnce(&mut T)) -> T {
    list.change(place.get() as usize - 1, change)
}

impl Tally {
    /// Nothing counted yet; what there are many of goes to `scratch`.
    pub fn new(scratch: &Scratch) -> Self {
        Self {
            monitored_nanos: 0,
            mistaken_nanos: 0,
            suspicions: Spool::new(scratch),
            failures: Spool::new(scratch),
        }
    }
}

impl Pair {
    /// Counts the stretch that ends at `now`.
    pub fn settle(&mut self, now: SimTime, tally: &mut Tally) {
        // A pair that is not monitored yet, or no longer, began to be so no time ago.
        let nanos = u128::from(now.since(std::mem::replace(&mut self.since, SimTime::NEVER)).as_nanos());
        tally.monitored_nanos += nanos;
        tally.mistaken_nanos += if self.mistaken { nanos } else { 0 };
    }

    /// Begins a stretch at `now`, or when the two will have been in range for long enough, if both robots are `able` and the belief
    /// says something of the detector's quality.
    pub fn resume(&mut self, now: SimTime, able: bool) {
        let tells = self.suspicion.is_none() || self.mistaken;
        self.since = if able && tells {
            now.max(self.settled)
        } else {
            SimTime::NEVER
        };
    }

    /// A mistake, if there is one, ends at `now`: in trust, or cut off.
    pub fn end_mistake(&mut self, now: SimTime, cut_off: bool, tally: &mut Tally) {
        if let (true, Some(suspicion)) = (std::mem::take(&mut self.mistaken), self.suspicion) {
            change(&mut tally.suspicions, suspicion, |suspicion| {
                // Of a suspicion that became a mistake in range, or again, it is not known how long one lasts.
                if suspicion.verdict() == Verdict::Mistake && suspicion.duration.is_none() {
                    suspicion.duration = Some(now.since(suspicion.at));
                    suspicion.cut_off = cut_off;
                }
            });
        }
    }

    /// The failure ends at `now`: it was detected if the subject is suspected, else the `outcome` is another.
    pub fn resolve(&mut self, now: SimTime, outcome: FailureOutcome, tally: &mut Tally) {
        if let Some(failure) = self.failure.take() {
            let suspicion = self
                .suspicion
                .and_then(|place| tally.suspicions.get(place.get() as usize - 1));
            change(&mut tally.failures, failure, |failure| {
                let detected = suspicion.map(|suspicion| suspicion.at.since(failure.at));
                failure.outcome = detected.map_or(outcome, FailureOutcome::Detected);
                failure.watched = detected.unwrap_or_else(|| now.since(failure.at));
            });
        }
    }
}
