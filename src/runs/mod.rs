//! Runs into folders: a scenario, or the settings of a study and what compares them, from the first trial to finished results.
//!
//! [`run_scenario`] and [`run_study`] are one call each. Finished trials are kept: a run that was interrupted goes on where it stopped when
//! it is asked for again, to the same bytes as without interruption, and results that are there already are answered as they are. Results of
//! something else are never overwritten, unless [`Options::replace`] says so. Nothing is printed: whoever calls is told of each
//! [`Happening`].
//!
//! ```
//! use std::path::Path;
//!
//! use desim::runs::{Options, StudyRun, run_study};
//! use desim::scenario::{Override, load, plan_of_files, to_ron};
//!
//! let dir = tempfile::tempdir()?;
//! let mut files = Vec::new();
//! for (name, loss) in [("calm", 0.0), ("lossy", 0.5)] {
//!     let loss = format!("radio.loss=Bernoulli({loss:?})");
//!     let settings = [&format!("name=\"{name}\""), "trials=3", "time_limit=20.0", &loss];
//!     let settings: Result<Vec<Override>, _> = settings.map(str::parse).into_iter().collect();
//!     let path = dir.path().join(format!("{name}.ron"));
//!     std::fs::write(&path, to_ron(&load(Path::new("scenarios/heartbeat.ron"), &settings?)?))?;
//!     files.push(path);
//! }
//! let plan = plan_of_files(&files)?.with_figures(&["delivery_ratio".to_owned()])?;
//!
//! let out = dir.path().join("out");
//! let results = run_study(&StudyRun::of(&plan), &out, &Options::default(), |_| ())?;
//!
//! let settings = results.comparison.settings.iter();
//! let delivered: Vec<f64> =
//!     settings.filter_map(|setting| setting.figure("delivery_ratio")?.estimate.value).collect();
//! assert_eq!(delivered[0], 1.0);
//! assert!((delivered[1] - 0.5).abs() < 0.1);
//! assert!(out.join("lossy/summary.json").exists());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod asked;
mod error;
mod merge;
mod options;
mod processors;
mod runner;
mod scenario;
mod settings;
mod shards;
mod status;
mod study;
mod trials;

pub use asked::{ScenarioRun, StudyRun, Until};
pub use error::{Cause, Other, RunsError};
pub use merge::{Lack, Merge, MergeError, Merged, MissingTrials, merge};
pub use options::Options;
pub use runner::{FailedTrial, Health, Runner, UnderWay, now_s};
pub use scenario::{ScenarioResults, run_scenario};
pub use shards::{FinishedShard, run_scenario_shard, run_study_shard};
pub use status::status;
pub use study::{StudyResults, run_study};
pub use trials::Happening;
