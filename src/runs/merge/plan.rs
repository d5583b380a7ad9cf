//! The plan of a study, read back from what its folders say.

use std::path::Path;

use serde::Deserialize;

use super::error::MergeError;
use crate::export::StudyManifest;
use crate::runs::Until;
use crate::scenario::{Plan, Scenario, Setting, Warnings};

/// What `study.json` says of the plan, as [`study::described`](crate::runs::study) writes it.
#[derive(Deserialize)]
struct Described {
    name: String,
    question: Option<String>,
    factors: Vec<(String, Vec<String>)>,
    levels: Vec<Vec<String>>,
    trials: Vec<u32>,
    figures: Vec<String>,
    reference: Option<usize>,
    relevant: f64,
    pareto: Option<[String; 2]>,
    until_width: Option<Until>,
}

/// The plan of the study in `dir`, whose settings have the `scenarios`, and until when trials are added.
pub fn plan(
    dir: &Path,
    manifest: &StudyManifest,
    scenarios: Vec<Scenario>,
) -> Result<(Plan, Option<Until>), MergeError> {
    let foreign = |wrong: String| MergeError::Foreign {
        dir: dir.to_owned(),
        differences: vec![wrong],
    };
    let described = Described::deserialize(&manifest.plan).map_err(|error| foreign(error.to_string()))?;
    // The name is that of a folder below the study's.
    if let Some(name) = manifest.settings.iter().find(|name| name.contains(['/', '\\', '.'])) {
        return Err(foreign(format!("the setting `{name}` leads out of the folder")));
    }
    let settings = manifest.settings.len();
    if [described.levels.len(), described.trials.len(), scenarios.len()] != [settings; 3] {
        return Err(foreign("its plan is of other settings than it has".to_owned()));
    }
    let given = manifest.settings.iter().zip(described.levels).zip(described.trials);
    let settings = given
        .zip(scenarios)
        .map(|(((name, levels), trials), scenario)| Setting {
            name: name.clone(),
            levels,
            scenario: Scenario { trials, ..scenario },
            warnings: Warnings::default(),
        });
    let plan = Plan {
        name: described.name,
        question: described.question,
        factors: described.factors,
        settings: settings.collect(),
        figures: described.figures,
        reference: described.reference.filter(|place| *place < manifest.settings.len()),
        relevant: described.relevant,
        pareto: described.pareto,
        most_trials: None,
        trials_place: None,
        warnings: Warnings::default(),
    };
    Ok((plan, described.until_width))
}
