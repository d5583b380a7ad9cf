//! A shard of a scenario or a study, run into a folder: finished trials, and no results yet. Shards may share the folder or have folders of their
//! own; [`merge`](super::merge) puts them together. A shard deletes nothing, for others may be at work beside it.

use std::io;
use std::path::Path;

use super::asked::{ScenarioRun, StudyRun};
use super::error::{Other, RunsError};
use super::options::Options;
use super::trials::{Happening, Run};
use super::{scenario, study};
use crate::experiment::{Ending, Parts, PartsError, Shard};
use crate::export::{Contents, Folder, Manifest, StudyFolder};
use crate::scenario::Scenario;

/// What a shard has come to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FinishedShard {
    /// How many trials it has, all of which are finished.
    pub trials: u32,
    /// Whether the folder holds the results of all shards already.
    pub is_merged: bool,
}

/// Runs those trials of a scenario that `shard` has and that are missing in the folder `dir`.
///
/// # Errors
/// If the folder holds something else, or a trial fails, or somebody cancels, or the file system refuses.
pub fn run_scenario_shard(
    run: &ScenarioRun,
    shard: Shard,
    dir: &Path,
    options: &Options,
    mut tell: impl FnMut(Happening),
) -> Result<FinishedShard, RunsError> {
    let folder = Folder::new(dir.to_owned());
    let asked = scenario::manifest_of(run);
    if !declare(&folder, &asked, Other::Scenario)? {
        tell(Happening::There);
        return Ok(merged(shard.trials(run.scenario.trials).len()));
    }
    let parts = folder.parts(&asked);
    let signs = folder.trials();
    let is_merged = || Ok(matches!(folder.contents()?, Contents::Results(there) if there.finished));
    run_missing(
        &[(run.scenario, &parts)],
        shard,
        &signs,
        dir,
        options,
        &mut tell,
        is_merged,
    )
}

/// Runs those trials of a study's settings that `shard` has and that are missing in the folder `dir`, all settings in one pool.
///
/// # Errors
/// As [`run_scenario_shard`].
pub fn run_study_shard(
    run: &StudyRun,
    shard: Shard,
    dir: &Path,
    options: &Options,
    mut tell: impl FnMut(Happening),
) -> Result<FinishedShard, RunsError> {
    let study = StudyFolder::new(dir.to_owned());
    let asked = study::manifest_of(run);
    let settings = run.plan.settings.iter();
    let trials = settings
        .clone()
        .map(|setting| shard.trials(setting.scenario.trials).len());
    let there = study.contents()?;
    if let Some(there) = &there {
        let differences = there.differences(&asked);
        if !differences.is_empty() {
            return Err(RunsError::Taken {
                dir: dir.to_owned(),
                of: Other::Study,
                differences,
            });
        }
        if there.finished {
            tell(Happening::There);
            return Ok(merged(trials.sum()));
        }
    }
    if there.is_none_or(|there| there.plan != asked.plan) {
        study.declare(&asked)?;
    }
    let mut open: Vec<(&Scenario, Parts)> = Vec::new();
    for setting in settings {
        let (folder, asked) = (study.setting(&setting.name), Manifest::new(&setting.scenario));
        if declare(&folder, &asked, Other::Setting)? {
            open.push((&setting.scenario, folder.parts(&asked)));
        }
    }
    let scenarios: Vec<(&Scenario, &Parts)> = open.iter().map(|(scenario, parts)| (*scenario, parts)).collect();
    let is_merged = || Ok(study.contents()?.is_some_and(|there| there.finished));
    run_missing(&scenarios, shard, &study.trials(), dir, options, &mut tell, is_merged)
}

/// Says in `folder` what it is to hold, unless that is known; false if the results are there already.
fn declare(folder: &Folder, asked: &Manifest, of: Other) -> Result<bool, RunsError> {
    let Contents::Results(there) = folder.contents()? else {
        folder.declare(asked)?;
        return Ok(true);
    };
    let differences = there.differences(asked);
    if !differences.is_empty() {
        return Err(RunsError::Taken {
            dir: folder.path().to_owned(),
            of,
            differences,
        });
    }
    if there.finished {
        return Ok(false);
    }
    if there != *asked {
        folder.declare(asked)?;
    }
    // An attempt that was killed may have said so and come no further.
    std::fs::create_dir_all(folder.trials()).map_err(|source| PartsError::Io {
        action: "create the folder",
        path: folder.trials(),
        source,
    })?;
    Ok(true)
}

fn run_missing(
    scenarios: &[(&Scenario, &Parts)],
    shard: Shard,
    signs: &Path,
    dir: &Path,
    options: &Options,
    tell: &mut dyn FnMut(Happening),
    is_merged: impl Fn() -> Result<bool, RunsError>,
) -> Result<FinishedShard, RunsError> {
    let own = |(scenario, _): &(&Scenario, _)| shard.trials(scenario.trials);
    let trials: usize = scenarios.iter().map(|one| own(one).len()).sum();
    let kept = || -> usize {
        let missing = scenarios.iter().map(|one| one.1.missing(own(one)).len());
        trials - missing.sum::<usize>()
    };
    let run = Run {
        scenarios,
        shard,
        kept: kept() as u32,
        signs,
    };
    match run.missing(options, |_, _| (), tell) {
        Ok(Ending::Finished) => Ok(FinishedShard {
            trials: trials as u32,
            is_merged: false,
        }),
        Ok(Ending::Interrupted) => Err(RunsError::Interrupted {
            kept: kept(),
            trials: trials as u32,
            dir: dir.to_owned(),
        }),
        // The trials' folder goes once the results are there, which somebody else has made meanwhile.
        Err(RunsError::Parts(PartsError::Io { source, .. }))
            if source.kind() == io::ErrorKind::NotFound && is_merged()? =>
        {
            tell(Happening::There);
            Ok(merged(trials))
        }
        Err(error) => Err(error),
    }
}

fn merged(trials: usize) -> FinishedShard {
    FinishedShard {
        trials: trials as u32,
        is_merged: true,
    }
}
