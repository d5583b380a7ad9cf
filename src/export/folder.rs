//! A results folder: what is in it, and how files get into it whole or not at all.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use xxhash_rust::xxh3::Xxh3;

use super::manifest::{FileEntry, Manifest};
use crate::metrics::Summary;

const MANIFEST: &str = "manifest.json";
/// The summary's file.
pub const SUMMARY: &str = "summary.json";
const TRIALS: &str = ".trials";

/// A folder that holds, or will hold, the results of one experiment.
#[derive(Clone, Debug)]
pub struct Folder {
    dir: PathBuf,
    /// The folder and those around it that were not there at first, from the inside out.
    new: Vec<PathBuf>,
}

/// What is in a folder.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant)] // There is one a folder.
pub enum Contents {
    /// Nothing, or there is no such folder yet.
    Nothing,
    /// The results of an experiment, finished or not.
    Results(Manifest),
}

/// A folder cannot hold results.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// It is a file.
    #[error("{} is not a folder: choose another with --out", .0.display())]
    NotAFolder(PathBuf),
    /// Something else is in it.
    #[error("{} holds files that are no results of desim ({found}): choose an empty folder with --out", dir.display())]
    Foreign {
        /// The folder.
        dir: PathBuf,
        /// One of the files.
        found: String,
    },
    /// Its manifest or its summary is not one.
    #[error("{} is damaged, or of another version ({reason}): choose another folder with --out", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// The file system refused.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// What was attempted.
        action: &'static str,
        /// On which file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
}

impl Folder {
    /// The folder at `dir`, which need not exist.
    #[must_use]
    pub fn new(dir: PathBuf) -> Self {
        let new = dir
            .ancestors()
            .take_while(|path| !path.as_os_str().is_empty() && !path.exists());
        let new = new.map(Path::to_owned).collect();
        Self { dir, new }
    }

    /// Its path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.dir
    }

    /// Where finished trials wait for the others, and files until they are whole.
    #[must_use]
    pub fn trials(&self) -> PathBuf {
        self.dir.join(TRIALS)
    }

    /// What is in it. Reads only.
    ///
    /// # Errors
    /// If it is no folder, or holds anything but results, or cannot be read.
    pub fn contents(&self) -> Result<Contents, FolderError> {
        let entries = match fs::read_dir(&self.dir) {
            Ok(entries) => entries,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Contents::Nothing),
            Err(error) if error.kind() == io::ErrorKind::NotADirectory => {
                return Err(FolderError::NotAFolder(self.dir.clone()));
            }
            Err(error) => return Err(failed("read", &self.dir)(error)),
        };
        let mut names = Vec::new();
        for entry in entries {
            names.push(
                entry
                    .map_err(failed("read", &self.dir))?
                    .file_name()
                    .to_string_lossy()
                    .into_owned(),
            );
        }
        if names.iter().any(|name| name == MANIFEST) {
            return self.read(MANIFEST).map(Contents::Results);
        }
        match names.iter().filter(|&name| name != TRIALS).min() {
            None => Ok(Contents::Nothing),
            Some(found) => Err(FolderError::Foreign {
                dir: self.dir.clone(),
                found: found.clone(),
            }),
        }
    }

    /// Puts a manifest in place. Like every file, it passes through [`trials`](Self::trials), which must be there.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn declare(&self, manifest: &Manifest) -> Result<(), FolderError> {
        self.stage(MANIFEST, &json(manifest))?;
        self.place(MANIFEST)
    }

    /// Deletes what `manifest` says that desim put here, and the folders that were not there before.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn clear(&self, manifest: &Manifest) -> Result<(), FolderError> {
        self.drop_trials()?;
        // A name with a separator never came from desim: it must not reach out of the folder.
        let named = manifest
            .files
            .keys()
            .filter(|name| !name.contains(['/', '\\']))
            .map(String::as_str);
        for name in named.chain([MANIFEST]) {
            let path = self.dir.join(name);
            gone(fs::remove_file(&path)).map_err(failed("delete", &path))?;
        }
        // Whatever else has come into them meanwhile keeps them.
        self.new
            .iter()
            .take_while(|path| fs::remove_dir(path).is_ok())
            .for_each(drop);
        Ok(())
    }

    /// Deletes the finished trials, which the tables hold by now.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn drop_trials(&self) -> Result<(), FolderError> {
        gone(fs::remove_dir_all(self.trials())).map_err(failed("delete", &self.trials()))
    }

    /// Writes a file that is to be [`place`](Self::place)d.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn stage(&self, name: &str, bytes: &[u8]) -> Result<(), FolderError> {
        let path = self.trials().join(name);
        let written = File::create(&path).and_then(|mut file| file.write_all(bytes));
        written.map_err(failed("write", &path))
    }

    /// Length and hash of a staged file.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn measure(&self, name: &str) -> Result<FileEntry, FolderError> {
        let path = self.trials().join(name);
        measure(&path).map_err(failed("read", &path))
    }

    /// Moves a staged file to its place, whole.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn place(&self, name: &str) -> Result<(), FolderError> {
        let path = self.dir.join(name);
        fs::rename(self.trials().join(name), &path).map_err(failed("write", &path))
    }

    /// The summary of finished results.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn summary(&self) -> Result<Summary, FolderError> {
        self.read(SUMMARY)
    }

    fn read<T: DeserializeOwned>(&self, name: &str) -> Result<T, FolderError> {
        let path = self.dir.join(name);
        let bytes = fs::read(&path).map_err(failed("read", &path))?;
        serde_json::from_slice(&bytes).map_err(|error| FolderError::Unreadable {
            path,
            reason: error.to_string(),
        })
    }
}

/// A value as an indented JSON document.
///
/// # Panics
/// Never, for the types of this module: their keys are text.
pub fn json(value: &impl serde::Serialize) -> Vec<u8> {
    let mut bytes = serde_json::to_vec_pretty(value).expect("keys are text");
    bytes.push(b'\n');
    bytes
}

/// An error to leave alone: what was to be deleted is not there.
pub fn gone(result: io::Result<()>) -> io::Result<()> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        other => other,
    }
}

/// Length and hash of a file, however large.
pub fn measure(path: &Path) -> io::Result<FileEntry> {
    let mut file = File::open(path)?;
    let (mut hash, mut bytes, mut chunk) = (Xxh3::new(), 0, vec![0; 1 << 16]);
    loop {
        let read = file.read(&mut chunk)?;
        if read == 0 {
            return Ok(FileEntry {
                bytes,
                xxh3_128: format!("{:032x}", hash.digest128()),
            });
        }
        hash.update(&chunk[..read]);
        bytes += read as u64;
    }
}

/// Says what failed on which file.
pub fn failed(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> FolderError {
    let path = path.to_owned();
    move |source| FolderError::Io { action, path, source }
}
