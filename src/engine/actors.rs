//! The actors driver: every actor is a tokio task with a mailbox.
//!
//! All tasks live on the caller's thread. A simulated instant has one order of events, so threads inside a run
//! would only wait for each other; trials are what runs in parallel.

use std::rc::Rc;

use tokio::task::spawn_local;

use super::mailbox::{Desk, Mailbox};
use super::prefetch::prefetch;
use super::process::{ActorId, Driver, JobOf, Process};

/// A job and its place among those of its round.
type Mail<P> = (usize, Box<JobOf<P>>);

/// Wakes each actor's task through its mailbox and waits for the answers.
pub struct Actors<P: Process> {
    mailboxes: Vec<Rc<Mailbox<Mail<P>>>>,
    answers: Rc<Desk<Box<JobOf<P>>>>,
}

impl<P> Actors<P>
where
    P: Process + 'static,
    P::Input: 'static,
    P::Output: 'static,
{
    /// Spawns one task for each of `processes`, the actors in order of their ids.
    ///
    /// # Panics
    /// Outside [`block_on`](super::block_on): tasks need a runtime to live in.
    #[must_use]
    pub fn spawn(processes: Vec<P>) -> Self {
        let answers = Rc::new(Desk::default());
        let spawn = |process| {
            let mailbox = Rc::new(Mailbox::default());
            spawn_local(live(process, Rc::clone(&mailbox), Rc::clone(&answers)));
            mailbox
        };
        Self {
            mailboxes: processes.into_iter().map(spawn).collect(),
            answers,
        }
    }
}

/// An actor's life: it reads its mail and answers it, for as long as the runtime lets it.
async fn live<P: Process>(mut process: P, mailbox: Rc<Mailbox<Mail<P>>>, answers: Rc<Desk<Box<JobOf<P>>>>) {
    let _notice = answers.notice_of_panic();
    loop {
        let (slot, mut job) = mailbox.next().await;
        process.handle(job.now, &mut job.input, &mut job.output);
        answers.put(slot, job);
    }
}

impl<P: Process> Driver<P> for Actors<P> {
    #[inline]
    fn prefetch_row(&self, actor: ActorId) {
        prefetch(&*self.mailboxes[actor.index()]);
    }

    /// # Panics
    /// If an actor panics.
    async fn dispatch(&mut self, jobs: &mut Vec<Box<JobOf<P>>>) {
        self.answers.clear(jobs.len());
        for (slot, job) in jobs.drain(..).enumerate() {
            self.mailboxes[job.actor.index()].put((slot, job));
        }
        self.answers.complete().await;
        self.answers.take(jobs);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{Job, SimTime, block_on};

    /// Adds up what it is told, and cannot bear 13.
    struct Adder(u64);

    impl Process for Adder {
        type Input = u64;
        type Output = u64;

        fn handle(&mut self, _: SimTime, input: &mut u64, output: &mut u64) {
            assert_ne!(*input, 13, "unlucky");
            self.0 += *input;
            *output = self.0;
        }
    }

    /// What actors answer to rounds of jobs, each an actor and what it is told.
    fn answers(rounds: &[&[(u32, u64)]]) -> Vec<Vec<(u32, u64)>> {
        let run = async {
            let mut actors = Actors::spawn(vec![Adder(0), Adder(100), Adder(200)]);
            let mut answers = Vec::new();
            for round in rounds {
                let job = |&(actor, input)| Job {
                    actor: ActorId(actor),
                    now: SimTime::ZERO,
                    input,
                    output: 0,
                };
                let mut jobs = round.iter().map(job).map(Box::new).collect();
                actors.dispatch(&mut jobs).await;
                answers.push(jobs.iter().map(|job| (job.actor.0, job.output)).collect());
            }
            answers
        };
        block_on(run).unwrap()
    }

    #[test]
    fn actors_keep_their_state_and_answer_in_the_order_of_the_jobs() {
        let rounds: [&[_]; 4] = [&[(2, 1), (0, 2)], &[], &[(1, 5)], &[(0, 3), (1, 4), (2, 6)]];
        let expected = [
            vec![(2, 201), (0, 2)],
            vec![],
            vec![(1, 105)],
            vec![(0, 5), (1, 109), (2, 207)],
        ];
        assert_eq!(answers(&rounds), expected);
    }

    #[test]
    #[should_panic(expected = "an actor panicked")]
    fn a_run_does_not_wait_for_an_actor_that_panicked() {
        answers(&[&[(0, 1)], &[(0, 1), (1, 13), (2, 1)]]);
    }
}
