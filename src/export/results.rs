//! Finished results, read back for reports: the files must be those that desim wrote, and results that are put together
//! must be of the same scenario and version.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::files::{MANIFEST, SUMMARY};
use super::folder::{Contents, Folder};
use super::manifest::{Difference, Manifest};
use super::place::FolderError;
use super::read::{self, NameLists, Reader};
use crate::metrics::summary::Trials;
use crate::metrics::{Summary, TrialRecord};
use crate::scenario::Scenario;
use crate::spool::Section;
use crate::text::shown;

/// Finished results of one scenario, from one folder or several.
#[derive(Clone, Debug)]
pub struct Results {
    /// The folders and what their manifests say, in the order in which they were given.
    pub sources: Vec<(PathBuf, Manifest)>,
    /// The scenario; of several folders that of the first.
    pub scenario: Scenario,
    /// What the protocol calls its topics and roles.
    pub names: NameLists,
    /// The figures of all trials.
    pub summary: Summary,
    /// The tables of each folder, by name, verified and open.
    tables: Vec<BTreeMap<String, Section>>,
}

/// Results cannot be read, or not together.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    /// There is no such folder, or no results in it.
    #[error("{} holds no results of desim: give a folder that `desim scenario` has filled", shown(.0))]
    None(PathBuf),
    /// Trials are missing.
    #[error("the results in {} are unfinished: run the same `desim scenario` command to its end first, or `desim merge` once all shards are done", shown(.0))]
    Unfinished(PathBuf),
    /// Two folders hold what cannot be put together.
    #[error("{} and {} cannot be put into one report: {why}\n  {}", shown(&.folders[0]), shown(&.folders[1]), .differences.join("\n  "))]
    Apart {
        /// The folders.
        folders: [PathBuf; 2],
        /// Why not.
        why: &'static str,
        /// The differences, a line each.
        differences: Vec<String>,
    },
    /// A file is not the one that desim wrote, or the file system refused.
    #[error(transparent)]
    Folder(#[from] FolderError),
}

impl Results {
    /// Reads the results in `dir`.
    ///
    /// # Errors
    /// If there are none, or they are unfinished, or a file is not the one that the manifest describes, or a table lacks a column.
    pub fn open(dir: &Path) -> Result<Self, ResultsError> {
        let folder = Folder::new(dir.to_owned());
        let manifest = match folder.contents() {
            Ok(Contents::Results(manifest)) => manifest,
            Ok(Contents::Nothing) | Err(FolderError::Foreign { .. } | FolderError::NotAFolder(_)) => {
                return Err(ResultsError::None(dir.to_owned()));
            }
            Err(error) => return Err(error.into()),
        };
        if !manifest.finished {
            return Err(ResultsError::Unfinished(dir.to_owned()));
        }
        let there = |name: &&str| manifest.files.contains_key(*name);
        let optional = read::OPTIONAL.into_iter().filter(there);
        let wanted: Vec<&str> = read::READ.into_iter().chain([SUMMARY]).chain(optional).collect();
        let mut files = folder.held(&manifest, &wanted)?;
        let version = |file: &str, reason: String| FolderError::version(&dir.join(file), &reason, &manifest.version);
        let summary = folder.summary_in(&mut files, &manifest)?;
        let names = names(&summary);
        let section = |(name, file)| (name, Section::of(file, 0));
        let tables: BTreeMap<String, Section> = files.into_iter().map(section).collect();
        Reader::new(&tables, &names).map_err(|(file, wrong)| version(file, wrong))?;
        let scenario = manifest
            .read_scenario(dir)
            .map_err(|reason| version(MANIFEST, reason))?;
        Ok(Self {
            sources: vec![(dir.to_owned(), manifest)],
            scenario,
            names,
            summary,
            tables: vec![tables],
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
            all.tables.extend(other.tables);
        }
        if !others.is_empty() {
            let [topics, roles]: [Vec<&str>; 2] =
                [&all.names.topics, &all.names.roles].map(|names| names.iter().map(String::as_str).collect());
            let figures = all.scenario.figures();
            let mut trials = Trials::new(&figures, &topics, &roles);
            for record in all.records() {
                trials.add(&record?);
            }
            all.summary = trials.summary(&all.scenario.name);
        }
        Ok(all)
    }

    /// The record of each trial, without its path: folder by folder, each in order of trials. They are read one by one, as they are asked for:
    /// all of them may be more than memory holds.
    ///
    /// ```no_run
    /// # use std::path::Path;
    /// # use desim::export::{Results, ResultsError};
    /// let results = Results::open(Path::new("results/quickstart"))?;
    /// for record in results.records() {
    ///     println!("{} control steps", record?.steps);
    /// }
    /// # Ok::<(), ResultsError>(())
    /// ```
    ///
    /// Where a table is not what it should be an error takes the place of the record, and the folder's records end.
    pub fn records(&self) -> impl Iterator<Item = Result<TrialRecord, ResultsError>> + '_ {
        let folders = self.sources.iter().zip(&self.tables);
        folders.flat_map(|((dir, manifest), tables)| {
            let (reader, wrong) = match Reader::new(tables, &self.names) {
                Ok(reader) => (Some(reader), None),
                Err(wrong) => (None, Some(Err(wrong))),
            };
            wrong.into_iter().chain(reader.into_iter().flatten()).map(|read| {
                read.map_err(|(file, wrong)| FolderError::version(&dir.join(file), &wrong, &manifest.version).into())
            })
        })
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

fn names(summary: &Summary) -> NameLists {
    let bandwidth = &summary.bandwidth;
    NameLists {
        topics: bandwidth.by_topic.0.iter().map(|(name, _)| name.clone()).collect(),
        roles: bandwidth.by_role.0.iter().map(|(name, _)| name.clone()).collect(),
    }
}
