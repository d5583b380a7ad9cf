//! A study, run into a folder: its settings in folders of their own, and what compares them.

use std::path::Path;

use serde_json::json;

use super::asked::StudyRun;
use super::error::{Other, RunsError};
use super::options::Options;
use super::settings::{Cell, Settings};
use super::trials::{Happening, Run};
use crate::experiment::{Claim, Ending, Experiment, Kept, Parts, Shard};
use crate::export::{FolderError, StudyFolder, StudyManifest};
use crate::metrics::comparison::{Comparison, Stopping};
use crate::scenario::Scenario;

/// Finished results of a study.
#[derive(Clone, Debug)]
pub struct StudyResults {
    /// What they tell.
    pub comparison: Comparison,
    /// Where they are.
    pub folder: StudyFolder,
}

/// Runs the trials of a study that are missing in the folder `dir`, all settings in one pool, compares, and writes the results there; answers
/// those that are there already.
///
/// # Errors
/// If the folder holds something else, or is in use, or a trial fails, or somebody cancels, or the file system refuses.
pub fn run_study(
    run: &StudyRun,
    dir: &Path,
    options: &Options,
    mut tell: impl FnMut(Happening),
) -> Result<StudyResults, RunsError> {
    let folder = StudyFolder::new(dir.to_owned());
    let mut manifest = manifest_of(run);
    let comparison = if let Some(comparison) = finished(&folder, &mut manifest, options.replace)? {
        tell(Happening::There);
        comparison
    } else {
        let settings = Settings::open(&folder, run, &manifest)?;
        Running {
            settings,
            options,
            manifest,
        }
        .compare(&mut tell)?
    };
    Ok(StudyResults { comparison, folder })
}

/// What the folder of a study that has just begun says of itself.
pub(super) fn manifest_of(run: &StudyRun) -> StudyManifest {
    let names = run.plan.settings.iter().map(|setting| setting.name.clone()).collect();
    let settings = run.plan.settings.iter();
    let program = settings
        .map(|setting| &setting.scenario)
        .find_map(crate::export::program);
    StudyManifest::new(described(run), names, program)
}

/// What the results depend on, beside the settings' scenarios.
fn described(run: &StudyRun) -> serde_json::Value {
    let plan = run.plan;
    json!({
        "name": plan.name,
        "question": plan.question,
        "factors": plan.factors,
        "levels": plan.settings.iter().map(|setting| &setting.levels).collect::<Vec<_>>(),
        "trials": plan.settings.iter().map(|setting| setting.scenario.trials).collect::<Vec<_>>(),
        "figures": plan.figures,
        "reference": plan.reference,
        "relevant": plan.relevant,
        "pareto": plan.pareto,
        "until_width": run.until,
    })
}

/// The comparison, if it is there and finished. The folder is then ready for the others: it holds nothing, or trials of the same
/// study, whose files `asked` then names.
pub(super) fn finished(
    folder: &StudyFolder,
    asked: &mut StudyManifest,
    replace: bool,
) -> Result<Option<Comparison>, RunsError> {
    let there = match folder.contents() {
        Ok(Some(there)) => there,
        Ok(None) => return Ok(None),
        // Whatever it was, it is to be replaced.
        Err(FolderError::Altered { .. } | FolderError::Version { .. }) if replace => asked.clone(),
        Err(error) => return Err(error.into()),
    };
    if replace {
        for name in &there.settings {
            // Opening the trials makes sure that nobody is running them.
            let trials = folder.setting(name).trials();
            if trials.exists() {
                drop(Claim::lay(&trials)?);
            }
        }
        folder.clear(&there.settings)?;
        return Ok(None);
    }
    let differences = there.differences(asked);
    if !differences.is_empty() {
        return Err(RunsError::Taken {
            dir: folder.path().to_owned(),
            of: Other::Study,
            differences,
        });
    }
    if there.finished {
        let comparison = folder.finished(&there)?;
        folder.hold_page(&there)?;
        folder.tidy(&there);
        return Ok(Some(comparison));
    }
    asked.files = there.files;
    Ok(None)
}

/// A study that is being run.
struct Running<'a> {
    settings: Settings<'a>,
    options: &'a Options,
    manifest: StudyManifest,
}

impl Running<'_> {
    /// Runs the trials that are missing, compares, and writes everything.
    fn compare(mut self, tell: &mut dyn FnMut(Happening)) -> Result<Comparison, RunsError> {
        self.settings.study.declare(&self.manifest)?;
        self.settings
            .claim(&mut self.manifest, |_, parts| Kept::in_one(parts.clone()))?;
        let comparison = match self.settings.compared() {
            Some(comparison) => comparison,
            None => {
                let stopping = self.simulate(tell)?;
                self.settings.conclude(&mut self.manifest, stopping)?
            }
        };
        self.settings.finish(&mut self.manifest)?;
        Ok(comparison)
    }

    /// Runs trials until there are as many as were asked for, or the intervals are narrow enough.
    fn simulate(&mut self, tell: &mut dyn FnMut(Happening)) -> Result<Option<Stopping>, RunsError> {
        let batch: Vec<u32> = self.settings.cells.iter().map(|cell| cell.scenario.trials).collect();
        loop {
            self.batch(tell)?;
            let Some(until) = self.settings.until else {
                return Ok(None);
            };
            let stopping = self.settings.stopping(until);
            if stopping.reached || stopping.trials >= stopping.cap {
                return Ok(Some(stopping));
            }
            for (cell, batch) in self.settings.cells.iter_mut().zip(&batch) {
                let more = cell.scenario.trials.saturating_add(*batch);
                cell.scenario.trials = more.min(stopping.cap.max(*batch));
            }
        }
    }

    /// Runs the trials that are missing, of all settings in one pool, and reads what all of them tell.
    fn batch(&mut self, tell: &mut dyn FnMut(Happening)) -> Result<(), RunsError> {
        let cells = self.settings.cells.iter();
        let trials: Vec<(&Scenario, &Parts)> = cells
            .filter_map(|cell| Some((&cell.scenario, &cell.trials.as_ref()?.parts)))
            .collect();
        let run = Run {
            scenarios: &trials,
            shard: Shard::WHOLE,
            kept: self.kept(),
            signs: &self.settings.study.trials(),
        };
        let ending = run.missing(self.options, |_, _| (), tell);
        if let Ok(Ending::Finished) = ending {
            let kept: Vec<Kept> = trials
                .into_iter()
                .map(|(_, parts)| Kept::in_one(parts.clone()))
                .collect();
            return self.settings.recall(&kept);
        }
        let interrupted = self.leave()?;
        ending?;
        Err(interrupted)
    }

    /// How many trials are kept by now, of all settings.
    fn kept(&self) -> u32 {
        let of = |cell: &Cell| {
            let experiment = Experiment {
                trials: cell.scenario.trials,
                shard: Shard::WHOLE,
                parts: &cell.trials.as_ref()?.parts,
            };
            Some(experiment.kept())
        };
        self.settings.cells.iter().filter_map(of).sum()
    }

    /// Leaves an unfinished study: finished trials stay, and if there are none, nothing does. Answers how many there are.
    fn leave(&mut self) -> Result<RunsError, RunsError> {
        let kept = self.kept();
        let Settings { study, cells, .. } = &mut self.settings;
        for cell in cells.iter_mut() {
            cell.trials = None;
        }
        if kept == 0 {
            study.clear(&self.manifest.settings)?;
        }
        Ok(RunsError::Interrupted {
            kept: kept as usize,
            trials: cells.iter().map(|cell| cell.scenario.trials).sum(),
            dir: study.path().to_owned(),
        })
    }
}
