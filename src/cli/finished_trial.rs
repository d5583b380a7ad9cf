//! A finished trial that is run once more: what `explain` and `replay` begin with.

use std::path::{Path, PathBuf};

use tokio_util::sync::CancellationToken;

use super::failure::Failure;
use super::interrupt;
use crate::export::{Contents, Folder, FolderError, Manifest, StudyFolder, TrialEntry};
use crate::kind::TrialError;
use crate::metrics::TrialRecord;
use crate::scenario::{Scenario, parse, to_ron};
use crate::text::shown;

/// A trial of finished results.
#[derive(Debug)]
pub struct FinishedTrial {
    /// The folder.
    pub dir: PathBuf,
    /// Its number.
    pub trial: u32,
    /// What the folder says of itself.
    pub manifest: Manifest,
    /// The scenario that it holds.
    pub scenario: Scenario,
    digest: String,
    simulated_s: f64,
}

impl FinishedTrial {
    /// Trial number `trial` of the results in `dir`, all of which are as they were written.
    ///
    /// # Errors
    /// If there are no such results, or no such trial.
    pub fn of(dir: &Path, trial: u32) -> Result<Self, Failure> {
        let manifest = results(dir)?;
        let scenario = scenario(&manifest, dir)?;
        let entry = recorded(&manifest, dir, trial)?;
        let (digest, simulated_s) = (entry.digest.clone(), entry.simulated_s);
        Ok(Self {
            dir: dir.to_owned(),
            trial,
            manifest,
            scenario,
            digest,
            simulated_s,
        })
    }

    /// The digest of its events, in hexadecimal digits.
    pub fn digest(&self) -> &str {
        &self.digest
    }

    /// How long it lasted, seconds.
    pub fn simulated_s(&self) -> f64 {
        self.simulated_s
    }

    /// Runs it again by `run`, which also answers what it has gathered.
    ///
    /// # Errors
    /// If it does not reach its end, or is not what the results have: `tells` says what would have been made of it.
    pub fn again<T>(
        &self,
        tells: &str,
        run: impl FnOnce(&CancellationToken) -> Result<(TrialRecord, T), TrialError>,
    ) -> Result<(TrialRecord, T), Failure> {
        let stop = CancellationToken::new();
        interrupt::cancels(&stop).map_err(|error| Failure::other(&error))?;
        let (record, gathered) = run(&stop).map_err(|error| {
            if stop.is_cancelled() {
                Failure::Interrupted("interrupted".to_owned())
            } else {
                Failure::other(&error)
            }
        })?;
        let now = format!("{:032x}", record.digest);
        if now == self.digest {
            return Ok((record, gathered));
        }
        refuse(format!(
            "this desim does not run trial {} as the results have it (digest {} there, {now} now; desim {} there, {} now): what it would {tells} is not what happened.\n{} the results with the version that made them, or make them again with --force.",
            self.trial,
            self.digest,
            self.manifest.version,
            env!("CARGO_PKG_VERSION"),
            capitalised(tells)
        ))
    }
}

fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters
        .next()
        .map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// Says what is wrong with what was asked for.
pub fn refuse<T>(message: impl Into<String>) -> Result<T, Failure> {
    Err(Failure::Input(format!("error: {}", message.into())))
}

/// The manifest of the finished results in `dir`, all of which are as they were written.
fn results(dir: &Path) -> Result<Manifest, Failure> {
    let shown = shown(dir);
    if !dir.exists() {
        return refuse(format!("there is no folder {shown}"));
    }
    if StudyFolder::is_at(dir) {
        return refuse(of_a_setting(dir)?);
    }
    let folder = Folder::new(dir.to_owned());
    match folder.contents() {
        Ok(Contents::Results(manifest)) if manifest.finished => {
            folder.held(&manifest, &[])?;
            Ok(manifest)
        }
        Ok(Contents::Results(_)) => refuse(format!(
            "the results in {shown} are unfinished: run the same `desim scenario` command to its end first, or `desim merge` once all shards are done"
        )),
        Ok(Contents::Nothing) | Err(FolderError::Foreign { .. } | FolderError::NotAFolder(_)) => {
            refuse(format!("{shown} holds no results of desim"))
        }
        Err(error) => Err(error.into()),
    }
}

/// What is said to who names the folder of a study, whose trials are those of its settings.
fn of_a_setting(dir: &Path) -> Result<String, Failure> {
    let manifest = StudyFolder::new(dir.to_owned()).contents()?;
    let settings = manifest.map(|manifest| manifest.settings).unwrap_or_default();
    let folder = settings.first().map_or_else(|| dir.to_owned(), |first| dir.join(first));
    Ok(format!(
        "{} holds a study, and a trial is one of a setting: give the folder of a setting, such as {}\nIts settings are {}.",
        shown(dir),
        shown(&folder),
        settings.join(", ")
    ))
}

/// The scenario that `manifest` holds.
fn scenario(manifest: &Manifest, dir: &Path) -> Result<Scenario, Failure> {
    let place = shown(&dir.join("manifest.json"));
    let scenario: Scenario = serde_json::from_value(manifest.scenario.clone()).or_else(|error| {
        refuse(format!(
            "the scenario in {place} is of another version ({error}; desim {} there, {} now)",
            manifest.version,
            env!("CARGO_PKG_VERSION")
        ))
    })?;
    // Somebody may have edited it: it must hold as any scenario file must.
    Ok(parse(&place, &to_ron(&scenario), &[])?)
}

/// What is known of the trial.
fn recorded<'a>(manifest: &'a Manifest, dir: &Path, trial: u32) -> Result<&'a TrialEntry, Failure> {
    let found = manifest.trials.iter().find(|entry| entry.trial == trial);
    let Some(found) = found else {
        return refuse(format!(
            "there is no trial {}: {} has trials 0 to {}",
            trial,
            shown(dir),
            manifest.trials.len().saturating_sub(1)
        ));
    };
    Ok(found)
}
