//! The results folder of a study: a results folder for each setting, and what compares them.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::files::{MANIFEST, PAGE};
use super::folder::{Contents, Folder, TRIALS, hold_page, write_whole};
use super::held::{FileEntry, document, held, sealed, unseal};
use super::manifest::{Difference, Manifest, compare, made_by, other_program};
use super::picture;
use super::place::{FolderError, Place, delete_folder, json};
use super::read;
use crate::metrics::comparison::{Comparison, Trials};
use crate::metrics::figures::Told;

const STUDY: &str = "study.json";
/// What compares the settings.
const COMPARISON: &str = "comparison.json";
const TABLE: &str = "comparison.parquet";
const PARETO: &str = "pareto.svg";

/// What `study.json` holds: what the folder is the result of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StudyManifest {
    /// Version of desim.
    pub version: String,
    /// Commit that it was built from, where the build was told.
    pub commit: Option<String>,
    /// The program that made it, as [`Manifest::program`] has it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub program: Option<String>,
    /// Whether everything is there.
    pub finished: bool,
    /// What is compared and how: all but the scenarios of the settings, which their own manifests hold.
    pub plan: Value,
    /// Names of the settings, which are those of their folders.
    pub settings: Vec<String>,
    /// The files that compare them, as soon as they are there, and those of the settings once all is, by their paths in the folder.
    /// Manifests of settings are not among them: they hold what depends on the machine, and hashes of their own.
    pub files: BTreeMap<String, FileEntry>,
}

impl StudyManifest {
    /// Of a study that has just begun.
    #[must_use]
    pub fn new(plan: Value, settings: Vec<String>, program: Option<String>) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: option_env!("DESIM_COMMIT").map(str::to_owned),
            program,
            finished: false,
            plan,
            settings,
            files: BTreeMap::new(),
        }
    }

    /// Adds the files of a setting's results.
    pub fn add(&mut self, setting: &str, results: &Manifest) {
        let files = results.results().into_iter();
        self.files
            .extend(files.map(|(name, entry)| (format!("{setting}/{name}"), entry)));
    }

    /// The files that compare the settings.
    fn comparing(&self) -> BTreeMap<String, FileEntry> {
        let own = self
            .files
            .iter()
            .filter(|(name, _)| [COMPARISON, TABLE, PARETO].contains(&name.as_str()));
        own.map(|(name, entry)| (name.clone(), entry.clone())).collect()
    }

    /// The files of a setting's results, by their names in its folder.
    fn of(&self, setting: &str) -> BTreeMap<String, FileEntry> {
        let name = |path: &str| Some(path.strip_prefix(setting)?.strip_prefix('/')?.to_owned());
        let files = self.files.iter();
        files
            .filter_map(|(path, entry)| Some((name(path)?, entry.clone())))
            .collect()
    }

    /// The version of desim and the commit that it was built from, where that is known.
    #[must_use]
    pub fn made_by(&self) -> String {
        made_by(&self.version, self.commit.as_deref())
    }

    /// The values of two plans that differ.
    #[must_use]
    pub fn plan_differences(&self, other: &Self) -> Vec<Difference> {
        let mut found = Vec::new();
        compare("", &self.plan, &other.plan, &mut found);
        found
    }

    /// What keeps results of `self` from being results of `asked`, a line each. While nothing has been compared, there may be more trials or
    /// fewer, and another width until which they are added: finished trials stay good.
    #[must_use]
    pub fn differences(&self, asked: &Self) -> Vec<String> {
        let mut lines = Vec::new();
        if self.version != asked.version {
            lines.push(format!("desim {} there, {} now", self.version, asked.version));
        }
        lines.extend(other_program(self.program.as_ref(), asked.program.as_ref()));
        let is_open = !self.finished && self.files.is_empty();
        let counts = |field: &Difference| !is_open || !(field.is_at("trials") || field.is_at("until_width"));
        let fields = self.plan_differences(asked).into_iter();
        lines.extend(fields.filter(counts).map(|field| field.line()));
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
        dir.join(STUDY).symlink_metadata().is_ok()
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
        let names = self.place.names()?;
        if names.iter().any(|name| name == STUDY) {
            return unseal(self.path(), STUDY).map(Some);
        }
        // What is not whole was left by an attempt that was killed before it said what it was.
        match names.iter().find(|name| *name != TRIALS) {
            None => Ok(None),
            Some(found) => Err(FolderError::Foreign {
                dir: self.path().to_owned(),
                found: if names.iter().any(|name| name == MANIFEST) {
                    format!("{MANIFEST}: the results of one scenario")
                } else {
                    found.clone()
                },
            }),
        }
    }

    /// Where files are until they are whole, and where processes say how far they are. The trials are in the settings' folders.
    #[must_use]
    pub fn trials(&self) -> PathBuf {
        self.path().join(TRIALS)
    }

    /// Says what the folder is the result of. Several processes may do so at once.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn declare(&self, manifest: &StudyManifest) -> Result<(), FolderError> {
        self.write(STUDY, &sealed(manifest))?;
        if manifest.finished {
            self.drop_trials()?;
        }
        Ok(())
    }

    fn drop_trials(&self) -> Result<(), FolderError> {
        delete_folder(&self.trials())
    }

    /// The comparison, where `manifest` knows of one: all that compares the settings is as it was written.
    ///
    /// # Errors
    /// The file that is not.
    pub fn comparison(&self, manifest: &StudyManifest) -> Result<Option<Comparison>, FolderError> {
        if !manifest.files.contains_key(COMPARISON) {
            return Ok(None);
        }
        let mut files = held(self.path(), &manifest.comparing(), &[COMPARISON])?;
        document(self.path(), COMPARISON, &mut files, &manifest.version).map(Some)
    }

    /// What the trials of each setting that have a value tell of the figure with the key `figure`, by the settings' names; nothing where
    /// the study was run without tables.
    ///
    /// # Errors
    /// The file that is not as it was written.
    pub fn told(&self, manifest: &StudyManifest, figure: &str) -> Result<BTreeMap<String, Vec<Told>>, FolderError> {
        if !manifest.files.contains_key(TABLE) {
            return Ok(BTreeMap::new());
        }
        let mut files = held(self.path(), &manifest.comparing(), &[TABLE])?;
        let told = files.remove(TABLE).map(|file| read::told(file, figure)).transpose();
        let version = |wrong: String| FolderError::version(&self.path().join(TABLE), &wrong, &manifest.version);
        Ok(told.map_err(version)?.unwrap_or_default())
    }

    /// The comparison of a finished study, all of whose files are those that `manifest` describes, the results of every setting too;
    /// but for pages of charts.
    ///
    /// # Errors
    /// The file that is not the one that was written.
    pub fn finished(&self, manifest: &StudyManifest) -> Result<Comparison, FolderError> {
        for name in &manifest.settings {
            let folder = self.setting(name);
            match folder.contents()? {
                Contents::Results(there) if there.finished && there.results() == manifest.of(name) => {
                    folder.held(&there, &[])?;
                }
                Contents::Results(_) => {
                    return Err(FolderError::Altered {
                        path: folder.path().join(MANIFEST),
                        wrong: "is of other results than the study compared".to_owned(),
                    });
                }
                Contents::Nothing => {
                    return Err(FolderError::Altered {
                        path: folder.path().join(MANIFEST),
                        wrong: "is missing".to_owned(),
                    });
                }
            }
        }
        self.comparison(manifest)?.ok_or_else(|| FolderError::Altered {
            path: self.path().join(STUDY),
            wrong: "knows of no comparison".to_owned(),
        })
    }

    /// Holds the page of charts against `manifest`, if there is one.
    ///
    /// # Errors
    /// If it is not the one that was written.
    pub fn hold_page(&self, manifest: &StudyManifest) -> Result<(), FolderError> {
        hold_page(self.path(), manifest.files.get(PAGE))
    }

    /// Writes what compares the settings, and says so in `manifest`: only then does it count.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn write_comparison(
        &self,
        comparison: &Comparison,
        trials: &[Trials],
        manifest: &mut StudyManifest,
    ) -> Result<(), FolderError> {
        let mut files = vec![(COMPARISON, self.write(COMPARISON, &json(comparison))?)];
        files.extend(self.write_table(comparison, trials)?.map(|entry| (TABLE, entry)));
        if let Some(pareto) = picture::pareto(comparison) {
            files.push((PARETO, self.write(PARETO, format!("{pareto}\n").as_bytes())?));
        }
        let files = files.into_iter().map(|(name, entry)| (name.to_owned(), entry));
        manifest.files.extend(files);
        self.declare(manifest)
    }

    /// Puts the page of charts into the folder of a finished study, and its name into the manifest.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn keep_page(&self, manifest: &StudyManifest, page: &str) -> Result<(), FolderError> {
        let mut manifest = manifest.clone();
        let entry = self.write(PAGE, page.as_bytes())?;
        manifest.files.insert(PAGE.to_owned(), entry);
        self.declare(&manifest)
    }

    #[cfg(feature = "parquet")]
    fn write_table(&self, comparison: &Comparison, trials: &[Trials]) -> Result<Option<FileEntry>, FolderError> {
        let path = self.path().join(TABLE);
        let unfinished = self.trials().join(TABLE);
        let written = fs::create_dir_all(self.trials())
            .and_then(|()| super::comparison_table::write(&unfinished, comparison, trials))
            .and_then(|()| super::held::measure(&unfinished))
            .and_then(|entry| fs::rename(&unfinished, &path).map(|()| entry));
        written.map(Some).map_err(super::place::failed("write", &path))
    }

    #[cfg(not(feature = "parquet"))]
    fn write_table(&self, _: &Comparison, _: &[Trials]) -> Result<Option<FileEntry>, FolderError> {
        Ok(None)
    }

    /// Names of the files that are in it, without the settings' folders.
    #[must_use]
    pub fn files(&self) -> Vec<&'static str> {
        let all = [COMPARISON, TABLE, PARETO, PAGE, STUDY];
        all.into_iter().filter(|name| self.path().join(name).exists()).collect()
    }

    /// Deletes what desim put here for these `settings`, and the folders that were not there before.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn clear(&self, settings: &[String]) -> Result<(), FolderError> {
        // A name with a separator never came from desim: it must not reach out of the folder.
        let names = settings.iter().filter(|name| !name.contains(['/', '\\', '.']));
        for folder in names.map(|name| self.setting(name)) {
            folder.clear()?;
            // Whatever else has come into it meanwhile keeps it.
            let _ = fs::remove_dir(folder.path());
        }
        for name in [COMPARISON, TABLE, PARETO, PAGE] {
            self.place.delete(name)?;
        }
        self.drop_trials()?;
        self.place.delete(STUDY)?;
        self.place.leave();
        Ok(())
    }

    /// Deletes what an attempt that was cut short has left beside a finished study. Where it cannot be deleted it does no harm.
    pub fn tidy(&self, manifest: &StudyManifest) {
        let _ = self.drop_trials();
        for name in &manifest.settings {
            self.setting(name).tidy();
        }
    }

    /// Writes a file whole or not at all.
    fn write(&self, name: &str, bytes: &[u8]) -> Result<FileEntry, FolderError> {
        write_whole(&self.trials(), &self.path().join(name), bytes)?;
        Ok(FileEntry::of(bytes))
    }
}
