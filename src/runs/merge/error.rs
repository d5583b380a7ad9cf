//! Why shards cannot be put together.

use std::path::PathBuf;

use super::lack::Lack;
use crate::experiment::PartsError;
use crate::export::{FolderError, WriteError};
use crate::runs::RunsError;
use crate::text::shown;

/// Why there are no results.
#[derive(Debug, thiserror::Error)]
pub enum MergeError {
    /// A folder holds nothing to put together.
    #[error("{} holds no trials of desim: give a folder that `desim scenario --shard I/N` or `desim compare --shard I/N` has filled", shown(.0))]
    None(PathBuf),
    /// A folder holds results that are finished.
    #[error("{} holds finished results, whose trials are in its tables: there is nothing to put together", shown(.0))]
    Finished(PathBuf),
    /// Two folders hold what cannot be put together.
    #[error("{} and {} hold shards of different experiments:\n  {}", shown(&.folders[0]), shown(&.folders[1]), .differences.join("\n  "))]
    Apart {
        /// The folders.
        folders: [PathBuf; 2],
        /// The differences, a line each.
        differences: Vec<String>,
    },
    /// The shards are of another version or program than this, or cannot be read by it.
    #[error("the shards in {} are not this program's:\n  {}", shown(.dir), .differences.join("\n  "))]
    Foreign {
        /// The folder.
        dir: PathBuf,
        /// The differences, a line each.
        differences: Vec<String>,
    },
    /// Trials are missing.
    #[error("{0}")]
    Missing(Lack),
    /// The intervals of a study are wider than it asks for.
    #[error("{}", too_wide(figure, *width, *widest, *trials, *enough))]
    Wide {
        /// Key of the figure.
        figure: String,
        /// The width asked for.
        width: f64,
        /// The widest interval; `None` where a setting has none.
        widest: Option<f64>,
        /// Trials of a setting.
        trials: u32,
        /// How many would probably be enough.
        enough: u32,
    },
    /// The folder for the results is not free, or a file cannot be read or written.
    #[error(transparent)]
    Runs(#[from] RunsError),
}

fn too_wide(figure: &str, width: f64, widest: Option<f64>, trials: u32, enough: u32) -> String {
    let there = widest.map_or("no interval in some setting".to_owned(), |widest| {
        format!("{widest:.3} in the widest setting")
    });
    format!(
        "the interval of {figure} is to be {width} wide, and is {there} with {trials} trials: about {enough} trials of a setting would do, {} more.\n\
         Run every shard again with --trials {enough}; finished trials are kept.",
        enough - trials
    )
}

impl From<FolderError> for MergeError {
    fn from(error: FolderError) -> Self {
        Self::Runs(error.into())
    }
}

impl From<PartsError> for MergeError {
    fn from(error: PartsError) -> Self {
        Self::Runs(error.into())
    }
}

impl From<WriteError> for MergeError {
    fn from(error: WriteError) -> Self {
        Self::Runs(error.into())
    }
}
