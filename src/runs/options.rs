//! How trials are run.

use std::num::NonZeroUsize;

use tokio_util::sync::CancellationToken;

use crate::simulation::DriverKind;

/// How trials are run. Results do not depend on it.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// How many trials run at a time; `None` for one a processor.
    pub jobs: Option<NonZeroUsize>,
    /// How robots are run.
    pub driver: DriverKind,
    /// Whether results that are in the folder are deleted first, whatever they are of. What is no result of desim never is.
    pub replace: bool,
    /// Cancelled when somebody wants the run to stop; finished trials are kept. An error leaves it as it is.
    pub stop: CancellationToken,
}
