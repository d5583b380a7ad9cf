//! A folder of results, whatever they are of: what can go wrong with it, how its files are read, and how it is left as it was found.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

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

/// A folder, which need not exist.
#[derive(Clone, Debug)]
pub struct Place {
    dir: PathBuf,
    /// The folder and those around it that were not there at first, from the inside out.
    new: Vec<PathBuf>,
}

impl Place {
    /// The folder at `dir`.
    pub fn new(dir: PathBuf) -> Self {
        let new = dir
            .ancestors()
            .take_while(|path| !path.as_os_str().is_empty() && !path.exists());
        let new = new.map(Path::to_owned).collect();
        Self { dir, new }
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.dir
    }

    /// Reads the JSON document `name`, which is there.
    pub fn read<T: DeserializeOwned>(&self, name: &str) -> Result<T, FolderError> {
        let path = self.dir.join(name);
        let bytes = fs::read(&path).map_err(failed("read", &path))?;
        parsed(path, &bytes)
    }

    /// Reads the JSON document `name`, if it is there.
    pub fn find<T: DeserializeOwned>(&self, name: &str) -> Result<Option<T>, FolderError> {
        let path = self.dir.join(name);
        match fs::read(&path) {
            Ok(bytes) => parsed(path, &bytes).map(Some),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) if error.kind() == io::ErrorKind::NotADirectory => {
                Err(FolderError::NotAFolder(self.dir.clone()))
            }
            Err(error) => Err(failed("read", &path)(error)),
        }
    }

    /// Deletes the file `name`, if it is there.
    pub fn delete(&self, name: &str) -> Result<(), FolderError> {
        let path = self.dir.join(name);
        gone(fs::remove_file(&path)).map_err(failed("delete", &path))
    }

    /// Deletes the folders that were not there at first. Whatever else has come into them meanwhile keeps them.
    pub fn leave(&self) {
        self.new
            .iter()
            .take_while(|path| fs::remove_dir(path).is_ok())
            .for_each(drop);
    }
}

fn parsed<T: DeserializeOwned>(path: PathBuf, bytes: &[u8]) -> Result<T, FolderError> {
    serde_json::from_slice(bytes).map_err(|error| FolderError::Unreadable {
        path,
        reason: error.to_string(),
    })
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

/// Says what failed on which file.
pub fn failed(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> FolderError {
    let path = path.to_owned();
    move |source| FolderError::Io { action, path, source }
}
