//! Why a run into a folder has no results.

use std::path::PathBuf;

use crate::experiment::{ExperimentError, PartsError, TrialError};
use crate::export::{FolderError, WriteError};
use crate::text::shown;

/// Why there are no results.
#[derive(Debug, thiserror::Error)]
pub enum RunsError {
    /// The folder holds other results, or trials of others.
    #[error("{} holds {}:\n  {}", shown(dir), of.words(), differences.join("\n  "))]
    Taken {
        /// The folder.
        dir: PathBuf,
        /// Of what.
        of: Other,
        /// What differs, a line each.
        differences: Vec<String>,
    },
    /// Somebody cancelled.
    #[error("{}", interrupted(*kept, *trials, dir))]
    Interrupted {
        /// How many trials are kept. If none are, nothing is left in the folder.
        kept: usize,
        /// How many there are to be.
        trials: u32,
        /// The folder.
        dir: PathBuf,
    },
    /// A trial failed. Others that had finished are kept.
    #[error("trial {trial}: {source}")]
    Trial {
        /// Its number.
        trial: u32,
        /// Why.
        source: TrialError,
    },
    /// The folder cannot hold results, or those in it are not as they were written.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// Finished trials cannot be kept or read back.
    #[error(transparent)]
    Parts(#[from] PartsError),
}

/// Of what a folder holds results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Other {
    /// Of another scenario.
    Scenario,
    /// Of another study.
    Study,
    /// A setting's folder: of a scenario that is none of the study's.
    Setting,
}

/// Who can do something about an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// Whoever chose the scenario, the study or the folder.
    Input,
    /// Whoever cancelled: the same run goes on where it stopped.
    Interruption,
    /// The machine, or desim.
    Other,
}

impl RunsError {
    /// Who can do something about it.
    #[must_use]
    pub fn cause(&self) -> Cause {
        match self {
            Self::Interrupted { .. } => Cause::Interruption,
            Self::Folder(FolderError::Io { .. })
            | Self::Parts(PartsError::Io { .. } | PartsError::Damaged { .. } | PartsError::Contradiction { .. })
            | Self::Trial {
                source: TrialError::Run(_) | TrialError::Counted(_),
                ..
            } => Cause::Other,
            Self::Taken { .. }
            | Self::Folder(_)
            | Self::Parts(PartsError::Busy(_))
            | Self::Trial {
                source: TrialError::Deploy(_),
                ..
            } => Cause::Input,
        }
    }
}

impl Other {
    const fn words(self) -> &'static str {
        match self {
            Self::Scenario => "results of another experiment",
            Self::Study => "results of another study",
            Self::Setting => "results that are not this study's",
        }
    }
}

fn interrupted(kept: usize, trials: u32, dir: &std::path::Path) -> String {
    if kept == 0 {
        return "interrupted before a trial had finished; nothing is kept".to_owned();
    }
    format!("interrupted: {kept} of {trials} trials are kept in {}", shown(dir))
}

impl From<ExperimentError<TrialError>> for RunsError {
    fn from(error: ExperimentError<TrialError>) -> Self {
        match error {
            ExperimentError::Trial { trial, source } => Self::Trial { trial, source },
            ExperimentError::Parts(error) => Self::Parts(error),
        }
    }
}

impl From<WriteError> for RunsError {
    fn from(error: WriteError) -> Self {
        match error {
            WriteError::Parts(error) => Self::Parts(error),
            WriteError::Folder(error) => Self::Folder(error),
        }
    }
}
