//! The results folder of a study: a results folder for each setting, and what compares them.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::folder::{Contents, Folder};
use super::manifest::{Difference, compare, made_by};
use super::picture;
use super::place::{FolderError, Place, failed, json};
use super::results::PAGE;
use crate::metrics::comparison::{Comparison, Trials};

const STUDY: &str = "study.json";
/// What compares the settings.
const COMPARISON: &str = "comparison.json";
const TABLE: &str = "comparison.parquet";
const PARETO: &str = "pareto.svg";
/// A file until it is whole.
const UNFINISHED: &str = ".unfinished";

/// What `study.json` holds: what the folder is the result of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StudyManifest {
    /// Version of desim.
    pub version: String,
    /// Commit that it was built from, where the build was told.
    pub commit: Option<String>,
    /// Whether everything is there.
    pub finished: bool,
    /// What is compared and how: all but the scenarios of the settings, which their own manifests hold.
    pub plan: Value,
    /// Names of the settings, which are those of their folders.
    pub settings: Vec<String>,
}

impl StudyManifest {
    /// Of a study that has just begun.
    #[must_use]
    pub fn new(plan: Value, settings: Vec<String>) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: option_env!("DESIM_COMMIT").map(str::to_owned),
            finished: false,
            plan,
            settings,
        }
    }

    /// The version of desim and the commit that it was built from, where that is known.
    #[must_use]
    pub fn made_by(&self) -> String {
        made_by(&self.version, self.commit.as_deref())
    }

    /// What keeps results of `self` from being results of `asked`, a line each.
    #[must_use]
    pub fn differences(&self, asked: &Self) -> Vec<String> {
        let mut lines = Vec::new();
        if self.version != asked.version {
            lines.push(format!("desim {} there, {} now", self.version, asked.version));
        }
        let mut found = Vec::new();
        compare("", &self.plan, &asked.plan, &mut found);
        lines.extend(found.iter().map(Difference::line));
        if self.settings != asked.settings {
            let names = |settings: &[String]| settings.join(", ");
            lines.push(format!(
                "settings: {} there, {} now",
                names(&self.settings),
                names(&asked.settings)
            ));
        }
        lines
    }
}

/// A folder that holds, or will hold, the results of a study.
#[derive(Clone, Debug)]
pub struct StudyFolder {
    place: Place,
}

impl StudyFolder {
    /// The folder at `dir`, which need not exist.
    #[must_use]
    pub fn new(dir: PathBuf) -> Self {
        Self { place: Place::new(dir) }
    }

    /// Whether `dir` holds a study.
    #[must_use]
    pub fn is_at(dir: &Path) -> bool {
        dir.join(STUDY).is_file()
    }

    /// Its path.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.place.path()
    }

    /// The results folder of a setting.
    #[must_use]
    pub fn setting(&self, name: &str) -> Folder {
        Folder::new(self.path().join(name))
    }

    /// What it is the result of; `None` if nothing is in it. Reads only.
    ///
    /// # Errors
    /// If it is no folder, or holds anything but a study, or cannot be read.
    pub fn contents(&self) -> Result<Option<StudyManifest>, FolderError> {
        match self.place.find(STUDY) {
            Ok(None) => match self.setting("").contents()? {
                Contents::Nothing => Ok(None),
                Contents::Results(_) => Err(FolderError::Foreign {
                    dir: self.path().to_owned(),
                    found: "manifest.json: the results of one scenario".to_owned(),
                }),
            },
            found => found,
        }
    }

    /// Says what the folder is the result of.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn declare(&self, manifest: &StudyManifest) -> Result<(), FolderError> {
        fs::create_dir_all(self.path()).map_err(failed("create the folder", self.path()))?;
        self.write(STUDY, &json(manifest))
    }

    /// The comparison, where it has been written.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn comparison(&self) -> Result<Option<Comparison>, FolderError> {
        self.place.find(COMPARISON)
    }

    /// Writes what compares the settings: the table and the picture first, so that a comparison that is there is all there.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn write_comparison(&self, comparison: &Comparison, trials: &[Trials]) -> Result<(), FolderError> {
        self.write_table(comparison, trials)?;
        if let Some(pareto) = picture::pareto(comparison) {
            self.write(PARETO, format!("{pareto}\n").as_bytes())?;
        }
        self.write(COMPARISON, &json(comparison))
    }

    /// Puts the page of charts into the folder.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn keep_page(&self, page: &str) -> Result<(), FolderError> {
        self.write(PAGE, page.as_bytes())
    }

    #[cfg(feature = "parquet")]
    fn write_table(&self, comparison: &Comparison, trials: &[Trials]) -> Result<(), FolderError> {
        let (path, unfinished) = (self.path().join(TABLE), self.path().join(UNFINISHED));
        super::comparison_table::write(&unfinished, comparison, trials).map_err(failed("write", &path))?;
        fs::rename(&unfinished, &path).map_err(failed("write", &path))
    }

    #[cfg(not(feature = "parquet"))]
    fn write_table(&self, _: &Comparison, _: &[Trials]) -> Result<(), FolderError> {
        Ok(())
    }

    /// Names of the files that are in it, without the settings' folders.
    #[must_use]
    pub fn files(&self) -> Vec<&'static str> {
        let all = [COMPARISON, TABLE, PARETO, PAGE, STUDY];
        all.into_iter().filter(|name| self.path().join(name).exists()).collect()
    }

    /// Deletes what `manifest` says that desim put here, and the folders that were not there before.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn clear(&self, manifest: &StudyManifest) -> Result<(), FolderError> {
        // A name with a separator never came from desim: it must not reach out of the folder.
        let names = manifest.settings.iter().filter(|name| !name.contains(['/', '\\', '.']));
        for folder in names.map(|name| self.setting(name)) {
            match folder.contents()? {
                Contents::Results(there) => folder.clear(&there)?,
                Contents::Nothing => folder.drop_trials()?,
            }
            // Whatever else has come into it meanwhile keeps it.
            let _ = fs::remove_dir(folder.path());
        }
        for name in [COMPARISON, TABLE, PARETO, PAGE, UNFINISHED, STUDY] {
            self.place.delete(name)?;
        }
        self.place.leave();
        Ok(())
    }

    /// Writes a file whole or not at all.
    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), FolderError> {
        let (path, unfinished) = (self.path().join(name), self.path().join(UNFINISHED));
        let written = File::create(&unfinished).and_then(|mut file| file.write_all(bytes));
        written
            .and_then(|()| fs::rename(&unfinished, &path))
            .map_err(failed("write", &path))
    }
}
