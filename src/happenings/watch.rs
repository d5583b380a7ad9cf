//! Watching the run of a scenario, whatever its protocol: [`Watch`].

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::{Copy, Inbox, Observer, Sent};
use crate::engine::{ActorId, SimTime};
use crate::faults::Change;
use crate::geometry::Vec2;
use crate::motion::World;
use crate::protocol::{Note, Topic};
use crate::radio::{Account, Conclusion, FrameId, LossCause, Reading};

/// What robots of a protocol call what they say and what they are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Vocabulary {
    /// Names of the topics in use, by number.
    pub topics: &'static [&'static str],
    /// Names of the roles, by number.
    pub roles: &'static [&'static str],
    /// The topic of statuses, if robots send any.
    pub status: Option<Topic>,
}

/// Watches a run without knowing the type of its messages: an [`Observer`] for those who are handed scenarios and not protocols. A run
/// that is watched takes a little longer, for each call is an indirect one, and comes to the same record and digest.
///
/// Each method is told what that of [`Observer`] is. All is told in order of time.
#[allow(unused_variables)] // Names of what methods are told that do nothing with it.
pub trait Watch: Send {
    /// The run begins.
    fn begin(&mut self, vocabulary: &Vocabulary, world: &World) {}
    /// See [`Observer::noted`].
    fn noted(&mut self, now: SimTime, robot: ActorId, note: &Note) {}
    /// See [`Observer::sent`].
    fn sent(&mut self, message: &Sent<'_>) {}
    /// See [`Observer::spoke`].
    fn spoke(&mut self, now: SimTime, robot: ActorId, world: &World) {}
    /// See [`Observer::arrives`].
    fn arrives(&mut self, copy: &Copy, at: SimTime) {}
    /// See [`Observer::lost`].
    fn lost(&mut self, copy: &Copy, cause: LossCause, at: SimTime) {}
    /// See [`Observer::delivered`].
    fn delivered(&mut self, copy: &Copy, at: SimTime, read: Option<SimTime>) {}
    /// See [`Observer::strayed`].
    fn strayed(&mut self, copy: &Copy, at: SimTime, read: Option<SimTime>) {}
    /// See [`Observer::in_flight`].
    fn in_flight(&mut self, copy: &Copy, at: Option<SimTime>) {}
    /// See [`Observer::concluded`].
    fn concluded(&mut self, conclusion: &Conclusion) {}
    /// See [`Observer::measured`].
    fn measured(&mut self, now: SimTime, frame: FrameId, reading: &Reading) {}
    /// See [`Observer::accounted`].
    fn accounted(&mut self, robot: ActorId, account: &Account) {}
    /// See [`Observer::fault`].
    fn fault(&mut self, now: SimTime, change: &Change, positions: &[Vec2]) {}
    /// See [`Observer::tick`].
    fn tick(&mut self, world: &World) {}
    /// See [`Observer::end`].
    fn end(&mut self, end: SimTime) {}
}

/// Whoever watches a run: what it gathers is there when the run is over, for those who kept the `Arc`.
/// [`watch_trial`](crate::experiment::watch_trial) does.
#[derive(Clone)]
pub struct Watcher(Arc<Mutex<dyn Watch>>);

impl Watcher {
    /// Of what others go on holding.
    #[must_use]
    pub fn new<W: Watch + 'static>(watch: Arc<Mutex<W>>) -> Self {
        Self(watch)
    }

    /// Alone with it, for all of a run.
    pub(crate) fn lock(&self) -> MutexGuard<'_, dyn Watch + 'static> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl fmt::Debug for Watcher {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Watcher")
    }
}

/// Tells a [`Watch`] what an observer is told.
pub(crate) struct Watching<'a> {
    pub watch: &'a mut dyn Watch,
    pub vocabulary: Vocabulary,
}

impl Observer for Watching<'_> {
    fn begin(&mut self, world: &World) {
        self.watch.begin(&self.vocabulary, world);
    }

    fn noted<H>(&mut self, now: SimTime, robot: ActorId, note: &Note, _: &Inbox<'_, H>) {
        self.watch.noted(now, robot, note);
    }

    fn sent(&mut self, message: &Sent<'_>) {
        self.watch.sent(message);
    }

    fn spoke(&mut self, now: SimTime, robot: ActorId, world: &World) {
        self.watch.spoke(now, robot, world);
    }

    fn arrives(&mut self, copy: &Copy, at: SimTime) {
        self.watch.arrives(copy, at);
    }

    fn lost(&mut self, copy: &Copy, cause: LossCause, at: SimTime) {
        self.watch.lost(copy, cause, at);
    }

    fn delivered(&mut self, copy: &Copy, at: SimTime, read: Option<SimTime>) {
        self.watch.delivered(copy, at, read);
    }

    fn strayed(&mut self, copy: &Copy, at: SimTime, read: Option<SimTime>) {
        self.watch.strayed(copy, at, read);
    }

    fn in_flight(&mut self, copy: &Copy, at: Option<SimTime>) {
        self.watch.in_flight(copy, at);
    }

    fn concluded(&mut self, conclusion: &Conclusion) {
        self.watch.concluded(conclusion);
    }

    fn measured(&mut self, now: SimTime, frame: FrameId, reading: &Reading) {
        self.watch.measured(now, frame, reading);
    }

    fn accounted(&mut self, robot: ActorId, account: &Account) {
        self.watch.accounted(robot, account);
    }

    fn fault(&mut self, now: SimTime, change: &Change, positions: &[Vec2]) {
        self.watch.fault(now, change, positions);
    }

    fn tick(&mut self, world: &World) {
        self.watch.tick(world);
    }

    fn end(&mut self, end: SimTime) {
        self.watch.end(end);
    }
}
