//! A results folder: what is in it, how files get into it whole or not at all, and whether they are still those that were put there.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use super::Tables;
use super::files::{MANIFEST, PAGE, PICTURES, REPLAY, SUMMARY, TRACE_TABLES, is_trace, shows};
use super::held::{FileEntry, document, held, measure, sealed, unseal};
use super::manifest::Manifest;
use super::place::{FolderError, Place, WriteError, delete_folder, failed};
use crate::experiment::{Claim, Parts, replace};
use crate::metrics::Summary;

/// Where finished trials wait for the others, and files until they are whole.
pub(super) const TRIALS: &str = ".trials";

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

    /// The trials for which there is a page to watch them on, each with the page's name.
    #[must_use]
    pub fn replays(&self) -> Vec<(u32, String)> {
        let names = self.place.names().unwrap_or_default();
        let pages = names.into_iter().filter(|name| self.path().join(name).is_file());
        pages.filter_map(|name| Some((shows(&name)?, name))).collect()
    }

    /// Where finished trials wait for the others, and files until they are whole.
    #[must_use]
    pub fn trials(&self) -> PathBuf {
        self.path().join(TRIALS)
    }

    /// What is in it, by a manifest that is as it was written. Reads only.
    ///
    /// # Errors
    /// If it is no folder, or holds anything but results, or cannot be read.
    pub fn contents(&self) -> Result<Contents, FolderError> {
        let names = self.place.names()?;
        if names.iter().any(|name| name == MANIFEST) {
            return unseal(self.path(), MANIFEST).map(Contents::Results);
        }
        match names.into_iter().find(|name| name != TRIALS) {
            None => Ok(Contents::Nothing),
            Some(found) => Err(self.foreign(found)),
        }
    }

    fn foreign(&self, found: String) -> FolderError {
        FolderError::Foreign {
            dir: self.path().to_owned(),
            found,
        }
    }

    /// Holds every file of finished results against `manifest`, but for the page of charts, and answers the contents of those
    /// that are `wanted`.
    ///
    /// # Errors
    /// The file that is not the one that was written, or that is there though none of that name was.
    pub fn held(&self, manifest: &Manifest, wanted: &[&str]) -> Result<BTreeMap<String, File>, FolderError> {
        // Whoever reads the folder as a whole would take such a table for one of its own.
        let is_stranger = |name: &String| name.ends_with(".parquet") && !manifest.files.contains_key(name);
        if let Some(name) = self.place.names()?.into_iter().find(is_stranger) {
            return Err(FolderError::Stranger(self.path().join(name)));
        }
        held(self.path(), &manifest.results(), wanted)
    }

    /// The summary of finished results, all of whose files are those that `manifest` describes; the page of charts, too.
    ///
    /// # Errors
    /// As [`held`](Self::held).
    pub fn summary(&self, manifest: &Manifest) -> Result<Summary, FolderError> {
        let mut files = self.held(manifest, &[SUMMARY])?;
        hold_page(self.path(), manifest.files.get(PAGE))?;
        self.summary_in(&mut files, manifest)
    }

    /// The summary among the `files` of these results.
    ///
    /// # Errors
    /// If it is none.
    pub fn summary_in(&self, files: &mut BTreeMap<String, File>, manifest: &Manifest) -> Result<Summary, FolderError> {
        document(self.path(), SUMMARY, files, &manifest.version)
    }

    /// The finished trials that `manifest` is, or is to be, made of.
    #[must_use]
    pub fn parts(&self, manifest: &Manifest) -> Parts {
        Parts::at(self.trials(), manifest.key())
    }

    /// Puts a manifest in place. Like every file, it passes through [`trials`](Self::trials), which is made if need be. Several processes may
    /// do so at once.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn declare(&self, manifest: &Manifest) -> Result<(), FolderError> {
        write_whole(&self.trials(), &self.path().join(MANIFEST), &sealed(manifest))
    }

    /// Deletes what desim put here, and the folders that were not there before. Where the manifest cannot be trusted, all that
    /// is here must have the name of a file of desim's.
    ///
    /// # Errors
    /// If something else is here, or the file system refuses.
    pub fn clear(&self) -> Result<(), FolderError> {
        let names = self.place.names()?;
        let named = match self.contents() {
            Ok(Contents::Results(manifest)) => manifest.files,
            Ok(Contents::Nothing) => BTreeMap::new(),
            Err(FolderError::Altered { .. } | FolderError::Version { .. }) => {
                match names.iter().find(|name| *name != TRIALS && !is_own(name)) {
                    Some(found) => return Err(self.foreign(found.clone())),
                    None => BTreeMap::new(),
                }
            }
            Err(error) => return Err(error),
        };
        self.drop_trials()?;
        let is_known = |name: &&String| (is_own(name) || named.contains_key(*name)) && *name != MANIFEST;
        for name in names.iter().filter(is_known) {
            if self.path().join(name).is_dir() {
                for table in TRACE_TABLES {
                    self.place.delete(&format!("{name}/{table}"))?;
                }
                // Whatever else has come into it keeps it.
                let _ = fs::remove_dir(self.path().join(name));
            } else {
                self.place.delete(name)?;
            }
        }
        self.place.delete(MANIFEST)?;
        self.place.leave();
        Ok(())
    }

    /// Deletes files of desim's that `manifest` does not name: an attempt that was cut short may have left them.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn sweep(&self, manifest: &Manifest) -> Result<(), FolderError> {
        let names = self.place.names()?;
        let is_left = |name: &&String| is_own(name) && *name != MANIFEST && !manifest.files.contains_key(*name);
        names
            .iter()
            .filter(is_left)
            .try_for_each(|name| self.place.delete(name))
    }

    /// Deletes the finished trials, which the tables hold by now.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn drop_trials(&self) -> Result<(), FolderError> {
        delete_folder(&self.trials())
    }

    /// Deletes what an attempt that was cut short has left beside finished results, unless somebody is at work there. Where it
    /// cannot be deleted it does no harm.
    pub fn tidy(&self) {
        if self.trials().exists() && Claim::lay(&self.trials()).is_ok() {
            let _ = self.drop_trials();
        }
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

    /// Puts the page of charts into a folder of finished results, and its name into the manifest.
    ///
    /// # Errors
    /// If somebody else is at work in the folder, or the file system refuses.
    pub fn keep_page(&self, manifest: &Manifest, page: &str) -> Result<Manifest, WriteError> {
        let claim = Claim::lay(&self.trials())?;
        self.stage(PAGE, page.as_bytes())?;
        let mut manifest = manifest.clone();
        manifest.files.insert(PAGE.to_owned(), FileEntry::of(page.as_bytes()));
        self.place(PAGE)?;
        self.declare(&manifest)?;
        drop(claim);
        self.drop_trials()?;
        Ok(manifest)
    }
}

/// Writes the file `path` whole or not at all, by way of the folder `staging`, which is made if need be. Others may do so at the same time.
pub(super) fn write_whole(staging: &Path, path: &Path, bytes: &[u8]) -> Result<(), FolderError> {
    fs::create_dir_all(staging).map_err(failed("create the folder", staging))?;
    replace(staging, path, |mut file| file.write_all(bytes)).map_err(failed("write", path))
}

/// Whether desim gives a file of results this name.
fn is_own(name: &str) -> bool {
    let is_number = |number: &str| !number.is_empty() && number.bytes().all(|digit| digit.is_ascii_digit());
    let is_picture = || {
        let number = |kind: &str| name.strip_prefix(kind)?.strip_prefix('_')?.strip_suffix(".svg");
        PICTURES.iter().filter_map(|kind| number(kind)).any(is_number)
    };
    let is_replay = || {
        let number = name.strip_prefix("replay-").and_then(|name| name.strip_suffix(".html"));
        name == REPLAY || number.is_some_and(is_number)
    };
    let is_table = Tables::FILES.contains(&name) || Tables::OPTIONAL.contains(&name);
    [MANIFEST, SUMMARY, PAGE].contains(&name) || is_table || is_picture() || is_replay() || is_trace(name)
}

/// Holds the page of charts in `dir`, if there is one, against what was written.
pub fn hold_page(dir: &Path, written: Option<&FileEntry>) -> Result<(), FolderError> {
    let files = written.map(|entry| (PAGE.to_owned(), entry.clone()));
    match held(dir, &files.into_iter().collect(), &[]) {
        Err(FolderError::Altered { path, .. }) if path.symlink_metadata().is_ok() => Err(FolderError::Page(path)),
        Err(FolderError::Altered { .. }) | Ok(_) => Ok(()),
        Err(error) => Err(error),
    }
}
