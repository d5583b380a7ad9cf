//! A scenario, run into a folder.

use std::path::Path;

use super::asked::ScenarioRun;
use super::error::{Other, RunsError};
use super::options::Options;
use super::trials::{Happening, Run};
use crate::experiment::{Claim, Ending, Experiment, Kept, Shard};
use crate::export::{self, Contents, Folder, FolderError, Manifest};
use crate::metrics::Summary;
use crate::scenario::Scenario;

/// Finished results of a scenario.
#[derive(Clone, Debug)]
pub struct ScenarioResults {
    /// Their figures.
    pub summary: Summary,
    /// What ran, and the files.
    pub manifest: Manifest,
}

impl ScenarioResults {
    /// Those that are in a folder, finished.
    pub(super) fn there(folder: &Folder, manifest: Manifest) -> Result<Self, RunsError> {
        let summary = folder.summary(&manifest)?;
        folder.tidy();
        Ok(Self { summary, manifest })
    }
}

/// Runs the trials of a scenario that are missing in the folder `dir`, and writes the results there; answers those that are there already.
///
/// # Errors
/// If the folder holds something else, or is in use, or a trial fails, or somebody cancels, or the file system refuses.
pub fn run_scenario(
    run: &ScenarioRun,
    dir: &Path,
    options: &Options,
    mut tell: impl FnMut(Happening),
) -> Result<ScenarioResults, RunsError> {
    let folder = Folder::new(dir.to_owned());
    if let Some(manifest) = finished(&folder, run.scenario, options.replace)? {
        tell(Happening::There);
        return ScenarioResults::there(&folder, manifest);
    }
    simulate(&folder, run, options, &mut tell)
}

/// What the folder of a scenario that has just begun says of itself.
pub(super) fn manifest_of(run: &ScenarioRun) -> Manifest {
    Manifest {
        question: run.question.clone(),
        ..Manifest::new(run.scenario)
    }
}

/// The manifest of the results asked for, if they are there and finished. The folder is then ready for the others: it
/// holds nothing, or finished trials of the same experiment.
pub(super) fn finished(folder: &Folder, scenario: &Scenario, replace: bool) -> Result<Option<Manifest>, RunsError> {
    let there = match folder.contents() {
        Ok(Contents::Results(there)) => Some(there),
        Ok(Contents::Nothing) => {
            // Finished trials that nothing says the scenario of are of no use.
            folder.tidy();
            return Ok(None);
        }
        // Whatever it was, it is to be replaced.
        Err(FolderError::Altered { .. } | FolderError::Version { .. }) if replace => None,
        Err(error) => return Err(error.into()),
    };
    let Some(there) = there.filter(|_| !replace) else {
        // Opening the trials makes sure that nobody is running them.
        drop(Claim::lay(&folder.trials())?);
        folder.clear()?;
        return Ok(None);
    };
    let differences = there.differences(&Manifest::new(scenario));
    if differences.is_empty() {
        return Ok(there.finished.then_some(there));
    }
    Err(RunsError::Taken {
        dir: folder.path().to_owned(),
        of: Other::Scenario,
        differences,
    })
}

/// Runs the trials that are missing and writes the results.
fn simulate(
    folder: &Folder,
    run: &ScenarioRun,
    options: &Options,
    tell: &mut dyn FnMut(Happening),
) -> Result<ScenarioResults, RunsError> {
    let scenario = run.scenario;
    let claim = Claim::lay(&folder.trials())?;
    let manifest = manifest_of(run);
    folder.declare(&manifest)?;
    let parts = folder.parts(&manifest);
    let kept = || {
        let experiment = Experiment {
            trials: scenario.trials,
            shard: Shard::WHOLE,
            parts: &parts,
        };
        experiment.kept()
    };
    let missing = Run {
        scenarios: &[(scenario, &parts)],
        shard: Shard::WHOLE,
        kept: kept(),
        signs: parts.dir(),
    };
    let ending = missing.missing(options, |_, _| (), tell);
    if let Ok(Ending::Finished) = ending {
        let (summary, manifest) = export::write(folder, claim, &Kept::in_one(parts), scenario, run.pictures)?;
        return Ok(ScenarioResults { summary, manifest });
    }
    // Finished trials stay, and if there are none, nothing does.
    let kept = kept();
    if kept == 0 {
        folder.clear()?;
    }
    ending?;
    Err(RunsError::Interrupted {
        kept: kept as usize,
        trials: scenario.trials,
        dir: folder.path().to_owned(),
    })
}
