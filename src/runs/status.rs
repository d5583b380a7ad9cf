//! How far the trials in some folders are, whoever runs them. Reads names of files and what processes say of themselves, and no trial.

use std::collections::BTreeSet;
use std::num::NonZeroU32;
use std::path::PathBuf;

use super::merge::sources::{self, Shards};
use super::merge::{MergeError, ranges};
use super::runner::{Health, Runner, now_s};
use crate::experiment::Shard;
use crate::export::{Folder, Manifest, StudyFolder, StudyManifest};
use crate::report::{FailedTrial, ProcessProgress, Progress, SettingProgress};

/// How far the trials of one scenario or study are that are in `dirs`, at least one.
///
/// # Errors
/// If a folder holds none, or they are of different ones.
///
/// # Panics
/// If there is no folder.
pub fn status(dirs: &[PathBuf]) -> Result<Progress, MergeError> {
    let status = match sources::shards(dirs)? {
        Shards::Scenario(shards) => of_scenario(&shards)?,
        Shards::Study(shards) => of_study(&shards)?,
    };
    Ok(status.progress(now_s()))
}

/// What is known of the trials.
struct Status {
    name: String,
    scenarios: Vec<Trials>,
    /// Whether `scenarios` are settings.
    is_study: bool,
    finished: bool,
    runners: Vec<Runner>,
}

/// The trials of a scenario.
struct Trials {
    name: String,
    of: u32,
    done: BTreeSet<u32>,
}

fn of_scenario(shards: &[(PathBuf, Manifest)]) -> Result<Status, MergeError> {
    let trials = trials(shards)?;
    Ok(Status {
        name: trials.name.clone(),
        finished: shards.iter().any(|(_, manifest)| manifest.finished),
        scenarios: vec![trials],
        is_study: false,
        runners: runners(shards.iter().map(|(dir, _)| Folder::new(dir.clone()).trials())),
    })
}

fn of_study(shards: &[(PathBuf, StudyManifest)]) -> Result<Status, MergeError> {
    let mut scenarios = Vec::new();
    let (_, first) = &shards[0];
    for setting in &first.settings {
        scenarios.push(Trials {
            name: setting.clone(),
            ..trials(&sources::settings(shards, setting)?)?
        });
    }
    Ok(Status {
        name: first.plan["name"].as_str().unwrap_or_default().to_owned(),
        scenarios,
        is_study: true,
        finished: shards.iter().any(|(_, manifest)| manifest.finished),
        runners: runners(shards.iter().map(|(dir, _)| StudyFolder::new(dir.clone()).trials())),
    })
}

/// The trials of a scenario that are done in any of the folders.
fn trials(folders: &[(PathBuf, Manifest)]) -> Result<Trials, MergeError> {
    let fullest = sources::fullest(folders.iter().map(|(_, manifest)| manifest));
    let scenario = fullest.map(|manifest| manifest.scenario).unwrap_or_default();
    let of = scenario["trials"]
        .as_u64()
        .and_then(|trials| u32::try_from(trials).ok())
        .unwrap_or(0)
        .min(Shard::MOST);
    let mut done = BTreeSet::new();
    for (dir, manifest) in folders {
        if manifest.finished {
            done.extend(0..of);
        }
        let parts = Folder::new(dir.clone()).parts(manifest);
        done.extend(parts.there()?.into_iter().filter(|trial| *trial < of));
    }
    Ok(Trials {
        name: scenario["name"].as_str().unwrap_or_default().to_owned(),
        of,
        done,
    })
}

/// The latest process of each shard, in order of shards.
fn runners(trials: impl Iterator<Item = PathBuf>) -> Vec<Runner> {
    let mut all: Vec<Runner> = trials.flat_map(|dir| Runner::all(&dir)).collect();
    Runner::latest(&mut all);
    all
}

impl Status {
    fn progress(&self, now_s: f64) -> Progress {
        let sum = |of: fn(&Trials) -> usize| self.scenarios.iter().map(of).sum::<usize>() as u64;
        let at_work: Vec<&Runner> = self.at_work(now_s).collect();
        let splits: BTreeSet<NonZeroU32> = self
            .runners
            .iter()
            .filter_map(|runner| NonZeroU32::new(runner.shard().of()))
            .collect();
        let unattended = self.unattended(&at_work);
        let shards =
            |of: NonZeroU32| -> BTreeSet<u32> { unattended.iter().map(|trial| Shard::having(*trial, of)).collect() };
        let shards = match splits.first() {
            Some(of) if splits.len() == 1 && of.get() > 1 && !unattended.is_empty() => Some(ranges(shards(*of))),
            _ => None,
        };
        let settings = self.scenarios.iter().filter(|_| self.is_study);
        Progress {
            name: self.name.clone(),
            trials: sum(|trials| trials.of as usize),
            done: sum(|trials| trials.done.len()),
            finished: self.finished,
            settings: settings
                .map(|trials| SettingProgress {
                    name: trials.name.clone(),
                    trials: trials.of.into(),
                    done: trials.done.len() as u64,
                })
                .collect(),
            processes: self.runners.iter().map(|runner| self.process(runner, now_s)).collect(),
            failed: self.runners.iter().filter_map(|runner| self.failed(runner)).collect(),
            unattended: unattended.len() as u64,
            unattended_shards: shards,
            left_s: self.left_s(&at_work),
        }
    }

    fn at_work(&self, now_s: f64) -> impl Iterator<Item = &Runner> {
        let is_at_work = move |runner: &&Runner| runner.health(now_s) == Health::Running;
        self.runners.iter().filter(is_at_work)
    }

    /// The trials, of all settings, that are not done and that no process at work has.
    fn unattended(&self, at_work: &[&Runner]) -> Vec<u32> {
        let has = |trial: u32| {
            let of = |runner: &&Runner| NonZeroU32::new(runner.shard().of()).map(|of| (runner.shard(), of));
            let mut shards = at_work.iter().copied().filter_map(|runner| of(&runner));
            shards.any(|(shard, of)| Shard::having(trial, of) == shard.number())
        };
        let open = |trials: &Trials| -> Vec<u32> {
            let missing = (0..trials.of).filter(|trial| !trials.done.contains(trial));
            missing.filter(|trial| !has(*trial)).collect()
        };
        if self.finished {
            return Vec::new();
        }
        self.scenarios.iter().flat_map(open).collect()
    }

    /// A process that has finished no trial yet is taken to need as long for one as the others.
    fn left_s(&self, at_work: &[&Runner]) -> Option<f64> {
        let mean = |runners: &mut dyn Iterator<Item = &Runner>| {
            let (wall_s, finished) = runners.fold((0.0, 0), |(wall_s, finished), runner| {
                (wall_s + runner.wall_s, finished + runner.finished)
            });
            (finished > 0).then(|| wall_s / f64::from(finished))
        };
        let all = mean(&mut self.runners.iter());
        let left = |runner: &&Runner| {
            let trial_s = mean(&mut std::iter::once(*runner)).or(all)?;
            let turns = f64::from(runner.left) / runner.jobs.max(1) as f64;
            Some(trial_s * turns)
        };
        at_work.iter().filter_map(left).max_by(f64::total_cmp)
    }

    fn process(&self, runner: &Runner, now_s: f64) -> ProcessProgress {
        let health = runner.health(now_s);
        let under_way = runner.under_way.iter().filter(|_| health == Health::Running);
        ProcessProgress {
            shard: runner.shard().to_string(),
            host: runner.host.clone(),
            process: runner.process,
            state: match health {
                Health::Running => "running",
                Health::Ended => "ended",
                Health::Silent => "silent",
            },
            finished: runner.finished,
            left: runner.left,
            under_way: under_way.map(|trial| self.named(trial.setting, trial.trial)).collect(),
            heard_s: (now_s - runner.heard_s).max(0.0),
        }
    }

    /// The trial on which a process has failed, if it is still not done.
    fn failed(&self, runner: &Runner) -> Option<FailedTrial> {
        let failed = runner.failed.as_ref()?;
        let is_done = self
            .scenarios
            .get(failed.setting)
            .is_some_and(|trials| trials.done.contains(&failed.trial));
        (!is_done && !self.finished).then(|| FailedTrial {
            trial: self.named(failed.setting, failed.trial),
            shard: runner.shard().to_string(),
            reason: failed.reason.clone(),
        })
    }

    /// A trial as people name it.
    fn named(&self, setting: usize, trial: u32) -> String {
        match self.scenarios.get(setting).filter(|_| self.is_study) {
            Some(setting) => format!("{trial} of {}", setting.name),
            None => trial.to_string(),
        }
    }
}
