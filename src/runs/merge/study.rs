//! The shards of a study.

use std::path::PathBuf;

use super::error::MergeError;
use super::lack::{Lack, MissingTrials};
use super::plan::plan;
use super::{Merge, Merged, scenario, sources};
use crate::experiment::Kept;
use crate::export::{Contents, Folder, Manifest, StudyFolder, StudyManifest};
use crate::metrics::comparison::{Comparison, Stopping};
use crate::runs::asked::StudyRun;
use crate::runs::settings::Settings;
use crate::runs::study::{StudyResults, finished, manifest_of};
use crate::scenario::Scenario;

pub fn merge(merge: &Merge, shards: &[(PathBuf, StudyManifest)]) -> Result<Merged, MergeError> {
    let out = StudyFolder::new(merge.out.to_owned());
    let (dir, manifest) = &fullest(shards);
    let scenarios = scenarios(shards, manifest)?;
    let (plan, until) = plan(dir, manifest, scenarios)?;
    let run = StudyRun { plan: &plan, until };
    let mut asked = manifest_of(&run);
    // What is to be replaced is left alone until all trials are found, and a shard is never replaced.
    let replaces = merge.replace && !sources::is_among(merge.dirs, merge.out);
    let there = if replaces {
        None
    } else {
        finished(&out, &mut asked, false)?
    };
    let were_there = there.is_some();
    let comparison = match there {
        Some(comparison) => comparison,
        None => put_together(merge, &out, &run, asked, replaces)?,
    };
    Ok(Merged::Study {
        results: StudyResults {
            comparison,
            folder: out,
        },
        were_there,
    })
}

fn put_together(
    merge: &Merge,
    out: &StudyFolder,
    run: &StudyRun,
    mut manifest: StudyManifest,
    replaces: bool,
) -> Result<Comparison, MergeError> {
    let looked_into = (!replaces).then_some(merge.out);
    let folders = sources::folders(merge.dirs, looked_into);
    let mut kept = Vec::new();
    let mut lack = Lack::default();
    for setting in &run.plan.settings {
        let own = || folders.iter().map(|dir| Folder::new(dir.join(&setting.name)));
        let key = Manifest::new(&setting.scenario).key();
        let (there, found) = Kept::among(sources::parts(own(), key), setting.scenario.trials)?;
        kept.push(there);
        // Of a setting whose results have been written the trials may be gone.
        let is_written =
            || matches!(out.setting(&setting.name).contents(), Ok(Contents::Results(there)) if there.finished);
        if !found.missing.is_empty() && (replaces || !is_written()) {
            lack.damaged.extend(found.damaged);
            lack.of.push(MissingTrials {
                setting: Some(setting.name.clone()),
                trials: found.missing,
                of: setting.scenario.trials,
            });
        }
    }
    if !lack.of.is_empty() {
        lack.splits = sources::splits(folders.iter().map(|dir| StudyFolder::new(dir.clone()).trials()));
        return Err(MergeError::Missing(lack));
    }
    if replaces {
        finished(out, &mut manifest, true)?;
    }
    let mut settings = Settings::open(out, run, &manifest)?;
    let comparison = settings.compared();
    let stopping = match &comparison {
        Some(_) => None,
        None => {
            settings.recall(&kept)?;
            stopping(&settings)?
        }
    };
    out.declare(&manifest)?;
    settings.claim(&mut manifest, |place, _| kept[place].clone())?;
    let comparison = match comparison {
        Some(comparison) => comparison,
        None => settings.conclude(&mut manifest, stopping)?,
    };
    settings.finish(&mut manifest)?;
    Ok(comparison)
}

/// Whether the intervals are narrow enough, if the study asks for that.
fn stopping(settings: &Settings) -> Result<Option<Stopping>, MergeError> {
    let Some(until) = settings.until else { return Ok(None) };
    let stopping = settings.stopping(until);
    if stopping.reached || stopping.trials >= stopping.cap {
        return Ok(Some(stopping));
    }
    // An interval narrows with the root of the number of trials.
    let factor = stopping.widest.map_or(2.0, |widest| (widest / stopping.width).powi(2));
    let enough = (f64::from(stopping.trials) * factor).ceil() as u32;
    Err(MergeError::Wide {
        enough: enough.clamp(stopping.trials + 1, stopping.cap),
        figure: stopping.figure,
        width: stopping.width,
        widest: stopping.widest,
        trials: stopping.trials,
    })
}

/// Of shards, the one that asks for most trials; the first of those that ask for as many.
fn fullest(shards: &[(PathBuf, StudyManifest)]) -> (PathBuf, StudyManifest) {
    let trials = |manifest: &StudyManifest| {
        let all = manifest.plan["trials"].as_array().into_iter().flatten();
        all.filter_map(serde_json::Value::as_u64).sum::<u64>()
    };
    let most = shards.iter().rev().max_by_key(|(_, manifest)| trials(manifest));
    most.expect("at least one folder").clone()
}

/// The scenarios of a study's settings, each from the folders that have it, which must agree.
fn scenarios(shards: &[(PathBuf, StudyManifest)], manifest: &StudyManifest) -> Result<Vec<Scenario>, MergeError> {
    let of_setting = |name: &String| {
        let there = sources::settings(shards, name)?;
        let (dir, manifest) = &there[0];
        scenario::own(dir, manifest)
    };
    manifest.settings.iter().map(of_setting).collect()
}
