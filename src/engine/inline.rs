//! The inline driver: an actor is a direct call.

use super::prefetch::prefetch;
use super::process::{ActorId, Driver, JobOf, Process};

/// Calls each actor in turn on the caller's stack.
#[derive(Debug)]
pub struct Inline<P> {
    processes: Vec<P>,
}

impl<P> Inline<P> {
    /// Drives `processes`, the actors in order of their ids.
    #[must_use]
    pub fn new(processes: Vec<P>) -> Self {
        Self { processes }
    }
}

impl<P: Process> Driver<P> for Inline<P> {
    #[inline]
    fn prefetch_row(&self, actor: ActorId) {
        prefetch(&self.processes[actor.index()]);
    }

    #[inline]
    fn prefetch_contents(&self, actor: ActorId) {
        self.processes[actor.index()].prefetch();
    }

    async fn dispatch(&mut self, jobs: &mut Vec<Box<JobOf<P>>>) {
        for job in jobs {
            self.processes[job.actor.index()].handle(job.now, &mut job.input, &mut job.output);
        }
    }

    async fn finish(self) -> Vec<P> {
        self.processes
    }
}
