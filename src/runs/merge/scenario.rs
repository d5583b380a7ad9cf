//! The shards of a scenario.

use std::path::{Path, PathBuf};

use super::error::MergeError;
use super::lack::{Lack, MissingTrials};
use super::{Merge, Merged, sources};
use crate::experiment::{Claim, Kept};
use crate::export::{self, Folder, Manifest};
use crate::runs::scenario::{ScenarioResults, finished};
use crate::scenario::Scenario;

pub fn merge(merge: &Merge, shards: &[(PathBuf, Manifest)]) -> Result<Merged, MergeError> {
    let out = Folder::new(merge.out.to_owned());
    let (dir, _) = &shards[0];
    let manifest = sources::fullest(shards.iter().map(|(_, manifest)| manifest)).expect("at least one folder");
    let scenario = own(dir, &manifest)?;
    // What is to be replaced is left alone until all trials are found, and a shard is never replaced.
    let replaces = merge.replace && !sources::is_among(merge.dirs, merge.out);
    if !replaces && let Some(there) = finished(&out, &scenario, false)? {
        return Ok(Merged::Scenario {
            scenario,
            results: ScenarioResults::there(&out, there)?,
            were_there: true,
        });
    }
    if let Some((dir, _)) = shards.iter().find(|(_, manifest)| manifest.finished) {
        return Err(MergeError::Finished(dir.clone()));
    }
    let looked_into = (!replaces).then_some(merge.out);
    let folders = || sources::folders(merge.dirs, looked_into).into_iter().map(Folder::new);
    let (kept, found) = Kept::among(sources::parts(folders(), manifest.key()), scenario.trials)?;
    if !found.missing.is_empty() {
        let trials = found.missing;
        return Err(MergeError::Missing(Lack {
            of: vec![MissingTrials {
                setting: None,
                trials,
                of: scenario.trials,
            }],
            damaged: found.damaged,
            splits: sources::splits(folders().map(|folder| folder.trials())),
        }));
    }
    if replaces {
        finished(&out, &scenario, true)?;
    }
    let claim = Claim::lay(&out.trials())?;
    out.declare(&manifest)?;
    let (summary, manifest) = export::write(&out, claim, &kept, &scenario, merge.pictures)?;
    Ok(Merged::Scenario {
        scenario,
        results: ScenarioResults { summary, manifest },
        were_there: false,
    })
}

/// The scenario of shards that this program could have run.
pub fn own(dir: &Path, manifest: &Manifest) -> Result<Scenario, MergeError> {
    let foreign = |differences: Vec<String>| MergeError::Foreign {
        dir: dir.to_owned(),
        differences,
    };
    let scenario = manifest.read_scenario(dir).map_err(|wrong| foreign(vec![wrong]))?;
    let differences = manifest.differences(&Manifest::new(&scenario));
    if differences.is_empty() {
        Ok(scenario)
    } else {
        Err(foreign(differences))
    }
}
