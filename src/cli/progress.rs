//! How far an experiment is, on a terminal.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::experiment::FinishedTrial;

/// Until a trial has finished, nobody knows how long they take.
const AT_FIRST: &str = "{wide_bar:.green/dim} {pos}/{len} trials, {elapsed} gone";
const LATER: &str = "{wide_bar:.green/dim} {pos}/{len} trials, {elapsed} gone, {eta} left, {msg} simulated s per s";

/// A bar on stderr, where that is a terminal; nothing elsewhere.
pub struct Progress {
    bar: ProgressBar,
    start: Instant,
    simulated_s: f64,
}

impl Progress {
    /// Starts at `finished` of `trials`.
    ///
    /// # Panics
    /// Never: the layouts are well formed.
    #[must_use]
    pub fn start(trials: u32, finished: u32, quiet: bool) -> Self {
        let target = if quiet {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        let bar = ProgressBar::with_draw_target(Some(trials.into()), target);
        bar.set_style(layout(AT_FIRST));
        bar.set_position(finished.into());
        bar.reset_eta();
        bar.enable_steady_tick(Duration::from_millis(200));
        Self {
            bar,
            start: Instant::now(),
            simulated_s: 0.0,
        }
    }

    /// Counts a trial.
    pub fn count(&mut self, part: &FinishedTrial) {
        self.count_lasting(part.record.simulated.as_secs());
    }

    /// Counts a trial of so many simulated seconds.
    pub fn count_lasting(&mut self, seconds: f64) {
        self.simulated_s += seconds;
        let rate = self.simulated_s / self.start.elapsed().as_secs_f64();
        self.bar.set_message(format!("{rate:.0}"));
        self.bar.set_style(layout(LATER));
        self.bar.inc(1);
    }
}

fn layout(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).expect("the layouts are well formed")
}

impl Drop for Progress {
    /// Leaves a clean line, however the experiment ended.
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
