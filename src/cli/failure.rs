//! Why a command is not done, and the exit status that says so.

use std::io;

use crate::experiment::PartsError;
use crate::export::{FolderError, ResultsError, WriteError};
use crate::scenario::Report;

/// Exit status of an interrupted command.
pub const INTERRUPTED: u8 = 130;

/// Why a command is not done.
#[derive(Debug)]
pub enum Failure {
    /// The input is wrong; the message says how.
    Input(String),
    /// The input is wrong, and the command has said how.
    Shown,
    /// Something else went wrong.
    Other(String),
    /// The user interrupted it; the message says what is kept.
    Interrupted(String),
    /// Nobody reads the output any more, which is no fault.
    PipeClosed,
}

impl Failure {
    /// What to say on stderr, if there is anything left to say.
    #[must_use]
    pub fn message(&self) -> Option<&str> {
        match self {
            Self::Input(message) | Self::Other(message) | Self::Interrupted(message) => Some(message.trim_end()),
            Self::Shown | Self::PipeClosed => None,
        }
    }

    /// The exit status.
    #[must_use]
    pub fn status(&self) -> u8 {
        match self {
            Self::Input(_) | Self::Shown => 2,
            Self::Other(_) => 1,
            Self::Interrupted(_) => INTERRUPTED,
            Self::PipeClosed => 0,
        }
    }

    /// Something went wrong that the user did not ask for.
    pub fn other(error: &impl std::error::Error) -> Self {
        Self::Other(format!("error: {error}"))
    }
}

impl From<io::Error> for Failure {
    /// Of writing to stdout.
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            Self::PipeClosed
        } else {
            Self::Other(format!("error: cannot write to standard output: {error}"))
        }
    }
}

impl From<Report> for Failure {
    fn from(report: Report) -> Self {
        Self::Input(report.render(super::check::style(&io::stderr())))
    }
}

impl From<FolderError> for Failure {
    fn from(error: FolderError) -> Self {
        match error {
            FolderError::NotAFolder(_) | FolderError::Foreign { .. } | FolderError::Unreadable { .. } => {
                Self::Input(format!("error: {error}"))
            }
            FolderError::Io { .. } => Self::other(&error),
        }
    }
}

impl From<PartsError> for Failure {
    fn from(error: PartsError) -> Self {
        match error {
            PartsError::Busy(_) => Self::Input(format!("error: {error}")),
            PartsError::Io { .. } | PartsError::Damaged { .. } => Self::other(&error),
        }
    }
}

impl From<ResultsError> for Failure {
    fn from(error: ResultsError) -> Self {
        match error {
            ResultsError::Folder(error) => error.into(),
            wrong => Self::Input(format!("error: {wrong}")),
        }
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        match error {
            WriteError::Parts(error) => error.into(),
            WriteError::Folder(error) => error.into(),
        }
    }
}
