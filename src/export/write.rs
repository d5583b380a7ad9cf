//! From the finished trials of an experiment to its results folder.

use super::files::SUMMARY;
use super::folder::{Contents, Folder};
use super::manifest::{Manifest, TrialEntry};
use super::names::Names;
use super::place::{FolderError, WriteError, failed, json};
use super::scene::Scene;
use super::tables::Tables;
use crate::experiment::{Claim, FinishedTrial, Kept, reach};
use crate::metrics::summary::Trials;
use crate::metrics::{Summary, TrialRecord};
use crate::radio::Reach;
use crate::scenario::Scenario;

/// Of which trials to draw pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pictures {
    /// Of none.
    None,
    /// Of the first.
    #[default]
    First,
    /// Of all.
    All,
}

/// Writes the results of `scenario`, all of whose trials are `kept` there or elsewhere, to `folder`, to whose trials somebody has laid `claim`: one
/// trial at a time, in order, every file whole before it is put in its place, the manifest last. Then the folder's own trials go.
///
/// # Errors
/// If a trial cannot be read or a file not be written; the trials then stay.
pub fn write(
    folder: &Folder,
    claim: Claim,
    kept: &Kept,
    scenario: &Scenario,
    pictures: Pictures,
) -> Result<(Summary, Manifest), WriteError> {
    let (names, scene) = (names(scenario), scene(scenario));
    let declared = match folder.contents()? {
        Contents::Results(declared) => declared,
        Contents::Nothing => Manifest::new(scenario),
    };
    let mut manifest = Manifest {
        finished: true,
        ..declared
    };
    let (mut files, staging) = (Vec::<String>::new(), folder.trials());
    let mut tables = Tables::create(&staging, names, scene.targets.len()).map_err(failed("write", &staging))?;
    let figures = scenario.figures();
    let mut trials = Trials::new(&figures, names.topics, names.roles);
    for trial in 0..scenario.trials {
        let part = kept.load(trial)?;
        tables.append(&part.record).map_err(failed("write", &staging))?;
        if pictures == Pictures::All || (pictures == Pictures::First && trial == 0) {
            files.extend(draw(folder, &scene, &part.record, &reach(scenario, trial))?);
        }
        manifest.trials.push(entry(&part));
        trials.add(&part.record);
    }
    let tables = tables.finish().map_err(failed("write", &staging))?;
    files.extend(tables.into_iter().map(str::to_owned));
    let summary = trials.summary(&scenario.name);
    folder.stage(SUMMARY, &json(&summary))?;
    files.push(SUMMARY.to_owned());
    for name in files {
        let measured = folder.measure(&name)?;
        folder.place(&name)?;
        manifest.files.insert(name, measured);
    }
    folder.sweep(&manifest)?;
    folder.declare(&manifest)?;
    drop(claim);
    folder.drop_trials()?;
    Ok((summary, manifest))
}

/// Draws a trial and answers the names of the files.
fn draw(folder: &Folder, scene: &Scene, record: &TrialRecord, reach: &Reach) -> Result<Vec<String>, FolderError> {
    let staged = scene.draw(record, reach).into_iter().map(|(kind, picture)| {
        let name = format!("{kind}_{}.svg", record.trial);
        folder.stage(&name, picture.as_bytes()).map(|()| name)
    });
    staged.collect()
}

fn entry(part: &FinishedTrial) -> TrialEntry {
    TrialEntry {
        trial: part.record.trial,
        digest: format!("{:032x}", part.record.digest),
        simulated_s: part.record.simulated.as_secs(),
        delivered: part.record.ledger.iter().map(|fates| fates.delivered).sum(),
        wall_s: part.wall_s,
    }
}

/// What the scenario's protocol calls its topics and roles.
fn names(scenario: &Scenario) -> Names {
    Names {
        topics: scenario.topics(),
        roles: scenario.protocol.roles(),
    }
}

/// What stands still in the scenario's pictures.
fn scene(scenario: &Scenario) -> Scene {
    let targets = scenario
        .protocol
        .targets()
        .into_iter()
        .flat_map(|targets| targets.places);
    Scene {
        name: scenario.name.clone(),
        arena: scenario.arena.clone(),
        targets: targets.map(|(place, _)| place).collect(),
        roles: names(scenario).roles,
    }
}
