//! Trials spread over threads.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

use tokio_util::sync::CancellationToken;

/// How a set of trials ended, when none of them failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Every trial ran to its end.
    Finished,
    /// Somebody cancelled; the trials that were under way are dropped.
    Interrupted,
}

/// Runs `trials` on `jobs` threads and hands what each leaves to `finished`, on the calling thread, in the order in
/// which they finish.
///
/// `run` is called once a trial, on any thread; it should watch `stop` and give up early when it is cancelled, with
/// whatever error. No trial starts after `stop` is cancelled.
///
/// # Errors
/// The first error of `run` or of `finished`. It stops the other trials through `stop`, so pass a child token if
/// more is to run under the same one. Errors after a cancellation are those of dropped trials, and are dropped too.
pub fn run_trials<T, E>(
    trials: &[u32],
    jobs: NonZeroUsize,
    stop: &CancellationToken,
    run: impl Fn(u32) -> Result<T, E> + Sync,
    mut finished: impl FnMut(T) -> Result<(), E>,
) -> Result<Ending, E>
where
    T: Send,
    E: Send,
{
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    thread::scope(|scope| {
        for _ in 0..jobs.get().min(trials.len()) {
            let sender = sender.clone();
            scope.spawn(|| work(trials, &next, stop, &run, sender));
        }
        drop(sender);
        let mut done = 0;
        for result in receiver {
            if let Err(error) = result.and_then(&mut finished) {
                let cancelled_before = stop.is_cancelled();
                stop.cancel();
                if !cancelled_before {
                    return Err(error);
                }
            } else {
                done += 1;
            }
        }
        Ok(if done == trials.len() { Ending::Finished } else { Ending::Interrupted })
    })
}

/// Takes the next trial as long as there is one and nobody has cancelled.
fn work<T, E>(
    trials: &[u32],
    next: &AtomicUsize,
    stop: &CancellationToken,
    run: &(impl Fn(u32) -> Result<T, E> + Sync),
    results: mpsc::Sender<Result<T, E>>,
) {
    while !stop.is_cancelled() {
        let Some(&trial) = trials.get(next.fetch_add(1, Ordering::Relaxed)) else { return };
        if results.send(run(trial)).is_err() {
            return;
        }
    }
}
