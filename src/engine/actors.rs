//! The actors driver: every actor is a tokio task with a mailbox.
//!
//! All tasks live on the caller's thread. A simulated instant has one order of events, so threads inside a run
//! would only wait for each other; trials are what runs in parallel.

use tokio::runtime::{Builder, LocalRuntime};
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};

use super::process::{Driver, JobOf, Process};

type Mail<P> = (usize, Box<JobOf<P>>);

/// Wakes each actor's task through its mailbox and waits for the answers.
pub struct Actors<P: Process> {
    mailboxes: Vec<UnboundedSender<Mail<P>>>,
    answers: UnboundedReceiver<Mail<P>>,
    returned: Vec<Option<Box<JobOf<P>>>>,
    runtime: LocalRuntime,
}

impl<P> Actors<P>
where
    P: Process + 'static,
    P::Input: 'static,
    P::Output: 'static,
{
    /// Spawns one task for each of `processes`, the actors in order of their ids.
    ///
    /// # Errors
    /// If the operating system refuses the runtime what it needs.
    pub fn spawn(processes: Vec<P>) -> std::io::Result<Self> {
        let runtime = Builder::new_current_thread().build_local(tokio::runtime::LocalOptions::default())?;
        let (answer, answers) = unbounded_channel();
        let mailboxes = processes
            .into_iter()
            .map(|process| {
                let (mailbox, mail) = unbounded_channel();
                runtime.spawn_local(live(process, mail, answer.clone()));
                mailbox
            })
            .collect();
        Ok(Self {
            mailboxes,
            answers,
            returned: Vec::new(),
            runtime,
        })
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
    fn dispatch(&mut self, jobs: &mut Vec<Box<JobOf<P>>>) {
        let pending = jobs.len();
        self.returned.resize_with(pending, || None);
        for (slot, job) in jobs.drain(..).enumerate() {
            let delivered = self.mailboxes[job.actor.index()].send((slot, job));
            assert!(delivered.is_ok(), "an actor ended before its run did");
        }
        let Self {
            runtime,
            answers,
            returned,
            ..
        } = self;
        runtime.block_on(async {
            for _ in 0..pending {
                let (slot, job) = answers
                    .recv()
                    .await
                    .expect("the driver holds the actors' tasks, so a sender lives");
                returned[slot] = Some(job);
            }
        });
        jobs.extend(returned.drain(..).flatten());
    }
}
