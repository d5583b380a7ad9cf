//! The shards of a scenario or a study put together: a folder of results, byte for byte the one that a single machine would have left.

mod error;
mod lack;
mod plan;
mod scenario;
pub(super) mod sources;
mod study;

pub use error::MergeError;
pub(super) use lack::ranges;
pub use lack::{Lack, MissingTrials};

use std::path::{Path, PathBuf};

use sources::Shards;

use super::scenario::ScenarioResults;
use super::study::StudyResults;
use crate::export::Pictures;
use crate::scenario::Scenario;

/// What is to be put together, and how.
#[derive(Clone, Debug)]
pub struct Merge<'a> {
    /// The folders that shards have filled, at least one; they stay as they are, but for the one that the results go to.
    pub dirs: &'a [PathBuf],
    /// Where the results go, which may be one of them.
    pub out: &'a Path,
    /// Of which trials of a scenario there are pictures.
    pub pictures: Pictures,
    /// Whether results of something else that are there are deleted first.
    pub replace: bool,
}

/// What has been put together.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant)] // There is one a command.
pub enum Merged {
    /// The trials of a scenario.
    Scenario {
        /// The scenario.
        scenario: Scenario,
        /// Its results.
        results: ScenarioResults,
        /// Whether they were there already.
        were_there: bool,
    },
    /// The settings of a study.
    Study {
        /// Its results.
        results: StudyResults,
        /// Whether they were there already.
        were_there: bool,
    },
}

/// Puts shards together.
///
/// # Errors
/// If they are not of one scenario or study, and of this version; if trials are missing; if trials of one number differ; if the width until which
/// a study's trials are to be added is not reached; if the folder for the results holds something else; or if the file system refuses.
///
/// # Panics
/// If there is no folder.
pub fn merge(merge: &Merge) -> Result<Merged, MergeError> {
    match sources::shards(merge.dirs)? {
        Shards::Scenario(shards) => scenario::merge(merge, &shards),
        Shards::Study(shards) => study::merge(merge, &shards),
    }
}
