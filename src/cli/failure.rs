//! Why a command is not done, and the exit status that says so.

use std::io;

use super::output::style;
use crate::experiment::{PartsError, TrialError};
use crate::export::{FolderError, ResultsError, WriteError};
use crate::runs::{Cause, MergeError, Other, RunsError};
use crate::scenario::Report;

/// Exit status where the input is wrong.
pub const FAULTY_INPUT: u8 = 2;
/// Exit status of an interrupted command.
pub const INTERRUPTED: u8 = 130;

/// Why a command is not done.
#[derive(Debug)]
pub enum Failure {
    /// The input is wrong; the message says how.
    Input(String),
    /// The input is wrong; this shows where, laid out.
    Drawn(String),
    /// The input is wrong, and the command has said how.
    Shown,
    /// What was validated differs, and the command has said where.
    Differs,
    /// Something else went wrong.
    Other(String),
    /// The user interrupted it; the message says what is kept.
    Interrupted(String),
}

impl Failure {
    /// The exit status.
    #[must_use]
    pub fn status(&self) -> u8 {
        match self {
            Self::Input(_) | Self::Drawn(_) | Self::Shown => FAULTY_INPUT,
            Self::Differs | Self::Other(_) => 1,
            Self::Interrupted(_) => INTERRUPTED,
        }
    }

    /// Something went wrong that the user did not ask for.
    pub fn other(error: &impl std::error::Error) -> Self {
        Self::Other(format!("error: {error}"))
    }
}

impl From<io::Error> for Failure {
    /// Of writing what was asked for.
    fn from(error: io::Error) -> Self {
        Self::Other(format!("error: cannot write: {error}"))
    }
}

impl From<Report> for Failure {
    fn from(report: Report) -> Self {
        Self::Drawn(report.render(style(&io::stderr())))
    }
}

impl From<FolderError> for Failure {
    fn from(error: FolderError) -> Self {
        match error {
            FolderError::Io { .. } => Self::other(&error),
            wrong => Self::Input(format!("error: {wrong}")),
        }
    }
}

impl From<PartsError> for Failure {
    fn from(error: PartsError) -> Self {
        match error {
            PartsError::Busy(_) => Self::Input(format!("error: {error}")),
            PartsError::Io { .. } | PartsError::Damaged { .. } | PartsError::Contradiction { .. } => {
                Self::other(&error)
            }
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

impl From<MergeError> for Failure {
    fn from(error: MergeError) -> Self {
        match error {
            MergeError::Runs(error) => error.into(),
            wrong => Self::Input(format!("error: {wrong}")),
        }
    }
}

impl From<RunsError> for Failure {
    fn from(error: RunsError) -> Self {
        let words = match &error {
            // What is left is said with what to do about it.
            RunsError::Taken { of: Other::Setting, .. } => format!("error: {error}\nChoose another folder with --out."),
            RunsError::Taken { .. } => {
                format!("error: {error}\nChoose another folder with --out, or replace them with --force.")
            }
            RunsError::Interrupted { kept: 0, .. } => error.to_string(),
            RunsError::Interrupted { .. } => format!("{error}; run the same command to go on"),
            // It would be so in any trial.
            RunsError::Trial {
                source: TrialError::Deploy(error),
                ..
            } => format!("error: {error}"),
            error => format!("error: {error}"),
        };
        match error.cause() {
            Cause::Input => Self::Input(words),
            Cause::Interruption => Self::Interrupted(words),
            Cause::Other => Self::Other(words),
        }
    }
}
