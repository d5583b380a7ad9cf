//! Finished results on standard output.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::ValueEnum;

use super::failure::Failure;
use super::output;
use crate::export::{self, StudyFolder, TrialEntry};
use crate::metrics::Summary;
use crate::metrics::comparison::Comparison;
use crate::predict;
use crate::protocol::detector::DetectorConfig;
use crate::report::{self, Speed};
use crate::scenario::Scenario;

/// What is printed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A report for people
    #[default]
    Text,
    /// The same figures as one JSON document, and nothing else
    Json,
}

/// Finished results, to be shown.
#[derive(Debug)]
pub struct Finished<'a> {
    /// The question that they answer.
    pub question: Option<String>,
    /// The scenario that they are of.
    pub scenario: &'a Scenario,
    /// Where they are.
    pub folders: PathBuf,
    /// Their figures.
    pub summary: &'a Summary,
    /// What the trials took.
    pub trials: &'a [TrialEntry],
    /// Names of the files.
    pub files: Vec<&'a str>,
}

impl Finished<'_> {
    /// Prints them.
    ///
    /// # Errors
    /// If standard output cannot be written to.
    pub fn print(&self, format: Format) -> Result<(), Failure> {
        let mut out = output::stdout();
        match format {
            Format::Json => out.write_all(&export::json(self.summary))?,
            Format::Text => out.write_all(self.text().as_bytes())?,
        }
        Ok(out.flush()?)
    }

    fn text(&self) -> String {
        let trials = self.trials;
        report::terminal(&report::Input {
            question: self.question.as_deref(),
            summary: self.summary,
            asked: report::Asked::of(self.scenario).as_ref(),
            control_period_s: self.scenario.control.period.get(),
            detects: self.scenario.detector != DetectorConfig::None,
            surprises: &predict::surprises(self.scenario, self.summary),
            speed: Speed {
                simulated_s: trials.iter().map(|trial| trial.simulated_s).sum(),
                delivered: trials.iter().map(|trial| trial.delivered).sum(),
                wall_s: trials.iter().map(|trial| trial.wall_s).sum(),
            },
            folder: &self.folders,
            files: &self.files,
            style: output::style(&io::stdout()),
        })
    }
}

/// Prints what compares the settings of a study in `folder`.
///
/// # Errors
/// If standard output cannot be written to.
pub fn print_comparison(comparison: &Comparison, folder: &StudyFolder, format: Format) -> Result<(), Failure> {
    let mut out = output::stdout();
    match format {
        Format::Json => out.write_all(&export::json(comparison))?,
        Format::Text => {
            let text = report::comparison(&report::ComparisonInput {
                comparison,
                folder: folder.path(),
                files: &folder.files(),
                style: output::style(&io::stdout()),
            });
            out.write_all(text.as_bytes())?;
        }
    }
    Ok(out.flush()?)
}
