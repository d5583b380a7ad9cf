//! A folder of results, whatever they are of: what can go wrong with it, and how it is left as it was found.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::experiment::PartsError;
use crate::text::{is_unsafe, shown};

/// A folder cannot hold results, or those in it cannot be shown.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// It is a file.
    #[error("{} is not a folder: choose another with --out", shown(.0))]
    NotAFolder(PathBuf),
    /// Something else is in it.
    #[error(
        "{} holds files that are no results of desim ({found}): choose an empty folder with --out",
        shown(dir)
    )]
    Foreign {
        /// The folder.
        dir: PathBuf,
        /// One of the files.
        found: String,
    },
    /// A file is not the one that desim wrote.
    #[error("{} {wrong}: restore it, or make the results again with --force", shown(path))]
    Altered {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        wrong: String,
    },
    /// A file is none of desim's, but would be taken for a table of the results.
    #[error("{} is no file of these results: move it out of the folder", shown(.0))]
    Stranger(PathBuf),
    /// The page of charts is not the one that desim wrote.
    #[error("{} is another page than desim wrote: make it again with `desim report`, or delete it", shown(.0))]
    Page(PathBuf),
    /// A file is as it was written, by another version.
    #[error("{} is of another version ({reason}; desim {there} there, {} now): report it with the version that made it, or make the results again with --force", shown(path), env!("CARGO_PKG_VERSION"))]
    Version {
        /// The file.
        path: PathBuf,
        /// What is unknown about it.
        reason: String,
        /// The version that made it.
        there: String,
    },
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
}

impl FolderError {
    /// A file of the version `there` that this one cannot make sense of.
    pub(super) fn version(path: &Path, reason: &impl ToString, there: &str) -> Self {
        Self::Version {
            path: path.to_owned(),
            reason: reason.to_string(),
            there: there.to_owned(),
        }
    }
}

/// Results could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// A finished trial cannot be read back.
    #[error(transparent)]
    Parts(#[from] PartsError),
    /// A file cannot be written.
    #[error(transparent)]
    Folder(#[from] FolderError),
}

impl WriteError {
    /// Whether the place takes no files from this user, rather than that something went wrong.
    #[must_use]
    pub fn is_refused(&self) -> bool {
        let (Self::Parts(PartsError::Io { source, .. }) | Self::Folder(FolderError::Io { source, .. })) = self else {
            return false;
        };
        matches!(
            source.kind(),
            io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem
        )
    }
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

    /// Names of all that is in it, in order; none if there is no such folder.
    pub fn names(&self) -> Result<Vec<String>, FolderError> {
        let entries = match fs::read_dir(&self.dir) {
            Ok(entries) => entries,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            Err(error) if error.kind() == io::ErrorKind::NotADirectory => {
                return Err(FolderError::NotAFolder(self.dir.clone()));
            }
            Err(error) => return Err(failed("read", &self.dir)(error)),
        };
        let mut names = Vec::new();
        for entry in entries {
            let name = entry.map_err(failed("read", &self.dir))?.file_name();
            names.push(name.to_string_lossy().into_owned());
        }
        names.sort_unstable();
        Ok(names)
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

/// A value as an indented JSON document. What a terminal would obey, or nobody would see, is escaped in it.
///
/// # Panics
/// Never, for the types of this module: their keys are text.
pub fn json(value: &impl serde::Serialize) -> Vec<u8> {
    let text = serde_json::to_string_pretty(value).expect("keys are text");
    let mut document = String::with_capacity(text.len() + 1);
    for letter in text.chars() {
        // Below, JSON's own escapes serve.
        if letter >= '\u{7f}' && is_unsafe(letter) {
            let escape = |unit: &u16| format!("\\u{unit:04x}");
            document.extend(letter.encode_utf16(&mut [0; 2]).iter().map(escape));
        } else {
            document.push(letter);
        }
    }
    document.push('\n');
    document.into_bytes()
}

/// An error to leave alone: what was to be deleted is not there.
pub fn gone(result: io::Result<()>) -> io::Result<()> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        other => other,
    }
}

/// Deletes a folder and all that is in it, if it is there. A process that has not noticed yet may put something into it meanwhile.
pub fn delete_folder(path: &Path) -> Result<(), FolderError> {
    const TRIES: u32 = 10;
    for _ in 1..TRIES {
        match gone(fs::remove_dir_all(path)) {
            Err(error) if error.kind() == io::ErrorKind::DirectoryNotEmpty => {}
            done => return done.map_err(failed("delete", path)),
        }
    }
    gone(fs::remove_dir_all(path)).map_err(failed("delete", path))
}

/// Says what failed on which file.
pub fn failed(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> FolderError {
    let path = path.to_owned();
    move |source| FolderError::Io { action, path, source }
}
