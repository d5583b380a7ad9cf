//! The folders that shards have filled: each once, what they are of, and whether they agree; and what their processes say of how the experiment was
//! split.

use std::collections::BTreeSet;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use super::error::MergeError;
use crate::experiment::{Key, Parts};
use crate::export::{Contents, Difference, Folder, FolderError, Manifest, StudyFolder, StudyManifest};
use crate::runs::runner::Runner;

/// The folders, each once however it is written, with the one for the results at the end if it is to be looked into as well.
pub fn folders(dirs: &[PathBuf], out: Option<&Path>) -> Vec<PathBuf> {
    let mut known = BTreeSet::new();
    let all = dirs.iter().map(PathBuf::as_path).chain(out);
    let is_new = |dir: &&Path| known.insert(dir.canonicalize().unwrap_or_else(|_| dir.to_path_buf()));
    all.filter(is_new).map(Path::to_owned).collect()
}

/// What shards of one scenario or study have left, folder by folder.
pub enum Shards {
    /// Of a scenario.
    Scenario(Vec<(PathBuf, Manifest)>),
    /// Of a study.
    Study(Vec<(PathBuf, StudyManifest)>),
}

/// What shards have left in `dirs`: in one folder at least, and all of one scenario or study, made by one version and program. A folder in which a
/// shard has been killed before it said what it is of is left out.
pub fn shards(dirs: &[PathBuf]) -> Result<Shards, MergeError> {
    let mut begun = Vec::new();
    for dir in folders(dirs, None) {
        match Folder::new(dir.clone()).contents() {
            Ok(Contents::Nothing) if dir.is_dir() => {}
            _ => begun.push(dir),
        }
    }
    let is_study = |dir: &PathBuf| StudyFolder::is_at(dir);
    let first = begun.first().ok_or_else(|| MergeError::None(dirs[0].clone()))?;
    if let Some(other) = begun.iter().find(|other| is_study(other) != is_study(first)) {
        let kind = |dir| if is_study(dir) { "a study" } else { "one scenario" };
        return Err(MergeError::Apart {
            folders: [first.clone(), other.clone()],
            differences: vec![format!("{} and {}", kind(first), kind(other))],
        });
    }
    if is_study(first) {
        agreeing(read(begun, study)?, study_differences).map(Shards::Study)
    } else {
        agreeing(read(begun, scenario)?, differences).map(Shards::Scenario)
    }
}

/// What each folder is the result of, as `manifest` reads it.
fn read<M>(
    dirs: Vec<PathBuf>,
    manifest: impl Fn(&Path) -> Result<M, MergeError>,
) -> Result<Vec<(PathBuf, M)>, MergeError> {
    let read = |dir: PathBuf| manifest(&dir).map(|manifest| (dir, manifest));
    dirs.into_iter().map(read).collect()
}

/// The folders of a setting below those of a study, of those that have it, at least one; they agree.
pub fn settings(studies: &[(PathBuf, StudyManifest)], name: &str) -> Result<Vec<(PathBuf, Manifest)>, MergeError> {
    let mut there = Vec::new();
    for dir in studies.iter().map(|(dir, _)| dir.join(name)) {
        match scenario(&dir) {
            Ok(manifest) => there.push((dir, manifest)),
            // A shard that was killed at once has not come so far.
            Err(MergeError::None(_)) => {}
            Err(error) => return Err(error),
        }
    }
    if there.is_empty() {
        return Err(MergeError::None(studies[0].0.join(name)));
    }
    agreeing(there, differences)
}

/// What the folder of a scenario's shard is the result of.
fn scenario(dir: &Path) -> Result<Manifest, MergeError> {
    match Folder::new(dir.to_owned()).contents() {
        Ok(Contents::Results(manifest)) => Ok(manifest),
        Ok(Contents::Nothing) | Err(FolderError::Foreign { .. } | FolderError::NotAFolder(_)) => {
            Err(MergeError::None(dir.to_owned()))
        }
        Err(error) => Err(error.into()),
    }
}

/// What the folder of a study's shard is the result of.
fn study(dir: &Path) -> Result<StudyManifest, MergeError> {
    match StudyFolder::new(dir.to_owned()).contents() {
        Ok(Some(manifest)) => Ok(manifest),
        Ok(None) | Err(FolderError::Foreign { .. } | FolderError::NotAFolder(_)) => {
            Err(MergeError::None(dir.to_owned()))
        }
        Err(error) => Err(error.into()),
    }
}

/// The folders, if none differs from the first.
fn agreeing<M>(
    folders: Vec<(PathBuf, M)>,
    differences: impl Fn(&M, &M) -> Vec<String>,
) -> Result<Vec<(PathBuf, M)>, MergeError> {
    let (first, asked) = &folders[0];
    for (dir, there) in &folders[1..] {
        let differences = differences(asked, there);
        if !differences.is_empty() {
            return Err(MergeError::Apart {
                folders: [first.clone(), dir.clone()],
                differences,
            });
        }
    }
    Ok(folders)
}

/// What keeps shards of scenarios apart, a line each. The number of trials does not: no trial depends on it.
fn differences(one: &Manifest, other: &Manifest) -> Vec<String> {
    let mut lines = lines(one.scenario_differences(other));
    lines.extend(builds([
        (one.made_by(), &one.program),
        (other.made_by(), &other.program),
    ]));
    lines
}

/// What keeps shards of studies apart, a line each.
fn study_differences(one: &StudyManifest, other: &StudyManifest) -> Vec<String> {
    let mut lines = lines(one.plan_differences(other));
    lines.extend(builds([
        (one.made_by(), &one.program),
        (other.made_by(), &other.program),
    ]));
    if one.settings != other.settings {
        let names = |manifest: &StudyManifest| manifest.settings.join(", ");
        lines.push(format!("settings: {} and {}", names(one), names(other)));
    }
    lines
}

fn lines(fields: Vec<Difference>) -> Vec<String> {
    let foreign = fields.into_iter().filter(|field| !field.is_at("trials"));
    let line = |Difference {
                    path,
                    values: [one, other],
                }| format!("{path}: {one} and {other}");
    foreign.map(line).collect()
}

/// How the versions and programs that made two folders differ.
fn builds([one, other]: [(String, &Option<String>); 2]) -> Vec<String> {
    let mut lines = Vec::new();
    if one.0 != other.0 {
        lines.push(format!("{} and {}", one.0, other.0));
    }
    if one.1 != other.1 {
        lines.push("two builds of this program, whose protocols may differ".to_owned());
    }
    lines
}

/// Whether `out` is one of the folders.
pub fn is_among(dirs: &[PathBuf], out: &Path) -> bool {
    folders(dirs, Some(out)).len() == folders(dirs, None).len()
}

/// The trials of `key` in results folders.
pub fn parts(folders: impl Iterator<Item = Folder>, key: Key) -> Vec<Parts> {
    folders.map(|folder| Parts::at(folder.trials(), key)).collect()
}

/// Into how many shards the processes in folders of trials say that the experiment was split.
pub fn splits(trials: impl Iterator<Item = PathBuf>) -> BTreeSet<NonZeroU32> {
    let runners = trials.flat_map(|dir| Runner::all(&dir));
    runners
        .filter_map(|runner| NonZeroU32::new(runner.shard().of()))
        .collect()
}

/// Of the manifests of one scenario's shards: the one that asks for most trials, with the question that any of them knows.
pub fn fullest<'a>(manifests: impl Iterator<Item = &'a Manifest> + Clone) -> Option<Manifest> {
    let trials = |manifest: &&Manifest| manifest.scenario["trials"].as_u64();
    let question = manifests.clone().find_map(|manifest| manifest.question.clone());
    let fullest = manifests.max_by_key(trials)?;
    Some(Manifest {
        question,
        ..fullest.clone()
    })
}
