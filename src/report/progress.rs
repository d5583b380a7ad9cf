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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::columns;

    fn underway() -> Progress {
        let process = |shard: &str, state, under_way: &[&str], heard_s| ProcessProgress {
            shard: shard.to_owned(),
            host: "node07.cluster.example.org".to_owned(),
            process: 31_337,
            state,
            finished: 1_200,
            left: 9,
            under_way: under_way.iter().map(|&trial| trial.to_owned()).collect(),
            heard_s,
        };
        Progress {
            name: "losses".to_owned(),
            trials: 20_000,
            done: 12_345,
            finished: false,
            settings: vec![SettingProgress {
                name: "some".to_owned(),
                trials: 20_000,
                done: 12_345,
            }],
            processes: vec![
                process(
                    "1/4",
                    "running",
                    &["1 of some", "5 of some", "9 of some", "13 of some"],
                    0.4,
                ),
                process("2/4", "silent", &[], 7300.0),
            ],
            failed: vec![FailedTrial {
                trial: "17 of some".to_owned(),
                shard: "2/4".to_owned(),
                reason: "a robot counted what nobody \u{1b}[31mknows".to_owned(),
            }],
            unattended: 1_234,
            unattended_shards: Some("2-4".to_owned()),
            left_s: Some(5400.0),
        }
    }

    #[test]
    fn who_does_what_what_failed_and_what_nobody_does_is_told_within_the_width() {
        for width in [40, 80, 120] {
            let text = underway().text(Style { colour: false, width });
            assert!(text.lines().all(|line| columns(line) <= width), "{width}:\n{text}");
            assert!(!text.contains('\u{1b}'));
        }
        let text = underway().text(Style {
            colour: false,
            width: 200,
        });
        for words in [
            "12,345 of 20,000 trials",
            "1 process, 4 trials under way",
            "trial 17 of some, of shard 2/4: a robot counted",
            "1,234 trials have nobody at work on them: --array=2-4 runs them",
            "about 90 minutes",
            "31337 on node07.cluster.example.org",
            "1 of some, 5 of some, 9 of some and 1 more",
            "0 s ago",
            "2 hours ago",
        ] {
            assert!(text.contains(words), "{words}:\n{text}");
        }
    }

    #[test]
    fn what_is_done_says_what_comes_next_and_what_is_finished_says_so() {
        let done = Progress {
            done: 20_000,
            unattended: 0,
            failed: Vec::new(),
            processes: Vec::new(),
            left_s: None,
            ..underway()
        };
        let text = |progress: &Progress| {
            progress.text(Style {
                colour: false,
                width: 80,
            })
        };
        assert!(text(&done).contains("nobody is at work") && text(&done).contains("desim merge"));
        let finished = Progress { finished: true, ..done };
        assert!(text(&finished).contains("the results have been written") && !text(&finished).contains("running"));
    }
}
