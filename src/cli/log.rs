//! The log, for those who look for a fault: on stderr, off unless `DESIM_LOG` asks for it.

use tracing_subscriber::EnvFilter;

use super::output::Log;

/// Starts the log. Directives that make no sense are ignored, since a log must not keep a run from starting.
pub fn to_stderr() {
    if let Ok(directives) = std::env::var("DESIM_LOG") {
        let filter = EnvFilter::builder().parse_lossy(directives);
        tracing_subscriber::fmt()
            .with_env_filter(filter)
            .with_ansi(false)
            .log_internal_errors(false)
            .with_writer(|| Log)
            .init();
    }
}
