//! Ctrl-C and SIGTERM.

use std::io;
use std::process;
use std::thread;

use tokio::runtime::Builder;
use tokio::signal::unix::{Signal, SignalKind, signal};
use tokio_util::sync::CancellationToken;

use super::failure::INTERRUPTED;

/// Cancels `stop` at the first Ctrl-C or SIGTERM from now on; the second ends the process at once, which loses
/// nothing that is finished.
///
/// # Errors
/// If the system does not let signals be watched.
pub fn cancels(stop: &CancellationToken) -> io::Result<()> {
    let runtime = Builder::new_current_thread().enable_io().build()?;
    let kinds = [SignalKind::interrupt(), SignalKind::terminate()];
    for kind in kinds {
        let watched = {
            let _inside = runtime.enter();
            signal(kind)?
        };
        runtime.spawn(watch(watched, stop.clone()));
    }
    thread::Builder::new()
        .name("signals".to_owned())
        .spawn(move || runtime.block_on(std::future::pending::<()>()))?;
    Ok(())
}

async fn watch(mut signal: Signal, stop: CancellationToken) {
    while signal.recv().await.is_some() {
        if stop.is_cancelled() {
            process::exit(INTERRUPTED.into());
        }
        stop.cancel();
    }
}
