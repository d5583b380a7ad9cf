//! The actors driver: every actor is a tokio task with a mailbox.
//!
//! All tasks live on the caller's thread. A simulated instant has one order of events, so threads inside a run
//! would only wait for each other; trials are what runs in parallel.

use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::task::spawn_local;

use super::process::{Driver, JobOf, Process};

type Mail<P> = (usize, Box<JobOf<P>>);

/// Wakes each actor's task through its mailbox and waits for the answers.
pub struct Actors<P: Process> {
    mailboxes: Vec<UnboundedSender<Mail<P>>>,
    answers: UnboundedReceiver<Mail<P>>,
    returned: Vec<Option<Box<JobOf<P>>>>,
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
        let (answer, answers) = unbounded_channel();
        let mailboxes = processes
            .into_iter()
            .map(|process| {
                let (mailbox, mail) = unbounded_channel();
                spawn_local(live(process, mail, answer.clone()));
                mailbox
            })
            .collect();
        Self {
            mailboxes,
            answers,
            returned: Vec::new(),
        }
    }
}

/// An actor's life: read mail, answer it, until the mailbox closes.
async fn live<P: Process>(mut process: P, mut mail: UnboundedReceiver<Mail<P>>, answer: UnboundedSender<Mail<P>>) {
    while let Some((slot, mut job)) = mail.recv().await {
        process.handle(job.now, &mut job.input, &mut job.output);
        if answer.send((slot, job)).is_err() {
            return;
        }
    }
}

impl<P: Process> Driver<P> for Actors<P> {
    /// # Panics
    /// If an actor panicked: its answer never comes.
    async fn dispatch(&mut self, jobs: &mut Vec<Box<JobOf<P>>>) {
        let pending = jobs.len();
        self.returned.resize_with(pending, || None);
        for (slot, job) in jobs.drain(..).enumerate() {
            let delivered = self.mailboxes[job.actor.index()].send((slot, job));
            assert!(delivered.is_ok(), "an actor ended before its run did");
        }
        for _ in 0..pending {
            let (slot, job) = self.answers.recv().await.expect("every actor answers its mail");
            self.returned[slot] = Some(job);
        }
        jobs.extend(self.returned.drain(..).flatten());
    }
}
