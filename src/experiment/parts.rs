//! Finished trials on disk, until all of an experiment's are there.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use super::part_file::{self, FinishedTrial, Key};
use crate::spool::Scratch;
use crate::text::shown;

/// A folder with one file a finished trial.
///
/// A file is written under a name of its own and renamed: whatever kills the process, a file that is there is whole, and one that has changed
/// since is noticed. Any number of processes may keep trials in one folder: what two of them have run is the same.
#[derive(Clone, Debug)]
pub struct Parts {
    dir: PathBuf,
    key: Key,
}

/// A folder of parts cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum PartsError {
    /// Another process has it.
    #[error("another desim is running these trials in {}", shown(.0))]
    Busy(PathBuf),
    /// The file system refused.
    #[error("cannot {action} {}: {source}", shown(path))]
    Io {
        /// What was attempted.
        action: &'static str,
        /// On which file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A file is not the trial that its name says.
    #[error("{} is not a finished trial: {reason}", shown(path))]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// Two folders have trials of one number that differ, which no seed explains.
    #[error(
        "trial {trial} in {} is not the same as in {}: a machine is at fault, or a protocol that is not deterministic",
        shown(&.folders[0]),
        shown(&.folders[1])
    )]
    Contradiction {
        /// Number of the trial.
        trial: u32,
        /// The folders.
        folders: [PathBuf; 2],
    },
}

impl Parts {
    /// The folder `dir`, which need not exist, for trials of `key`.
    #[must_use]
    pub fn at(dir: PathBuf, key: Key) -> Self {
        Self { dir, key }
    }

    /// The folder itself.
    #[must_use]
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Those of `trials` that are not here yet, in order. A file that cannot be read, or is of something else, counts as not here.
    #[must_use]
    pub fn missing(&self, trials: impl Iterator<Item = u32>) -> Vec<u32> {
        let is_missing = |trial: &u32| match self.verify(*trial) {
            Ok(()) => false,
            Err(error) => {
                tracing::debug!(trial, %error, "not finished");
                true
            }
        };
        trials.filter(is_missing).collect()
    }

    /// The trials for which there is a file, whatever is in it, in order.
    ///
    /// # Errors
    /// If the folder cannot be read. One that is not there has none.
    pub fn there(&self) -> Result<Vec<u32>, PartsError> {
        let mut numbers = Vec::new();
        let entries = match fs::read_dir(&self.dir) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(numbers),
            entries => entries.map_err(failed("read", &self.dir))?,
        };
        for entry in entries {
            let name = entry.map_err(failed("read", &self.dir))?.file_name();
            let number = name.to_str().and_then(|name| name.strip_suffix(ENDING)?.parse().ok());
            numbers.extend(number.filter(|number| name == *file_name(*number)));
        }
        numbers.sort_unstable();
        Ok(numbers)
    }

    /// Where trials that are under way keep what would fill the memory: in files without names, which leave no trace.
    #[must_use]
    pub fn scratch(&self) -> Scratch {
        Scratch::in_folder(&self.dir)
    }

    /// Keeps a finished trial.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn save(&self, part: &mut FinishedTrial) -> Result<(), PartsError> {
        let path = self.path(part.record.trial);
        replace(&self.dir, &path, |file| part_file::write(file, self.key, part)).map_err(failed("write", &path))
    }

    /// Reads a finished trial back.
    ///
    /// # Errors
    /// If it is not there, or not what its name says.
    pub fn load(&self, trial: u32) -> Result<FinishedTrial, PartsError> {
        let file = self.open(trial)?;
        let read = part_file::read(file).map_err(|error| self.damaged(trial, error.to_string()));
        let (of, part) = read?;
        self.identify(trial, of, part.record.trial)?;
        Ok(part)
    }

    /// Makes sure that the file of a trial is as it was written, and that trial's.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub(super) fn verify(&self, trial: u32) -> Result<(), PartsError> {
        let file = self.open(trial)?;
        let label = part_file::label(&file).map_err(|error| self.damaged(trial, error.to_string()))?;
        self.identify(trial, label.of, label.trial())
    }

    /// Opens the file of a trial, which fits its hash.
    fn open(&self, trial: u32) -> Result<File, PartsError> {
        let path = self.path(trial);
        if path.exists() && !path.is_file() {
            return Err(self.damaged(trial, "it is no file with an end".to_owned()));
        }
        let file = File::open(&path).map_err(failed("read", &path))?;
        part_file::verify(&file).map_err(|error| self.damaged(trial, error.to_string()))?;
        Ok(file)
    }

    /// Makes sure that what a file holds, a trial of something, is this trial of what is kept here.
    fn identify(&self, trial: u32, of: Key, there: u32) -> Result<(), PartsError> {
        if of != self.key {
            let reason = "it is of another scenario, or of another version or program";
            return Err(self.damaged(trial, reason.to_owned()));
        }
        if there != trial {
            return Err(self.damaged(trial, format!("it holds trial {there}")));
        }
        Ok(())
    }

    fn damaged(&self, trial: u32, reason: String) -> PartsError {
        PartsError::Damaged {
            path: self.path(trial),
            reason,
        }
    }

    fn path(&self, trial: u32) -> PathBuf {
        self.dir.join(file_name(trial))
    }
}

const ENDING: &str = ".trial";

fn file_name(trial: u32) -> String {
    format!("{trial:06}{ENDING}")
}

/// Writes a file whole or not at all: by `write`, in `dir` under a name that nobody else has, then moved to `path`. Others may do the same at
/// the same time.
///
/// # Errors
/// If the file system refuses.
pub fn replace<T>(dir: &Path, path: &Path, write: impl FnOnce(&File) -> io::Result<T>) -> io::Result<T> {
    let mut unfinished = tempfile::Builder::new();
    unfinished.prefix(".").suffix(".writing");
    // A temporary file is its owner's alone. This one is for whoever may read the folder.
    #[cfg(unix)]
    unfinished.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let unfinished = unfinished.tempfile_in(dir)?;
    let written = write(unfinished.as_file())?;
    unfinished.persist(path).map_err(|error| error.error)?;
    Ok(written)
}

/// Says what failed on which file.
pub(super) fn failed(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> PartsError {
    let path = path.to_owned();
    move |source| PartsError::Io { action, path, source }
}
