//! Names of the files in a results folder, but for the tables.

/// What a folder is the result of.
pub const MANIFEST: &str = "manifest.json";
/// The summary's file.
pub const SUMMARY: &str = "summary.json";
/// The page of charts. It follows from the other files and may be missing.
pub const PAGE: &str = "report.html";
/// The page on which trial 0 is watched.
pub const REPLAY: &str = "replay.html";
/// Pictures of a trial, before its number.
pub const PICTURES: [&str; 2] = ["final", "trajectories"];
