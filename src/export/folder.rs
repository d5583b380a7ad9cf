//! A results folder: what is in it, and how files get into it whole or not at all.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use xxhash_rust::xxh3::Xxh3;

use super::manifest::{FileEntry, Manifest};
use super::place::{FolderError, Place, failed, gone, json};
use crate::metrics::Summary;

const MANIFEST: &str = "manifest.json";
/// The summary's file.
pub const SUMMARY: &str = "summary.json";
const TRIALS: &str = ".trials";

/// A folder that holds, or will hold, the results of one experiment.
#[derive(Clone, Debug)]
pub struct Folder {
    place: Place,
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

impl Folder {
    /// The folder at `dir`, which need not exist.
    #[must_use]
    pub fn new(dir: PathBuf) -> Self {
        Self { place: Place::new(dir) }
    }

    /// Its path.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.place.path()
    }

    /// Where finished trials wait for the others, and files until they are whole.
    #[must_use]
    pub fn trials(&self) -> PathBuf {
        self.path().join(TRIALS)
    }

    /// What is in it. Reads only.
    ///
    /// # Errors
    /// If it is no folder, or holds anything but results, or cannot be read.
    pub fn contents(&self) -> Result<Contents, FolderError> {
        let entries = match fs::read_dir(self.path()) {
            Ok(entries) => entries,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Contents::Nothing),
            Err(error) if error.kind() == io::ErrorKind::NotADirectory => {
                return Err(FolderError::NotAFolder(self.path().to_owned()));
            }
            Err(error) => return Err(failed("read", self.path())(error)),
        };
        let mut names = Vec::new();
        for entry in entries {
            names.push(
                entry
                    .map_err(failed("read", self.path()))?
                    .file_name()
                    .to_string_lossy()
                    .into_owned(),
            );
        }
        if names.iter().any(|name| name == MANIFEST) {
            return self.place.read(MANIFEST).map(Contents::Results);
        }
        match names.iter().filter(|&name| name != TRIALS).min() {
            None => Ok(Contents::Nothing),
            Some(found) => Err(FolderError::Foreign {
                dir: self.path().to_owned(),
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
            self.place.delete(name)?;
        }
        self.place.leave();
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
        let path = self.path().join(name);
        fs::rename(self.trials().join(name), &path).map_err(failed("write", &path))
    }

    /// The summary of finished results.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn summary(&self) -> Result<Summary, FolderError> {
        self.place.read(SUMMARY)
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
