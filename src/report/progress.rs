//! How far the trials of a scenario or a study are, whose shards may be at work on many machines.

use serde::Serialize;

use super::grid::{Column, Grid};
use super::layout::Page;
use super::number::count;
use crate::text::Style;

/// How far the trials are.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Progress {
    /// Name of the scenario or the study.
    pub name: String,
    /// How many trials there are to be, of all settings.
    pub trials: u64,
    /// How many are done.
    pub done: u64,
    /// Whether the results have been written: then all trials are done.
    pub finished: bool,
    /// The settings of a study; empty for a scenario.
    pub settings: Vec<SettingProgress>,
    /// The processes that run trials, or did, the latest of each shard.
    pub processes: Vec<ProcessProgress>,
    /// Trials that failed and are still not done.
    pub failed: Vec<FailedTrial>,
    /// Trials that are not done and that no process at work has: to be run once more.
    pub unattended: u64,
    /// The shards that have such trials, as an array is given: `2,5-7`; absent where nobody says how the trials are split.
    pub unattended_shards: Option<String>,
    /// Seconds until the processes at work are done, if they go on as they have; absent if none is at work, or none has finished a trial.
    pub left_s: Option<f64>,
}

/// How far a setting is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SettingProgress {
    /// Its name.
    pub name: String,
    /// How many trials there are to be.
    pub trials: u64,
    /// How many are done.
    pub done: u64,
}

/// How far a process is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProcessProgress {
    /// Its shard, such as `2/4`.
    pub shard: String,
    /// The machine that it is on, and its number there.
    pub host: String,
    /// Its number there.
    pub process: u32,
    /// `running`, `ended`, or `silent`: not heard of for a minute, or known to be gone.
    pub state: &'static str,
    /// Trials that it has finished.
    pub finished: u32,
    /// Trials that it has, or had, left.
    pub left: u32,
    /// Trials that it is running: numbers, with the setting's name in a study.
    pub under_way: Vec<String>,
    /// Seconds since it was last heard of.
    pub heard_s: f64,
}

/// A trial that failed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FailedTrial {
    /// Its number, with the setting's name in a study.
    pub trial: String,
    /// The shard of the process that ran it.
    pub shard: String,
    /// Why.
    pub reason: String,
}

/// A duration in the unit in which people plan.
fn roughly(duration_s: f64) -> String {
    const UNITS: [(f64, &str); 3] = [(86_400.0, "days"), (3600.0, "hours"), (60.0, "minutes")];
    match UNITS.into_iter().find(|(unit, _)| duration_s >= 2.0 * unit) {
        Some((unit, name)) => format!("{:.0} {name}", duration_s / unit),
        None => format!("{duration_s:.0} s"),
    }
}

/// Most trials under way that are named of a process.
const NAMED: usize = 3;

impl Progress {
    /// For people.
    #[must_use]
    pub fn text(&self, style: Style) -> String {
        let mut page = Page::new(style);
        page.title(&self.name, None);
        page.entry(
            "done",
            &format!("{} of {} trials", count(self.done), count(self.trials)),
        );
        if self.finished {
            page.entry("", "the results have been written");
            return page.text();
        }
        let running = self.processes.iter().filter(|process| process.state == "running");
        let under_way: usize = running.clone().map(|process| process.under_way.len()).sum();
        page.entry(
            "running",
            &match running.count() {
                0 => "nobody is at work".to_owned(),
                1 => format!("1 process, {under_way} trials under way"),
                some => format!("{some} processes, {under_way} trials under way"),
            },
        );
        for failed in &self.failed {
            let FailedTrial { trial, shard, reason } = failed;
            page.entry("failed", &format!("trial {trial}, of shard {shard}: {reason}"));
        }
        if self.unattended > 0 {
            page.entry("not run", &self.not_run());
        } else if self.done == self.trials {
            page.entry(
                "next",
                "desim merge, or the same command without --shard, makes the results of them",
            );
        }
        if let Some(left) = self.left_s {
            page.entry("time left", &format!("about {}", roughly(left)));
        }
        if !self.settings.is_empty() {
            page.gap();
            let mut grid = Grid::of_figures(&["setting", "done", "trials"]);
            for setting in &self.settings {
                grid.row([setting.name.clone(), count(setting.done), count(setting.trials)]);
            }
            page.table(&grid);
        }
        if !self.processes.is_empty() {
            page.gap();
            page.table(&self.table());
        }
        page.text()
    }

    fn not_run(&self) -> String {
        let trials = match self.unattended {
            1 => "1 trial has nobody at work on it".to_owned(),
            some => format!("{} trials have nobody at work on them", count(some)),
        };
        match &self.unattended_shards {
            Some(shards) => format!("{trials}: --array={shards} runs them"),
            None => trials,
        }
    }

    fn table(&self) -> Grid {
        use Column::{Figures, Words};
        let columns = [Words, Words, Words, Figures, Figures, Words, Figures];
        let mut grid = Grid::new(
            &columns,
            ["shard", "process", "state", "done", "left", "under way", "heard of"],
        );
        for process in &self.processes {
            let named = process.under_way.iter().take(NAMED);
            let mut under_way = named.cloned().collect::<Vec<_>>().join(", ");
            if process.under_way.len() > NAMED {
                under_way = format!("{under_way} and {} more", process.under_way.len() - NAMED);
            }
            grid.row([
                process.shard.clone(),
                format!("{} on {}", process.process, process.host),
                process.state.to_owned(),
                count(process.finished.into()),
                count(process.left.into()),
                under_way,
                format!("{} ago", roughly(process.heard_s)),
            ]);
        }
        grid
    }
}
