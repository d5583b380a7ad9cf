//! `desim report`: the report of finished results, on the terminal and as a page of charts.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use clap::Args;

use super::failure::Failure;
use super::shown::{Finished, Format, print_comparison};
use crate::experiment::Parts;
use crate::export::{Folder, PAGE, Results, StudyFolder, keep_page};
use crate::report::{PAGE_MARK, PageInput, page, study_page};

/// What `desim report --help` says.
pub const LONG_ABOUT: &str = "\
Reports finished results again, from the files in their folder alone: on the terminal as `desim scenario` does, and as \
report.html in the folder, one page that needs no network, with charts that answer to the pointer, the data of each as a table \
and as CSV, fit for a phone and for paper.

Every file is first held against the manifest. Several folders give one report of all their trials together; they must be of \
one scenario and one version and may differ in seed and number of trials alone.

The folder of a study, as `desim compare` leaves it, gives the report of the comparison, and a page with every figure by setting, \
the differences with their intervals, and the Pareto front. Its settings can be reported by their own folders.";

/// Arguments of `desim report`.
#[derive(Debug, Args)]
pub struct ReportArguments {
    /// Folders of finished results
    #[arg(required = true, value_name = "DIR")]
    pub dirs: Vec<PathBuf>,
    /// Where to write the page of charts [default: report.html in DIR; for several folders none is written]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// What to print on standard output
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// Reports.
///
/// # Errors
/// If the folders do not hold results that can be reported together, or the page cannot be written.
pub fn run(arguments: &ReportArguments) -> Result<(), Failure> {
    if let Some(study) = study(&arguments.dirs)? {
        return report_study(&study, arguments);
    }
    let results = Results::pooled(&arguments.dirs)?;
    let files = write_page(&results, arguments)?;
    let manifests = || results.sources.iter().map(|(_, manifest)| manifest);
    let folders: Vec<_> = results
        .sources
        .iter()
        .map(|(dir, _)| dir.display().to_string())
        .collect();
    let trials: Vec<_> = manifests().flat_map(|manifest| manifest.trials.clone()).collect();
    let finished = Finished {
        question: question(&results),
        scenario: &results.scenario,
        folders: folders.join(", ").into(),
        summary: &results.summary,
        trials: &trials,
        files: files.iter().map(String::as_str).collect(),
    };
    finished.print(arguments.format)
}

/// The folder of a study, if one is asked about.
fn study(dirs: &[PathBuf]) -> Result<Option<StudyFolder>, Failure> {
    let Some(dir) = dirs.iter().find(|dir| StudyFolder::is_at(dir)) else {
        return Ok(None);
    };
    if dirs.len() > 1 {
        return Err(Failure::Input(format!(
            "error: {} holds a study, which is reported alone: give its folder only, or the folders of settings",
            dir.display()
        )));
    }
    Ok(Some(StudyFolder::new(dir.clone())))
}

fn report_study(folder: &StudyFolder, arguments: &ReportArguments) -> Result<(), Failure> {
    let unfinished = || {
        Failure::Input(format!(
            "error: the study in {} is not finished: go on with it by `desim compare`",
            folder.path().display()
        ))
    };
    let manifest = folder
        .contents()?
        .filter(|manifest| manifest.finished)
        .ok_or_else(unfinished)?;
    let comparison = folder.comparison()?.ok_or_else(unfinished)?;
    let html = study_page(&comparison, &manifest.made_by());
    match &arguments.out {
        Some(file) => write(file, &html)?,
        None => {
            folder.keep_page(&html)?;
            eprintln!("{} has the charts", folder.path().join(PAGE).display());
        }
    }
    print_comparison(&comparison, folder, arguments.format)
}

fn question(results: &Results) -> Option<String> {
    results
        .sources
        .iter()
        .find_map(|(_, manifest)| manifest.question.clone())
}

/// Writes the page where it belongs and answers the names of the files in the folder, if it is one.
fn write_page(results: &Results, arguments: &ReportArguments) -> Result<Vec<String>, Failure> {
    let (dir, manifest) = &results.sources[0];
    let html = || {
        page(&PageInput {
            question: question(results).as_deref(),
            scenario: &results.scenario,
            topics: &results.names.topics,
            roles: &results.names.roles,
            records: &results.records,
            summary: &results.summary,
            made_by: &manifest.made_by(),
        })
    };
    let names = |files: &crate::export::Manifest| files.files.keys().cloned().collect();
    match (&arguments.out, results.sources.len()) {
        (Some(file), many) => {
            write(file, &html())?;
            Ok(if many == 1 { names(manifest) } else { Vec::new() })
        }
        (None, 1) => {
            let folder = Folder::new(dir.clone());
            // Opening the trials makes sure that nobody else is at work here.
            let parts = Parts::open(&folder.trials())?;
            let manifest = keep_page(&folder, manifest, &html())?;
            drop(parts);
            eprintln!("{} has the charts", dir.join(PAGE).display());
            Ok(names(&manifest))
        }
        (None, _) => {
            eprintln!("to have the charts of these results together, say where: --out FILE");
            Ok(Vec::new())
        }
    }
}

/// Writes a page to a place of the user's, over nothing but another page.
fn write(file: &Path, html: &str) -> Result<(), Failure> {
    match fs::read(file) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {}
        Ok(there) if String::from_utf8_lossy(&there[..there.len().min(1024)]).contains(PAGE_MARK) => {}
        Ok(_) => {
            let shown = file.display();
            return Err(Failure::Input(format!(
                "error: {shown} is no report of desim: choose another file with --out"
            )));
        }
        Err(error) if error.kind() == io::ErrorKind::IsADirectory => {
            let inside = file.join(PAGE);
            return Err(Failure::Input(format!(
                "error: {} is a folder: give a file, such as --out {}",
                file.display(),
                inside.display()
            )));
        }
        Err(error) => {
            return Err(Failure::Other(format!(
                "error: cannot read {}: {error}",
                file.display()
            )));
        }
    }
    fs::write(file, html)
        .map_err(|error| Failure::Other(format!("error: cannot write {}: {error}", file.display())))?;
    eprintln!("{} has the charts", file.display());
    Ok(())
}
