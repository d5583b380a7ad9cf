//! Where a run's future and its actors' tasks live: one thread, no clock.

use std::future::Future;
use std::io;

use tokio::runtime::{Builder, LocalOptions};

/// Runs `future`, and the actors that it spawns, on this thread to its end.
///
/// The runtime has neither timers nor input and output: simulated time is the scheduler's.
///
/// # Errors
/// If the operating system refuses the runtime what it needs.
pub fn block_on<F: Future>(future: F) -> io::Result<F::Output> {
    let mut builder = Builder::new_current_thread();
    // Nothing comes from outside: to look for it costs more than many a task.
    builder.event_interval(u32::MAX);
    let runtime = builder.build_local(LocalOptions::default())?;
    Ok(runtime.block_on(future))
}
