//! Finished trials on disk, until all of an experiment's are there.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, BufWriter, Read, Seek, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3;

use crate::metrics::{Lists, TrialRecord};
use crate::spool::{Scratch, Section, Shape};
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
/// A file is a line of JSON whose numbers read back bit for bit, then the entries of the record's long lists, then a line with the XXH3-128 hash
/// of both. It is written under another name and renamed: whatever kills the process, a file that is there is whole, and one that has changed
/// since is noticed. The folder is locked while it is open, so that two processes never run the same experiment.
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
        let unfinished = path.with_extension("writing");
        write(&unfinished, part).map_err(failed("write", &unfinished))?;
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
        let file = File::open(&path).map_err(failed("read", &path))?;
        let part = read(file).map_err(|error| damaged(error.to_string()))?;
        if part.record.trial == trial {
            Ok(part)
        } else {
            Err(damaged(format!("it holds trial {}", part.record.trial)))
        }
    }

    fn path(&self, trial: u32) -> PathBuf {
        self.dir.join(format!("{trial:06}.trial"))
    }
}

/// The first line of a file.
#[derive(Serialize, Deserialize)]
struct Head<P> {
    /// The trial without its long lists.
    part: P,
    /// How long these are, in the order in which their entries follow.
    lists: Vec<Shape>,
}

fn write(path: &Path, part: &mut FinishedTrial) -> io::Result<()> {
    let mut lists = Lists::default();
    part.record.exchange(&mut lists);
    let written = write_apart(path, part, &mut lists);
    part.record.exchange(&mut lists);
    written
}

fn write_apart(path: &Path, part: &FinishedTrial, lists: &mut Lists) -> io::Result<()> {
    let mut file = Hashing::new(BufWriter::new(File::create(path)?));
    let lists = lists.all();
    let head = Head {
        part,
        lists: lists.iter().map(|list| list.shape()).collect(),
    };
    serde_json::to_writer(&mut file, &head)?;
    file.write_all(b"\n")?;
    for list in lists {
        list.write_to(&mut file)?;
    }
    let Hashing { mut inner, hash } = file;
    inner.write_all(&hash_line(&hash))?;
    inner.flush()
}

fn read(mut file: File) -> io::Result<FinishedTrial> {
    let length = file.metadata()?.len();
    let Some(end) = length.checked_sub(HASH_LINE) else {
        return Err(io::Error::other("it has no hash"));
    };
    let mut whole = Hashing::new(io::sink());
    io::copy(&mut (&mut file).take(end), &mut whole)?;
    let mut kept = Vec::new();
    file.read_to_end(&mut kept)?;
    if kept != hash_line(&whole.hash) {
        return Err(io::Error::other("it does not fit its hash"));
    }
    file.rewind()?;
    let mut line = Vec::new();
    BufReader::new(&file).read_until(b'\n', &mut line)?;
    let Head {
        mut part,
        lists: shapes,
    } = serde_json::from_slice::<Head<FinishedTrial>>(&line)?;
    let mut lists = Lists::default();
    let mut section = Section::of(file, line.len() as u64);
    if shapes.len() != lists.all().len() {
        return Err(io::Error::other("it holds other lists than a trial has"));
    }
    for (list, shape) in lists.all().into_iter().zip(shapes) {
        list.restore(shape, section.clone())?;
        section = section.after(shape.bytes());
    }
    part.record.exchange(&mut lists);
    Ok(part)
}

/// Bytes of [`hash_line`].
const HASH_LINE: u64 = 33;

/// The last line of a file.
fn hash_line(hash: &Xxh3) -> Vec<u8> {
    format!("{:032x}\n", hash.digest128()).into_bytes()
}

/// Hashes what goes through it.
struct Hashing<W> {
    inner: W,
    hash: Xxh3,
}

impl<W> Hashing<W> {
    fn new(inner: W) -> Self {
        Self {
            inner,
            hash: Xxh3::new(),
        }
    }
}

impl<W: Write> Write for Hashing<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.hash.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

fn failed(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> PartsError {
    let path = path.to_owned();
    move |source| PartsError::Io { action, path, source }
}
