//! Finished results, read back for reports: the files must be those that desim wrote, and results that are put together
//! must be of the same scenario and version.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use xxhash_rust::xxh3::xxh3_128;

use super::folder::{Contents, Folder, SUMMARY, measure};
use super::manifest::{Difference, FileEntry, Manifest};
use super::place::FolderError;
use super::read::{self, NameLists};
use crate::metrics::{Summary, TrialRecord};
use crate::scenario::{Scenario, parse, to_ron};

/// The page of charts. It follows from the other files and may be missing.
pub const PAGE: &str = "report.html";

/// Finished results of one scenario, from one folder or several.
#[derive(Clone, Debug)]
pub struct Results {
    /// The folders and what their manifests say, in the order in which they were given.
    pub sources: Vec<(PathBuf, Manifest)>,
    /// The scenario; of several folders that of the first.
    pub scenario: Scenario,
    /// What the protocol calls its topics and roles.
    pub names: NameLists,
    /// The trials, without their paths: folder by folder, each in order of trials.
    pub records: Vec<TrialRecord>,
    /// The figures of all of them.
    pub summary: Summary,
}

/// Results cannot be read, or not together.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    /// There is no such folder, or no results in it.
    #[error("{} holds no results of desim: give a folder that `desim scenario` has filled", .0.display())]
    None(PathBuf),
    /// Trials are missing.
    #[error("the results in {} are unfinished: run the same `desim scenario` command to its end first", .0.display())]
    Unfinished(PathBuf),
    /// A file is not the one that desim wrote.
    #[error("{} {wrong}: restore it, or make the results again with `desim scenario --force`", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        wrong: String,
    },
    /// A file is none of desim's, but would be taken for a table of the results.
    #[error("{} is no file of these results: move it out of the folder", .0.display())]
    Stranger(PathBuf),
    /// A file is whole but of another version.
    #[error("{} is of another version ({reason}; desim {there} there, {} now): report it with the version that made it, or make the results again", path.display(), env!("CARGO_PKG_VERSION"))]
    Version {
        /// The file.
        path: PathBuf,
        /// What is unknown about it.
        reason: String,
        /// The version that made it.
        there: String,
    },
    /// Two folders hold what cannot be put together.
    #[error("{} and {} cannot be put into one report: {why}\n  {}", .folders[0].display(), .folders[1].display(), .differences.join("\n  "))]
    Apart {
        /// The folders.
        folders: [PathBuf; 2],
        /// Why not.
        why: &'static str,
        /// The differences, a line each.
        differences: Vec<String>,
    },
    /// The file system refused, or the folder is no folder.
    #[error(transparent)]
    Folder(#[from] FolderError),
}

impl Results {
    /// Reads the results in `dir`.
    ///
    /// # Errors
    /// If there are none, or they are unfinished, or a file is not the one that the manifest describes.
    pub fn open(dir: &Path) -> Result<Self, ResultsError> {
        let folder = Folder::new(dir.to_owned());
        let manifest = match folder.contents() {
            Ok(Contents::Results(manifest)) => manifest,
            Ok(Contents::Nothing) | Err(FolderError::Foreign { .. } | FolderError::NotAFolder(_)) => {
                return Err(ResultsError::None(dir.to_owned()));
            }
            Err(FolderError::Unreadable { path, reason }) => {
                let wrong = format!("is damaged ({reason})");
                return Err(ResultsError::File { path, wrong });
            }
            Err(error @ FolderError::Io { .. }) => return Err(error.into()),
        };
        if !manifest.finished {
            return Err(ResultsError::Unfinished(dir.to_owned()));
        }
        strangers(dir, &manifest)?;
        let mut files = verified(dir, &manifest)?;
        let version = |file: &str, reason: String| ResultsError::Version {
            path: dir.join(file),
            reason,
            there: manifest.version.clone(),
        };
        let summary = files.remove(SUMMARY).unwrap_or_default();
        let summary: Summary = serde_json::from_slice(&summary).map_err(|error| version(SUMMARY, error.to_string()))?;
        let names = names(&summary);
        let records = read::records(&mut files, &names).map_err(|(file, wrong)| version(file, wrong))?;
        let scenario = scenario(dir, &manifest).map_err(|reason| version("manifest.json", reason))?;
        Ok(Self {
            sources: vec![(dir.to_owned(), manifest)],
            scenario,
            names,
            records,
            summary,
        })
    }

    /// Reads the results in all of `dirs`, at least one, and puts their trials together.
    ///
    /// # Errors
    /// As [`open`](Self::open), or if they are not of one scenario and version, or hold the same trials twice. They
    /// may differ in seed and number of trials alone.
    ///
    /// # Panics
    /// If `dirs` is empty.
    pub fn pooled(dirs: &[PathBuf]) -> Result<Self, ResultsError> {
        let (first, others) = dirs.split_first().expect("at least one folder");
        let mut all = Self::open(first)?;
        for dir in others {
            let other = Self::open(dir)?;
            all.admit(&other)?;
            all.sources.extend(other.sources);
            all.records.extend(other.records);
        }
        if !others.is_empty() {
            let [topics, roles]: [Vec<&str>; 2] =
                [&all.names.topics, &all.names.roles].map(|names| names.iter().map(String::as_str).collect());
            all.summary = Summary::of(&all.scenario.name, &topics, &roles, &all.records);
        }
        Ok(all)
    }

    /// Whether `other`, of one folder, can join.
    fn admit(&self, other: &Self) -> Result<(), ResultsError> {
        let (dir, manifest) = &other.sources[0];
        let apart = |with: &Path, why: &'static str, differences: Vec<String>| {
            Err(ResultsError::Apart {
                folders: [with.to_owned(), dir.clone()],
                why,
                differences,
            })
        };
        let (first, there) = &self.sources[0];
        let versions = [there.made_by(), manifest.made_by()];
        if versions[0] != versions[1] {
            return apart(first, "different versions made them.", vec![versions.join(" and ")]);
        }
        let differences = there.scenario_differences(manifest);
        if !differences
            .iter()
            .all(|field| ["seed", "trials"].contains(&field.path.as_str()))
        {
            let line = |Difference {
                            path,
                            values: [one, other],
                        }: &Difference| format!("{path}: {one} and {other}");
            let why = "their scenarios differ. One report pools trials that differ in their seed alone.";
            return apart(first, why, differences.iter().map(line).collect());
        }
        for (with, manifest) in &self.sources {
            if manifest.seed == other.scenario.seed {
                let same = format!("seed: {} in both", manifest.seed);
                return apart(with, "they hold the same trials.", vec![same]);
            }
        }
        Ok(())
    }
}

/// Puts the page of charts into a folder of finished results, and its name into the manifest, so that whoever clears the
/// results takes it along. [`trials`](Folder::trials) must be there, and nobody else at work in the folder.
///
/// # Errors
/// If the file system refuses.
pub fn keep_page(folder: &Folder, manifest: &Manifest, page: &str) -> Result<Manifest, FolderError> {
    folder.stage(PAGE, page.as_bytes())?;
    let mut manifest = manifest.clone();
    manifest.files.insert(PAGE.to_owned(), folder.measure(PAGE)?);
    folder.place(PAGE)?;
    folder.declare(&manifest)?;
    folder.drop_trials()?;
    Ok(manifest)
}

/// Looks for tables that the manifest does not know: whoever reads the folder as a whole would take them for its own.
fn strangers(dir: &Path, manifest: &Manifest) -> Result<(), ResultsError> {
    let io = |source| FolderError::Io {
        action: "read",
        path: dir.to_owned(),
        source,
    };
    let mut names = Vec::new();
    for entry in fs::read_dir(dir).map_err(io)? {
        names.push(entry.map_err(io)?.file_name().to_string_lossy().into_owned());
    }
    names.sort_unstable();
    let stranger = |name: &&String| name.ends_with(".parquet") && !manifest.files.contains_key(*name);
    match names.iter().find(stranger) {
        Some(name) => Err(ResultsError::Stranger(dir.join(name))),
        None => Ok(()),
    }
}

/// Checks every file against the manifest, and answers the bytes of those that reports are made of.
fn verified(dir: &Path, manifest: &Manifest) -> Result<BTreeMap<String, Vec<u8>>, ResultsError> {
    let mut kept = BTreeMap::new();
    let wanted = |name: &str| name == SUMMARY || read::READ.contains(&name);
    for name in read::READ.into_iter().chain([SUMMARY]) {
        if !manifest.files.contains_key(name) {
            let wrong = "is not among the files of its manifest".to_owned();
            return Err(ResultsError::File {
                path: dir.join(name),
                wrong,
            });
        }
    }
    for (name, entry) in manifest.files.iter().filter(|(name, _)| *name != PAGE) {
        let path = dir.join(name);
        let there = read(&path, name, wanted(name)).map_err(|source| match source.kind() {
            io::ErrorKind::NotFound => ResultsError::File {
                path: path.clone(),
                wrong: "is missing".to_owned(),
            },
            _ => FolderError::Io {
                action: "read",
                path: path.clone(),
                source,
            }
            .into(),
        })?;
        if let Some(wrong) = fault(&there.0, entry) {
            return Err(ResultsError::File { path, wrong });
        }
        kept.extend(there.1.map(|bytes| (name.clone(), bytes)));
    }
    Ok(kept)
}

/// Length and hash of a file, and its bytes if they are `wanted`.
fn read(path: &Path, name: &str, wanted: bool) -> io::Result<(FileEntry, Option<Vec<u8>>)> {
    // Desim writes no such name, and whoever did must not lead out of the folder.
    if name.contains(['/', '\\']) {
        return Err(io::ErrorKind::NotFound.into());
    }
    if !wanted {
        return Ok((measure(path)?, None));
    }
    let bytes = fs::read(path)?;
    let entry = FileEntry {
        bytes: bytes.len() as u64,
        xxh3_128: format!("{:032x}", xxh3_128(&bytes)),
    };
    Ok((entry, Some(bytes)))
}

/// What tells the file that is `there` from the one that was `written`, if anything.
fn fault(there: &FileEntry, written: &FileEntry) -> Option<String> {
    let (length, right) = (there.bytes, written.bytes);
    match () {
        () if length < right => Some(format!("is truncated, or another file ({length} of {right} bytes)")),
        () if length > right => Some(format!(
            "is another file than desim wrote ({length} bytes, not {right})"
        )),
        () if there.xxh3_128 != written.xxh3_128 => {
            Some("is another file than desim wrote (its length is right, its hash is not)".to_owned())
        }
        () => None,
    }
}

fn names(summary: &Summary) -> NameLists {
    let bandwidth = &summary.bandwidth;
    NameLists {
        topics: bandwidth.by_topic.0.iter().map(|(name, _)| name.clone()).collect(),
        roles: bandwidth.by_role.0.iter().map(|(name, _)| name.clone()).collect(),
    }
}

/// The scenario in a manifest. Somebody may have edited it: it must hold as any scenario file must.
fn scenario(dir: &Path, manifest: &Manifest) -> Result<Scenario, String> {
    let scenario: Scenario = serde_json::from_value(manifest.scenario.clone()).map_err(|error| error.to_string())?;
    let place = dir.join("manifest.json").display().to_string();
    parse(&place, &to_ron(&scenario), &[]).map_err(|report| report.to_string())
}
