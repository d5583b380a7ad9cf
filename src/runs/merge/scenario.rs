//! The shards of a scenario.

use std::path::{Path, PathBuf};

use super::error::MergeError;
use super::lack::{Lack, MissingTrials};
use super::{Merge, Merged, sources};
use crate::experiment::{Claim, Kept};
use crate::export::{self, Contents, Folder, FolderError, Manifest};
use crate::runs::error::{Other, RunsError};
use crate::runs::scenario::ScenarioResults;
use crate::scenario::Scenario;

pub fn merge(merge: &Merge, shards: &[(PathBuf, Manifest)]) -> Result<Merged, MergeError> {
    let out = Folder::new(merge.out.to_owned());
    let (dir, _) = &shards[0];
    let manifest = sources::fullest(shards.iter().map(|(_, manifest)| manifest)).expect("at least one folder");
    let scenario = own(dir, &manifest)?;
    let is_among = sources::is_among(merge.dirs, merge.out);
    if let Some(results) = finished(&out, &scenario, merge.replace && !is_among)? {
        return Ok(Merged::Scenario {
            scenario,
            results,
            were_there: true,
        });
    }
    if let Some((dir, _)) = shards.iter().find(|(_, manifest)| manifest.finished) {
        return Err(MergeError::Finished(dir.clone()));
    }
    let folders = || {
        sources::folders(merge.dirs, Some(merge.out))
            .into_iter()
            .map(Folder::new)
    };
    let (kept, found) = Kept::among(sources::parts(folders(), manifest.key()), scenario.trials)??;
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
    if merge.replace && !is_among {
        // Nobody may be at work there.
        drop(Claim::lay(&out.trials())?);
        out.clear()?;
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

/// The results, if they are in the folder already. It then holds nothing else but what is to be replaced.
fn finished(out: &Folder, scenario: &Scenario, replace: bool) -> Result<Option<ScenarioResults>, MergeError> {
    let there = match out.contents() {
        Ok(Contents::Results(there)) => there,
        Ok(Contents::Nothing) => return Ok(None),
        Err(FolderError::Altered { .. } | FolderError::Version { .. }) if replace => return Ok(None),
        Err(error) => return Err(error.into()),
    };
    if replace {
        return Ok(None);
    }
    let differences = there.differences(&Manifest::new(scenario));
    if !differences.is_empty() {
        let dir = out.path().to_owned();
        let of = Other::Scenario;
        return Err(RunsError::Taken { dir, of, differences }.into());
    }
    if !there.finished {
        return Ok(None);
    }
    let summary = out.summary(&there)?;
    out.tidy();
    Ok(Some(ScenarioResults {
        summary,
        manifest: there,
    }))
}
