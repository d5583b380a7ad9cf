//! Finished trials on disk, until all of an experiment's are there.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::xxh3_128;

use crate::metrics::TrialRecord;
use crate::text::shown;

/// A trial and what it took.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FinishedTrial {
    /// Wall time that its thread spent on it, seconds. Depends on the machine: for the manifest only.
    pub wall_s: f64,
    /// What it left behind.
    pub record: TrialRecord,
}

/// A folder with one file a finished trial.
///
/// A file is a line of JSON whose numbers read back bit for bit, and a line with the XXH3-128 hash of that, written under another
/// name and renamed: whatever kills the process, a file that is there is whole, and one that has changed since is noticed. The folder is locked while it is open, so that two processes never run
/// the same experiment.
#[derive(Debug)]
pub struct Parts {
    dir: PathBuf,
    _lock: File,
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
}

impl Parts {
    /// Opens the folder `dir`, made if need be, and locks it until the value is dropped.
    ///
    /// # Errors
    /// If another process has it open, or it cannot be made or written.
    pub fn open(dir: &Path) -> Result<Self, PartsError> {
        fs::create_dir_all(dir).map_err(failed("create the folder", dir))?;
        let path = dir.join("lock");
        let lock = File::create(&path).map_err(failed("create", &path))?;
        match lock.try_lock() {
            Ok(()) => Ok(Self {
                dir: dir.to_owned(),
                _lock: lock,
            }),
            Err(fs::TryLockError::WouldBlock) => Err(PartsError::Busy(dir.to_owned())),
            Err(fs::TryLockError::Error(source)) => Err(failed("lock", &path)(source)),
        }
    }

    /// The folder itself.
    #[must_use]
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Those of the first `trials` trials of an experiment with `seed` that are not here yet, in order. A file that
    /// cannot be read counts as not here.
    #[must_use]
    pub fn missing(&self, trials: u32, seed: u64) -> Vec<u32> {
        (0..trials)
            .filter(|&trial| match self.load(trial) {
                Ok(part) => part.record.seed != seed,
                Err(error) => {
                    tracing::debug!(trial, %error, "not finished");
                    true
                }
            })
            .collect()
    }

    /// Keeps a finished trial.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn save(&self, part: &FinishedTrial) -> Result<(), PartsError> {
        let path = self.path(part.record.trial);
        let unfinished = path.with_extension("writing");
        write_json(&unfinished, part).map_err(failed("write", &unfinished))?;
        fs::rename(&unfinished, &path).map_err(failed("write", &path))
    }

    /// Reads a finished trial back.
    ///
    /// # Errors
    /// If it is not there, or not what its name says.
    pub fn load(&self, trial: u32) -> Result<FinishedTrial, PartsError> {
        let path = self.path(trial);
        let damaged = |reason: String| PartsError::Damaged {
            path: path.clone(),
            reason,
        };
        if path.exists() && !path.is_file() {
            return Err(damaged("it is no file with an end".to_owned()));
        }
        let bytes = fs::read(&path).map_err(failed("read", &path))?;
        let line = bytes
            .iter()
            .position(|byte| *byte == b'\n')
            .map_or(bytes.len(), |end| end + 1);
        let (json, hash) = bytes.split_at(line);
        if hash != hash_line(json) {
            return Err(damaged("it does not fit its hash".to_owned()));
        }
        let part: FinishedTrial = serde_json::from_slice(json).map_err(|error| damaged(error.to_string()))?;
        if part.record.trial == trial {
            Ok(part)
        } else {
            Err(damaged(format!("it holds trial {}", part.record.trial)))
        }
    }

    fn path(&self, trial: u32) -> PathBuf {
        self.dir.join(format!("{trial:06}.json"))
    }
}

fn write_json(path: &Path, part: &FinishedTrial) -> io::Result<()> {
    let mut bytes = serde_json::to_vec(part)?;
    bytes.push(b'\n');
    let hash = hash_line(&bytes);
    bytes.extend(hash);
    File::create(path)?.write_all(&bytes)
}

/// The line that follows on `json`.
fn hash_line(json: &[u8]) -> Vec<u8> {
    format!("{:032x}\n", xxh3_128(json)).into_bytes()
}

fn failed(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> PartsError {
    let path = path.to_owned();
    move |source| PartsError::Io { action, path, source }
}
