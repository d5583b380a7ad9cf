//! Where a run's future and its actors' tasks live: one thread, no clock.

use std::future::Future;
use std::io;

use tokio::runtime::{Builder, LocalOptions};

/// Nothing outside this thread ever wakes a task, so looking out for it can wait.
const POLLS_BETWEEN_EVENTS: u32 = 1 << 16;

/// Runs `future`, and the actors that it spawns, on this thread to its end.
///
/// The runtime has neither timers nor input and output: simulated time is the scheduler's.
///
/// # Errors
/// If the operating system refuses the runtime what it needs.
pub fn block_on<F: Future>(future: F) -> io::Result<F::Output> {
    let runtime = Builder::new_current_thread()
        .event_interval(POLLS_BETWEEN_EVENTS)
        .global_queue_interval(POLLS_BETWEEN_EVENTS)
        .build_local(LocalOptions::default())?;
    Ok(runtime.block_on(future))
}
