//! The boundary between a run and the actors in it.

use serde::{Deserialize, Serialize};

use super::SimTime;

/// Number of an actor in its run, counted from 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ActorId(pub u32);

impl ActorId {
    /// The actor's place in tables that hold a row an actor.
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

impl std::fmt::Display for ActorId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.0)
    }
}

/// A state machine that is handed time and input, and answers with output. It owns no clock, no channel and no
/// generator, so it runs alike under every driver.
pub trait Process {
    /// What it is told when it wakes.
    type Input;
    /// What it answers. Handed in empty, and reused from wake to wake.
    type Output;

    /// Asks for the memory that the next step will read beside `self` ([`prefetch`](super::prefetch)): a hint, shortly before
    /// that step, in a swarm that outgrows the cache.
    fn prefetch(&self) {}

    /// Takes one step at instant `now`.
    fn handle(&mut self, now: SimTime, input: &mut Self::Input, output: &mut Self::Output);
}

/// One wake of one actor: filled in by the run, carried to the actor by a driver, and back with the answer.
#[derive(Debug)]
pub struct Job<I, O> {
    /// Who wakes.
    pub actor: ActorId,
    /// When.
    pub now: SimTime,
    /// What it is told.
    pub input: I,
    /// What it answers.
    pub output: O,
}

/// The job type of a process.
pub type JobOf<P> = Job<<P as Process>::Input, <P as Process>::Output>;

/// Runs actors: takes their jobs to them and brings the answers back.
pub trait Driver<P: Process> {
    /// Asks for the memory of `actor`, which is to wake soon, if it can be reached.
    fn prefetch_row(&self, actor: ActorId) {
        let _ = actor;
    }

    /// Asks for what `actor` keeps elsewhere, a while after its [row](Self::prefetch_row).
    fn prefetch_contents(&self, actor: ActorId) {
        let _ = actor;
    }

    /// Handles `jobs`, at most one an actor, and leaves them in the order given.
    fn dispatch(&mut self, jobs: &mut Vec<Box<JobOf<P>>>) -> impl Future<Output = ()>;

    /// Ends, and gives the actors back, in order of their ids.
    fn finish(self) -> impl Future<Output = Vec<P>>;
}
