//! The actors driver: every actor is a tokio task with a mailbox.
//!
//! All tasks live on the caller's thread. A simulated instant has one order of events, so threads inside a run
//! would only wait for each other; trials are what runs in parallel.

use std::pin::Pin;
use std::rc::Rc;
use std::task::{Context, Poll};

use tokio::task::{JoinHandle, spawn_local};

use super::mailbox::{Desk, Mailbox};
use super::prefetch::prefetch;
use super::process::{ActorId, Driver, JobOf, Process};

/// A job and its place among those of its round.
type Mail<P> = (usize, Box<JobOf<P>>);

/// Wakes each actor's task through its mailbox and waits for the answers.
pub struct Actors<P: Process> {
    mailboxes: Vec<Rc<Mailbox<Mail<P>>>>,
    answers: Rc<Desk<Box<JobOf<P>>>>,
    tasks: Vec<JoinHandle<P>>,
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
            let life = Life {
                process: Some(process),
                mailbox: Rc::clone(&mailbox),
                answers: Rc::clone(&answers),
            };
            (mailbox, spawn_local(life))
        };
        let (mailboxes, tasks) = processes.into_iter().map(spawn).unzip();
        Self {
            mailboxes,
            answers,
            tasks,
        }
    }
}

/// An actor's life: it reads its mail and answers it until there will be no more. A future by hand: one that the compiler makes of a function
/// holds the process twice, and the state of a swarm is what its memory is read for.
struct Life<P: Process> {
    /// There until the end.
    process: Option<P>,
    mailbox: Rc<Mailbox<Mail<P>>>,
    answers: Rc<Desk<Box<JobOf<P>>>>,
}

/// Nothing in it points into it.
impl<P: Process> Unpin for Life<P> {}

impl<P: Process> Future for Life<P> {
    type Output = P;

    fn poll(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<P> {
        let Self {
            process,
            mailbox,
            answers,
        } = self.get_mut();
        let _notice = answers.notice_of_panic();
        while let Some((slot, mut job)) = mailbox.take() {
            if let Some(process) = process {
                process.handle(job.now, &mut job.input, &mut job.output);
            }
            answers.put(slot, job);
        }
        match process {
            ended if answers.is_closed() => ended.take().map_or(Poll::Pending, Poll::Ready),
            _ => mailbox.wait(context),
        }
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

    /// # Panics
    /// If an actor panicked.
    async fn finish(self) -> Vec<P> {
        self.answers.close();
        let mut processes = Vec::with_capacity(self.tasks.len());
        for (mailbox, task) in self.mailboxes.iter().zip(self.tasks) {
            mailbox.wake();
            processes.push(task.await.expect("an actor that has answered does not panic"));
        }
        processes
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
    fn actors_come_back_in_order_as_they_are_then_whether_they_ever_woke_or_not() {
        let run = async {
            let mut actors = Actors::spawn(vec![Adder(0), Adder(100), Adder(200)]);
            let job = Job {
                actor: ActorId(1),
                now: SimTime::ZERO,
                input: 5,
                output: 0,
            };
            actors.dispatch(&mut vec![Box::new(job)]).await;
            let sleepers = Actors::spawn(vec![Adder(7)]);
            (actors.finish().await, sleepers.finish().await)
        };
        let (woken, sleepers) = block_on(run).unwrap();
        let sums: Vec<u64> = woken.iter().chain(&sleepers).map(|adder| adder.0).collect();
        assert_eq!(sums, [0, 105, 200, 7]);
    }

    #[test]
    #[should_panic(expected = "an actor panicked")]
    fn a_run_does_not_wait_for_an_actor_that_panicked() {
        answers(&[&[(0, 1)], &[(0, 1), (1, 13), (2, 1)]]);
    }
}
