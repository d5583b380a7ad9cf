//! Runs into folders: a scenario, or the settings of a study and what compares them, from the first trial to finished results.
//!
//! [`run_scenario`] and [`run_study`] are one call each. Finished trials are kept: a run that was interrupted goes on where it stopped when
//! it is asked for again, to the same bytes as without interruption, and results that are there already are answered as they are. Results of
//! something else are never overwritten, unless [`Options::replace`] says so. Nothing is printed: whoever calls is told of each
//! [`Happening`].
//!
//! ```
//! use desim::runs::{Options, StudyRun, run_study};
//! use desim::scenario::plan_of_files;
//!
//! let dir = tempfile::tempdir()?;
//! let files = [("calm", 0.0), ("lossy", 0.5)].map(|(name, loss)| {
//!     let text = format!(
//!         "Scenario(name: \"{name}\", trials: 3, time_limit: 20.0, swarm: (robots: 4, deploy: Uniform), protocol: Heartbeat,
//!          detector: Timeout(5.0), arena: (size: (1.0, 1.0)), radio: (range: 2.0, loss: Bernoulli({loss})))"
//!     );
//!     (dir.path().join(format!("{name}.ron")), text)
//! });
//! for (path, text) in &files {
//!     std::fs::write(path, text)?;
//! }
//! let plan = plan_of_files(&files.each_ref().map(|(path, _)| path))?.with_figures(&["delivery_ratio".to_owned()])?;
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
mod options;
mod scenario;
mod settings;
mod study;
mod trials;

pub use asked::{ScenarioRun, StudyRun, Until};
pub use error::{Cause, Other, RunsError};
pub use options::Options;
pub use scenario::{ScenarioResults, run_scenario};
pub use study::{StudyResults, run_study};
pub use trials::Happening;
