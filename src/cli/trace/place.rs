//! Where a trace goes: whole or not at all, and over nothing but another trace.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};

use super::super::failure::Failure;
use super::super::finished_trial::refuse;
use super::super::output;
use crate::export::trace::{Format, NAME, TABLES};
use crate::text::shown;

/// The place of a trace that is being written beside it. What is unfinished goes when this does.
#[derive(Debug)]
pub struct Place {
    /// Where it is to be; `None` for standard output.
    path: Option<PathBuf>,
    unfinished: PathBuf,
    is_folder: bool,
}

impl Place {
    /// That of a trace of trial number `trial` of the results in `dir`, or what was `asked` for.
    ///
    /// # Errors
    /// If something else is there, or the file system refuses.
    pub fn of(dir: &Path, trial: u32, format: Format, asked: Option<&Path>) -> Result<Self, Failure> {
        let is_folder = format.ending().is_none();
        let to_output = asked == Some(Path::new("-"));
        if to_output && is_folder {
            return refuse("tables are a folder and cannot go to standard output: give a folder with --out");
        }
        let path = asked
            .filter(|_| !to_output)
            .map_or_else(|| dir.join(name(trial, format)), Path::to_owned);
        if !to_output {
            check(&path, format)?;
        }
        let unfinished = beside(&path).ok_or_else(|| {
            Failure::Input(format!(
                "error: {} cannot be written to: give a file with --out",
                shown(&path)
            ))
        })?;
        let place = Self {
            path: (!to_output).then_some(path),
            unfinished,
            is_folder,
        };
        place.clear();
        if is_folder {
            fs::create_dir(&place.unfinished).map_err(|error| place.failed(&error))?;
        }
        Ok(place)
    }

    /// Where to write it.
    pub fn unfinished(&self) -> &Path {
        &self.unfinished
    }

    /// That it cannot be written.
    pub fn failed(&self, error: &io::Error) -> Failure {
        let path = self.path.as_deref().unwrap_or(Path::new("-"));
        Failure::Other(format!("error: cannot write {}: {error}", shown(path)))
    }

    /// Puts the whole trace where it is to be, and answers what that is called, unless it went to standard output.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn keep(self) -> Result<Option<String>, Failure> {
        let Some(path) = &self.path else {
            let copied = File::open(&self.unfinished).and_then(|mut file| {
                let mut out = output::stdout();
                io::copy(&mut file, &mut out).and_then(|_| out.flush())
            });
            return copied.map(|()| None).map_err(|error| self.failed(&error));
        };
        let cleared = if self.is_folder && path.exists() {
            fs::remove_dir_all(path)
        } else {
            Ok(())
        };
        cleared
            .and_then(|()| fs::rename(&self.unfinished, path))
            .map_err(|error| self.failed(&error))?;
        Ok(Some(shown(path)))
    }

    /// Removes what an earlier attempt left.
    fn clear(&self) {
        let _ = if self.unfinished.is_dir() {
            fs::remove_dir_all(&self.unfinished)
        } else {
            fs::remove_file(&self.unfinished)
        };
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        self.clear();
    }
}

/// What a trace in a results folder is called.
fn name(trial: u32, format: Format) -> String {
    let name = match trial {
        0 => NAME.to_owned(),
        other => format!("{NAME}-{other}"),
    };
    match format.ending() {
        Some(ending) => format!("{name}.{ending}"),
        None => name,
    }
}

/// Whether a trace may go to `path`.
fn check(path: &Path, format: Format) -> Result<(), Failure> {
    let refused = |what: &str| refuse(format!("{} {what}: choose another place with --out", shown(path)));
    let Ok(there) = fs::metadata(path) else {
        return if path.is_symlink() {
            refused("is a link to nothing")
        } else {
            Ok(())
        };
    };
    match format.ending() {
        None if !there.is_dir() => refused("is no folder"),
        None => {
            let names = fs::read_dir(path).map(|entries| entries.flatten().map(|entry| entry.file_name()));
            let is_own = |name: OsString| TABLES.iter().any(|table| name == *table);
            match names.map(|mut names| names.all(is_own)) {
                Ok(true) => Ok(()),
                Ok(false) => refused("holds something else than a trace"),
                Err(error) => Err(error.into()),
            }
        }
        Some(ending) if there.is_dir() => refused(&format!("is a folder, and a trace as {ending} is a file")),
        Some(_) if !there.is_file() => refused("is no file"),
        Some(_) => {
            let mut beginning = Vec::new();
            File::open(path)?.take(16).read_to_end(&mut beginning)?;
            let is_one = beginning.is_empty() || format.begins_with(&beginning);
            if is_one {
                Ok(())
            } else {
                refused("is no trace of this format")
            }
        }
    }
}

fn beside(path: &Path) -> Option<PathBuf> {
    let mut unfinished = OsString::from(".");
    unfinished.push(path.file_name()?);
    unfinished.push(".unfinished");
    Some(path.with_file_name(unfinished))
}
