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

/// What a shard's folder is the result of.
pub fn manifest(dir: &Path) -> Result<Manifest, MergeError> {
    match Folder::new(dir.to_owned()).contents() {
        Ok(Contents::Results(manifest)) => Ok(manifest),
        Ok(Contents::Nothing) | Err(FolderError::Foreign { .. } | FolderError::NotAFolder(_)) => {
            Err(MergeError::None(dir.to_owned()))
        }
        Err(error) => Err(error.into()),
    }
}

/// Whether all shards are of one scenario, made by one version and program.
pub fn agree(shards: &[(PathBuf, Manifest)]) -> Result<(), MergeError> {
    let Some(((first, asked), others)) = shards.split_first() else {
        return Ok(());
    };
    for (dir, there) in others {
        let fields = asked.scenario_differences(there);
        let foreign = fields.iter().filter(|field| field.path != "trials");
        let mut differences: Vec<String> = foreign
            .map(
                |Difference {
                     path,
                     values: [one, other],
                 }| format!("{path}: {one} and {other}"),
            )
            .collect();
        if asked.made_by() != there.made_by() {
            differences.push(format!("{} and {}", asked.made_by(), there.made_by()));
        }
        if asked.program != there.program {
            differences.push("two builds of this program, whose protocols may differ".to_owned());
        }
        if !differences.is_empty() {
            return Err(MergeError::Apart {
                folders: [first.clone(), dir.clone()],
                differences,
            });
        }
    }
    Ok(())
}

/// What a folder of a study's shards is the result of.
pub fn study(dir: &Path) -> Result<StudyManifest, MergeError> {
    match StudyFolder::new(dir.to_owned()).contents() {
        Ok(Some(manifest)) => Ok(manifest),
        Ok(None) | Err(FolderError::Foreign { .. } | FolderError::NotAFolder(_)) => {
            Err(MergeError::None(dir.to_owned()))
        }
        Err(error) => Err(error.into()),
    }
}

/// The folders of a setting below those of a study, of those that have it, at least one; they agree.
pub fn settings(dirs: &[PathBuf], name: &str) -> Result<Vec<(PathBuf, Manifest)>, MergeError> {
    let mut there = Vec::new();
    for dir in dirs.iter().map(|dir| dir.join(name)) {
        match manifest(&dir) {
            Ok(manifest) => there.push((dir, manifest)),
            // A shard that was killed at once has not come so far.
            Err(MergeError::None(_)) => {}
            Err(error) => return Err(error),
        }
    }
    agree(&there)?;
    if there.is_empty() {
        return Err(MergeError::None(dirs[0].join(name)));
    }
    Ok(there)
}

/// Whether all shards are of one study, made by one version and program.
pub fn agree_on_study(shards: &[(PathBuf, StudyManifest)]) -> Result<(), MergeError> {
    let Some(((first, asked), others)) = shards.split_first() else {
        return Ok(());
    };
    for (dir, there) in others {
        let mut differences: Vec<String> = asked
            .plan_differences(there)
            .into_iter()
            .filter(|field| !field.is_at("trials"))
            .map(
                |Difference {
                     path,
                     values: [one, other],
                 }| format!("{path}: {one} and {other}"),
            )
            .collect();
        if asked.made_by() != there.made_by() {
            differences.push(format!("{} and {}", asked.made_by(), there.made_by()));
        }
        if asked.program != there.program {
            differences.push("two builds of this program, whose protocols may differ".to_owned());
        }
        if asked.settings != there.settings {
            let names = |manifest: &StudyManifest| manifest.settings.join(", ");
            differences.push(format!("settings: {} and {}", names(asked), names(there)));
        }
        if !differences.is_empty() {
            return Err(MergeError::Apart {
                folders: [first.clone(), dir.clone()],
                differences,
            });
        }
    }
    Ok(())
}

/// Whether the folders, at least one, are of a study, and not of one scenario.
pub fn are_of_study(dirs: &[PathBuf]) -> Result<bool, MergeError> {
    let is_study = |dir: &PathBuf| StudyFolder::is_at(dir);
    let (first, others) = dirs.split_first().expect("at least one folder");
    let Some(other) = others.iter().find(|other| is_study(other) != is_study(first)) else {
        return Ok(is_study(first));
    };
    let kind = |dir| if is_study(dir) { "a study" } else { "one scenario" };
    Err(MergeError::Apart {
        folders: [first.clone(), other.clone()],
        differences: vec![format!("{} and {}", kind(first), kind(other))],
    })
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
