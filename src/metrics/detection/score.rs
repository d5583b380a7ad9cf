//! Beliefs held against the truth, as both change.

use crate::engine::{ActorId, SimTime, Span, push_tight};
use crate::faults::Health;
use crate::happenings::Inbox;
use crate::motion::World;
use crate::protocol::{Evidence, Note};
use crate::radio::{LossCause, Reach};
use crate::spool::Scratch;

use super::log::StatusLog;
use super::pair::{Pair, Tally, change, next_place};
use super::range::{Crossing, Ranges};
use super::record::{Cause, DetectionRecord, FailureOutcome, Missed, ObservedFailure, Suspicion, Verdict};

/// What scoring needs to know of a run.
#[derive(Clone, Debug)]
pub struct Watching {
    /// How far back a suspicion is traced to the statuses that were missed.
    pub memory: Span,
    /// How long a detector waits for a status before it suspects.
    pub patience: Span,
    /// Who is in range of whom.
    pub reach: Reach,
}

/// Scores the failure detectors of one run.
#[derive(Debug)]
pub struct Scorer {
    log: StatusLog,
    patience: Span,
    ranges: Ranges,
    health: Vec<Health>,
    /// When the health of each robot last changed.
    changed: Vec<SimTime>,
    /// When each robot could not send; the last stretch may be open.
    silences: Vec<Vec<(SimTime, SimTime)>>,
    /// By observer: whom it watches.
    pairs: Vec<Vec<Pair>>,
    /// By subject: who watches it.
    watchers: Vec<Vec<ActorId>>,
    tally: Tally,
}

impl Scorer {
    /// A scorer of robots that all are well.
    pub fn new(robots: usize, watching: Watching, scratch: &Scratch) -> Self {
        Self {
            log: StatusLog::new(robots, watching.memory),
            patience: watching.patience,
            ranges: Ranges::new(watching.reach),
            health: vec![Health::WELL; robots],
            changed: vec![SimTime::ZERO; robots],
            silences: vec![Vec::new(); robots],
            pairs: std::iter::repeat_with(Vec::new).take(robots).collect(),
            watchers: vec![Vec::new(); robots],
            tally: Tally::new(scratch),
        }
    }

    /// `sender` sends a status, its frame number `sequence`: to one robot alone, or to all in range.
    #[inline]
    pub fn sent(&mut self, now: SimTime, sender: ActorId, sequence: u32, to: Option<ActorId>) {
        self.log.sent(now, sender, sequence, to);
    }

    /// Asks for what is known of the statuses of `robot`.
    pub fn prefetch_row(&self, robot: ActorId) {
        self.log.prefetch_row(robot);
    }

    /// Asks for where the next ones go.
    pub fn prefetch_contents(&self, robot: ActorId) {
        self.log.prefetch_contents(robot);
    }

    /// The copy of a status that was meant for `receiver` is lost.
    #[inline]
    pub fn lost(&mut self, receiver: ActorId, sender: ActorId, sequence: u32, cause: LossCause) {
        self.log.lost(receiver, sender, sequence, cause);
    }

    /// The run begins, with robots where `world` says.
    pub fn begin(&mut self, world: &World) {
        self.ranges.begin(world);
    }

    /// Robots go on to where `world` says, at each of its ticks.
    pub fn tick(&mut self, world: &World) {
        self.cross_until(world.now());
        self.ranges.go_on(world);
        if world.is_moving() {
            if !self.ranges.follows() {
                self.ranges.follow_from_now_on();
                for (observer, pairs) in (0..).map(ActorId).zip(&self.pairs) {
                    // Who watches each other is followed once.
                    let subjects = pairs.iter().map(|pair| pair.subject);
                    let first =
                        subjects.filter(|subject| observer < *subject || !watches(&self.pairs, *subject, observer));
                    for subject in first {
                        self.ranges.follow([observer, subject], world.now());
                    }
                }
            }
            self.ranges.look(world);
        }
    }

    /// Takes in who has crossed the range by `now`.
    fn cross_until(&mut self, now: SimTime) {
        while let Some(Crossing { at, pair, within }) = self.ranges.take_crossing(now) {
            let [observer, subject] = pair;
            self.cross(at, observer, subject, within);
            if self.ranges.are_mutual() {
                self.cross(at, subject, observer, within);
            }
        }
    }

    /// `subject` comes within range of `observer`, or leaves it: a mistake is cut off then, and a suspicion that outlasts the
    /// detector's patience in range becomes one.
    fn cross(&mut self, now: SimTime, observer: ActorId, subject: ActorId, within: bool) {
        let able = self.is_able(observer, subject);
        let Some(pair) = self.pairs[observer.index()]
            .iter_mut()
            .find(|pair| pair.subject == subject)
        else {
            return;
        };
        pair.settle(now, &mut self.tally);
        pair.end_mistake(now, true, &mut self.tally);
        pair.settled = if within { now + self.patience } else { SimTime::NEVER };
        pair.mistaken = within && able && pair.suspicion.is_some();
        pair.resume(now, able);
    }

    /// `observer` reported a belief, with these frames at hand.
    ///
    /// # Panics
    /// If it reports a belief about a robot that it does not watch.
    pub fn belief<M>(&mut self, now: SimTime, observer: ActorId, note: &Note, inbox: &Inbox<'_, M>) {
        match *note {
            Note::Watches(subject) => {
                let met = self.log.met([observer, subject], inbox);
                self.watch(now, observer, subject, met);
            }
            Note::Suspects {
                robot,
                heard,
                sequence,
                evidence,
            } => {
                self.cross_until(now);
                let missed = self.log.missed(now, [observer, robot], sequence, inbox.waiting);
                let subject_down = !self.health[robot.index()].sends;
                let settled = find(&mut self.pairs, observer, robot).settled;
                let suspicion = Suspicion {
                    observer,
                    subject: robot,
                    at: now,
                    heard,
                    sequence,
                    until: None,
                    subject_down,
                    cause: if subject_down {
                        Cause::Failure
                    } else if settled > now {
                        Cause::OutOfRange
                    } else if self.silent(robot, heard, now) * 2 > now.since(heard) {
                        Cause::Failure
                    } else {
                        cause(&missed, evidence)
                    },
                    missed,
                    duration: None,
                    cut_off: false,
                };
                self.suspect(&suspicion);
            }
            Note::Trusts(subject) => {
                self.cross_until(now);
                self.trust(now, observer, subject);
            }
            Note::Role(_)
            | Note::Target(_)
            | Note::Parents(_)
            | Note::Duplicate { .. }
            | Note::Informed { .. }
            | Note::Count { .. }
            | Note::Value { .. } => {}
        }
    }

    /// `observer` watches `subject` from `now` on, in whose range it has been since they `met`, or from the start, if it is.
    fn watch(&mut self, now: SimTime, observer: ActorId, subject: ActorId, met: Option<SimTime>) {
        let is_followed = self.ranges.are_mutual() && watches(&self.pairs, subject, observer);
        let within = is_followed || self.ranges.follow([observer, subject], now);
        let met = met.filter(|_| within);
        let settled = || {
            met.map_or(SimTime::ZERO, |met| {
                let able = [observer, subject].map(|robot| self.changed[robot.index()]);
                met.max(able[0]).max(able[1]) + self.patience
            })
        };
        let mut pair = Pair {
            subject,
            since: SimTime::NEVER,
            settled: if within { settled() } else { SimTime::NEVER },
            suspicion: None,
            mistaken: false,
            failure: None,
        };
        let able = self.is_able(observer, subject);
        if met.is_some() && able {
            // In range for that long before it was heard for the first time.
            pair.mistaken = true;
            pair.since = pair.settled.min(now);
            pair.settle(now, &mut self.tally);
            pair.mistaken = false;
        }
        pair.resume(now, able);
        push_tight(&mut self.pairs[observer.index()], pair);
        push_tight(&mut self.watchers[subject.index()], observer);
    }

    fn suspect(&mut self, suspicion: &Suspicion) {
        let Suspicion {
            observer, subject, at, ..
        } = *suspicion;
        let able = self.is_able(observer, subject);
        let pair = find(&mut self.pairs, observer, subject);
        pair.settle(at, &mut self.tally);
        pair.suspicion = Some(next_place(&self.tally.suspicions));
        // One that they brought with them is a mistake once they have been in range for long enough.
        let brought = able && (at..SimTime::NEVER).contains(&pair.settled);
        pair.mistaken = brought || suspicion.verdict() == Verdict::Mistake;
        self.tally.suspicions.push(suspicion);
        pair.resume(at, able);
    }

    fn trust(&mut self, now: SimTime, observer: ActorId, subject: ActorId) {
        let able = self.is_able(observer, subject);
        let pair = find(&mut self.pairs, observer, subject);
        pair.settle(now, &mut self.tally);
        pair.end_mistake(now, false, &mut self.tally);
        if let Some(suspicion) = pair.suspicion.take() {
            change(&mut self.tally.suspicions, suspicion, |suspicion| {
                suspicion.until = Some(now);
            });
        }
        pair.resume(now, able);
    }

    /// `robot` can do from `now` on what `health` says.
    pub fn fault(&mut self, now: SimTime, robot: ActorId, health: Health) {
        self.cross_until(now);
        self.changed[robot.index()] = now;
        let before = std::mem::replace(&mut self.health[robot.index()], health);
        if before.sends != health.sends {
            let silences = &mut self.silences[robot.index()];
            match silences.last_mut() {
                Some(last) if health.sends => last.1 = now,
                _ => silences.push((now, SimTime::NEVER)),
            }
            let mut watchers = std::mem::take(&mut self.watchers[robot.index()]);
            watchers.sort_unstable();
            for &observer in &watchers {
                self.subject_changes(now, observer, robot);
            }
            self.watchers[robot.index()] = watchers;
        }
        if before.hears != health.hears {
            self.observer_changes(now, robot);
        }
    }

    /// `subject` fails to send, or sends again: to `observer` a mistake about it is one no longer.
    fn subject_changes(&mut self, now: SimTime, observer: ActorId, subject: ActorId) {
        let able = self.is_able(observer, subject);
        let pair = find(&mut self.pairs, observer, subject);
        let was_monitored = pair.since <= now;
        pair.settle(now, &mut self.tally);
        pair.end_mistake(now, true, &mut self.tally);
        if self.health[subject.index()].sends {
            pair.resolve(now, FailureOutcome::Recovered, &mut self.tally);
        } else if was_monitored {
            pair.failure = Some(next_place(&self.tally.failures));
            self.tally.failures.push(&ObservedFailure {
                subject,
                observer,
                at: now,
                outcome: FailureOutcome::Undetected,
                watched: Span::ZERO,
            });
        }
        pair.resume(now, able);
    }

    /// `observer` fails to hear, or hears again: what it believed meanwhile is not its detector's merit or fault.
    fn observer_changes(&mut self, now: SimTime, observer: ActorId) {
        let hears = self.health[observer.index()].hears;
        for pair in &mut self.pairs[observer.index()] {
            pair.settle(now, &mut self.tally);
            pair.end_mistake(now, true, &mut self.tally);
            if !hears {
                pair.resolve(now, FailureOutcome::ObserverFailed, &mut self.tally);
            }
            pair.resume(now, hears && self.health[pair.subject.index()].sends);
        }
    }

    /// Closes the books at `end`.
    pub fn finish(mut self, end: SimTime) -> DetectionRecord {
        self.cross_until(end);
        for pair in self.pairs.iter_mut().flatten() {
            pair.settle(end, &mut self.tally);
            pair.end_mistake(end, true, &mut self.tally);
            pair.resolve(end, FailureOutcome::Undetected, &mut self.tally);
        }
        DetectionRecord {
            pairs: self.pairs.iter().map(|pairs| pairs.len() as u64).sum(),
            monitored_s: self.tally.monitored_nanos as f64 / 1e9,
            mistaken_s: self.tally.mistaken_nanos as f64 / 1e9,
            suspicions: self.tally.suspicions,
            failures: self.tally.failures,
        }
    }

    fn is_able(&self, observer: ActorId, subject: ActorId) -> bool {
        self.health[observer.index()].hears && self.health[subject.index()].sends
    }

    /// How long `robot` could not send within `from..to`.
    fn silent(&self, robot: ActorId, from: SimTime, to: SimTime) -> Span {
        let silences = self.silences[robot.index()].iter();
        let overlaps = silences.map(|&(since, until)| until.min(to).since(since.max(from)));
        overlaps.fold(Span::ZERO, |sum, overlap| sum + overlap)
    }
}

/// What a suspicion of a robot that was well was due to. Who goes by probes does not go by statuses: these only tell whether
/// the two could hear each other.
fn cause(missed: &Missed, evidence: Evidence) -> Cause {
    let cause = missed.cause();
    let hindrances = [LossCause::ReceiverDown, LossCause::BelowSensitivity].map(Cause::Lost);
    let hindered = cause == Cause::OutOfRange || hindrances.contains(&cause);
    match evidence {
        Evidence::Probes if !hindered => Cause::Unanswered,
        Evidence::Probes | Evidence::Silence => cause,
    }
}

/// Whether `observer` watches `subject`.
fn watches(pairs: &[Vec<Pair>], observer: ActorId, subject: ActorId) -> bool {
    pairs[observer.index()].iter().any(|pair| pair.subject == subject)
}

/// The pair of `observer` and `subject`.
fn find(pairs: &mut [Vec<Pair>], observer: ActorId, subject: ActorId) -> &mut Pair {
    let mut watched = pairs[observer.index()].iter_mut();
    let found = watched.find(|pair| pair.subject == subject);
    found.unwrap_or_else(|| panic!("robot {observer} believes something of robot {subject}, which it does not watch"))
}

#[cfg(test)]
mod tests;
