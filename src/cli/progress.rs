//! How far an experiment is, on a terminal.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::experiment::FinishedTrial;

const LAYOUT: &str = "{bar:24.green/dim} {pos}/{len} trials, {msg}{elapsed} gone, {eta} left";

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
    /// Never: the layout is one that indicatif reads.
    #[must_use]
    pub fn start(trials: u32, finished: u32, quiet: bool) -> Self {
        let target = if quiet {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        let bar = ProgressBar::with_draw_target(Some(trials.into()), target);
        bar.set_style(ProgressStyle::with_template(LAYOUT).expect("the layout is well formed"));
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
        self.simulated_s += part.record.simulated.as_secs();
        let rate = self.simulated_s / self.start.elapsed().as_secs_f64();
        self.bar.set_message(format!("{rate:.0} simulated s per s, "));
        self.bar.inc(1);
    }
}

impl Drop for Progress {
    /// Leaves a clean line, however the experiment ended.
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
