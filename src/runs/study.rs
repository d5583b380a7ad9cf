//! A study, run into a folder: its settings in folders of their own, and what compares them.

use std::path::Path;

use serde_json::json;

use super::asked::{StudyRun, Until};
use super::error::{Other, RunsError};
use super::options::Options;
use super::settings::Settings;
use super::trials::Happening;
use crate::experiment::Parts;
use crate::export::{FolderError, StudyFolder, StudyManifest};
use crate::metrics::comparison::Comparison;

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
    let names = run.plan.settings.iter().map(|setting| setting.name.clone()).collect();
    let settings = run.plan.settings.iter();
    let program = settings
        .map(|setting| &setting.scenario)
        .find_map(crate::export::program);
    let mut manifest = StudyManifest::new(described(run), names, program);
    let comparison = if let Some(comparison) = finished(&folder, &mut manifest, options.replace)? {
        tell(Happening::There);
        comparison
    } else {
        Settings::open(&folder, run, options, &manifest)?.compare(manifest, &mut tell)?
    };
    Ok(StudyResults { comparison, folder })
}

/// What the results depend on, beside the settings' scenarios.
fn described(run: &StudyRun) -> serde_json::Value {
    let plan = run.plan;
    let until_width = run
        .until
        .map(|Until { width, most_trials }| json!({"width": width, "most_trials": most_trials}));
    json!({
        "name": plan.name,
        "question": plan.question,
        "factors": plan.factors,
        "trials": plan.settings.iter().map(|setting| setting.scenario.trials).collect::<Vec<_>>(),
        "figures": plan.figures,
        "reference": plan.reference,
        "relevant": plan.relevant,
        "pareto": plan.pareto,
        "until_width": until_width,
    })
}

/// The comparison, if it is there and finished. The folder is then ready for the others: it holds nothing, or trials of the same
/// study, whose files `asked` then names.
fn finished(folder: &StudyFolder, asked: &mut StudyManifest, replace: bool) -> Result<Option<Comparison>, RunsError> {
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
                drop(Parts::open(&trials)?);
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
