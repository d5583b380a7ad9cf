//! What a run into a folder says on the way: that it goes on, how far it is, that there is nothing to do.

use std::num::NonZeroUsize;
use std::path::Path;

use tokio_util::sync::CancellationToken;

use super::failure::Failure;
use super::interrupt;
use super::output::say;
use super::progress::Progress;
use crate::runs::{Happening, Options};
use crate::simulation::DriverKind;
use crate::text::shown;

/// How trials are run, until Ctrl-C.
///
/// # Errors
/// If the system does not let signals be watched.
pub fn options(jobs: Option<NonZeroUsize>, driver: DriverKind, replace: bool) -> Result<Options, Failure> {
    let stop = CancellationToken::new();
    interrupt::cancels(&stop).map_err(|error| Failure::other(&error))?;
    Ok(Options {
        jobs,
        driver,
        replace,
        stop,
    })
}

/// Says what happens, unless it is to be quiet.
pub struct Teller<'a> {
    dir: &'a Path,
    is_quiet: bool,
    progress: Option<Progress>,
    /// Whether it is worth saying that trials go on of which none is missing.
    says_all: bool,
}

impl<'a> Teller<'a> {
    /// Of a run into `dir`.
    pub fn new(dir: &'a Path, is_quiet: bool) -> Self {
        Self {
            dir,
            is_quiet,
            progress: None,
            says_all: true,
        }
    }

    /// Of a study, whose trials may begin more than once.
    pub fn of_study(dir: &'a Path, is_quiet: bool) -> Self {
        Self {
            says_all: false,
            ..Self::new(dir, is_quiet)
        }
    }

    /// Says it.
    pub fn tell(&mut self, happening: Happening) {
        match happening {
            Happening::There => self.remark(&format!("{} holds these results already", shown(self.dir))),
            Happening::Begin { kept, trials } => {
                if kept > 0 && (self.says_all || kept < trials) {
                    self.remark(&format!("going on after {kept} of {trials} trials"));
                }
                self.progress = Some(Progress::start(trials, kept, self.is_quiet));
            }
            Happening::Trial(part) => {
                if let Some(progress) = &mut self.progress {
                    progress.count(part);
                }
            }
            Happening::End => self.progress = None,
        }
    }

    fn remark(&self, words: &str) {
        if !self.is_quiet {
            say(words);
        }
    }
}
