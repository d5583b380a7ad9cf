//! `desim replay`: runs one finished trial again and makes a page on which it can be watched.

use std::path::PathBuf;

use clap::Args;

use super::failure::Failure;
use super::finished_trial::FinishedTrial;
use super::page_file;
use crate::experiment::{reach, watch_trial};
use crate::export::replay_page;
use crate::report::{Film, ReplayInput, replay};
use crate::text::shown;

/// What `desim replay --help` says.
pub const LONG_ABOUT: &str = "\
Makes a page on which a finished trial can be watched: one file that needs no network. Robots move, take their roles, say what \
they say and fail; messages fly and are lost; a list of events leads to every failure and suspicion, and to what a suspicion was \
due to. Play, step, scrub, follow a robot; ? on the page names the keys.

Nothing of this is stored. A run is the same every time, so the trial is run again, and its digest shows that it is the \
same run. Of long runs and large swarms places and messages are thinned out until they fit a page, which says so.";

/// Arguments of `desim replay`.
#[derive(Debug, Args)]
pub struct ReplayArguments {
    /// Folder of finished results
    pub dir: PathBuf,
    /// Number of the trial, from 0
    #[arg(long, value_name = "K", default_value_t = 0)]
    pub trial: u32,
    /// Where to write the page [default: replay.html in DIR, of another trial than 0 replay-K.html]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

/// Makes the page.
///
/// # Errors
/// If there is no such trial, it cannot be run again, or the page cannot be written.
pub fn run(arguments: &ReplayArguments) -> Result<(), Failure> {
    let finished = FinishedTrial::of(&arguments.dir, arguments.trial)?;
    let scenario = &finished.scenario;
    let watch = |stop: &_| watch_trial(scenario, arguments.trial, Film::of(scenario), stop);
    let (record, film) = finished.again("show", watch)?;
    let input = ReplayInput {
        scenario,
        question: finished.manifest.question.as_deref(),
        record: &record,
        reach: &reach(scenario, arguments.trial),
        folder: &shown(&finished.dir),
    };
    let page = replay(&input, film);
    let name = replay_page(arguments.trial);
    let file = arguments.out.clone().unwrap_or_else(|| finished.dir.join(&name));
    page_file::write(&file, &page, &name, "shows the trial").map(|_| ())
}
