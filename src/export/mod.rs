//! What an experiment leaves on disk: tables, pictures, the summary, the manifest. Reads records only.
//!
//! [`write()`] fills a [`Folder`]; the folder's [`Manifest`] says what it is the result of. Every file but the manifest
//! depends on the scenario, the seed and the version alone, byte for byte.

#[cfg(feature = "parquet")]
mod comparison_table;
mod files;
mod folder;
mod held;
mod manifest;
mod names;
#[cfg_attr(not(feature = "command"), path = "no_picture.rs")]
mod picture;
mod place;
#[cfg_attr(not(feature = "parquet"), path = "no_read.rs")]
mod read;
mod results;
mod scene;
mod study;
#[cfg(feature = "parquet")]
mod table;
#[cfg_attr(not(feature = "parquet"), path = "no_tables.rs")]
mod tables;
#[cfg(feature = "command")]
pub mod trace;
mod write;

pub use files::{PAGE, REPLAY, replay_page};
pub use folder::{Contents, Folder};
pub use held::{FileEntry, sealed};
pub use manifest::{Difference, Manifest, TrialEntry, program};
pub use names::Names;
pub use place::{FolderError, WriteError, json};
pub use read::NameLists;
pub use results::{Results, ResultsError};
pub use scene::Scene;
pub use study::{StudyFolder, StudyManifest};
pub use tables::Tables;
pub use write::{Pictures, write};
