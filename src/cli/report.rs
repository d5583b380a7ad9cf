//! `desim report`: the report of finished results, on the terminal and as a page of charts.

use std::path::{Path, PathBuf};

use clap::Args;

use super::failure::Failure;
use super::output::say;
use super::page_file::{self, Place};
use super::shown::{Finished, Format, print_comparison};
use crate::export::{Folder, Manifest, PAGE, Results, StudyFolder, StudyManifest, WriteError};
use crate::metrics::comparison::Comparison;
use crate::report::{PageInput, PageTrials, SettingTrials, Watch, page, study_page};
use crate::text::shown;

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
    /// Where to write the page of charts, /dev/stdout instead of the report [default: report.html in DIR; for several folders none is
    /// written]
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
    let Some(files) = write_page(&results, arguments)? else {
        return Ok(());
    };
    let manifests = || results.sources.iter().map(|(_, manifest)| manifest);
    let folders: Vec<_> = results.sources.iter().map(|(dir, _)| shown(dir)).collect();
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
            shown(dir)
        )));
    }
    Ok(Some(StudyFolder::new(dir.clone())))
}

fn report_study(folder: &StudyFolder, arguments: &ReportArguments) -> Result<(), Failure> {
    let unfinished = || {
        Failure::Input(format!(
            "error: the study in {} is not finished: go on with it by `desim compare`, or put its shards together by `desim merge`",
            shown(folder.path())
        ))
    };
    let manifest = folder
        .contents()?
        .filter(|manifest| manifest.finished)
        .ok_or_else(unfinished)?;
    let comparison = folder.finished(&manifest)?;
    let trials = trials(folder, &manifest, &comparison, arguments.out.is_none())?;
    let html = study_page(&comparison, &manifest.made_by(), &trials);
    let place = match &arguments.out {
        Some(file) => page_file::write(file, &html, PAGE, "has the charts")?,
        None => kept(
            folder.path(),
            folder.keep_page(&manifest, &html).map_err(WriteError::from),
        )?,
    };
    if place == Place::Output {
        return Ok(());
    }
    print_comparison(&comparison, folder, arguments.format)
}

/// The trials of each setting; with links to the pages that show them where the page of charts stays `beside` them.
fn trials(
    folder: &StudyFolder,
    manifest: &StudyManifest,
    comparison: &Comparison,
    beside: bool,
) -> Result<Vec<SettingTrials>, Failure> {
    let mut told = folder.told(manifest, &comparison.primary)?;
    let of = |name: &String| {
        let setting = folder.setting(name);
        SettingTrials {
            setting: name.clone(),
            told: told.remove(name).unwrap_or_default(),
            watch: watch(&setting, &format!("{name}/"), beside),
        }
    };
    Ok(manifest.settings.iter().map(of).collect())
}

/// Where the trials in a folder can be watched, the links to their pages beginning with `path`.
fn watch(folder: &Folder, path: &str, beside: bool) -> Watch {
    let replays = if beside { folder.replays() } else { Vec::new() };
    let link = |(trial, name): (u32, String)| (trial, format!("{path}{name}"));
    Watch {
        folder: shown(folder.path()),
        replays: replays.into_iter().map(link).collect(),
    }
}

/// Says where the page is, or why it is not in `dir`: results may lie where nobody writes.
fn kept<T>(dir: &Path, page: Result<T, WriteError>) -> Result<Place, Failure> {
    match page {
        Ok(_) => say(&format!("{} has the charts", shown(&dir.join(PAGE)))),
        Err(error) if error.is_refused() => {
            say(&format!(
                "no page of charts here: {error}\nsay where it is to be: --out FILE"
            ));
        }
        Err(error) => return Err(error.into()),
    }
    Ok(Place::File)
}

fn question(results: &Results) -> Option<String> {
    results
        .sources
        .iter()
        .find_map(|(_, manifest)| manifest.question.clone())
}

/// Writes the page where it belongs and answers the names of the files in the folder, if it is one; nothing if the page has gone
/// to standard output, where no report may follow it.
fn write_page(results: &Results, arguments: &ReportArguments) -> Result<Option<Vec<String>>, Failure> {
    let (dir, manifest) = &results.sources[0];
    let folder = Folder::new(dir.clone());
    // Trials of several folders have the same numbers.
    let watch = (results.sources.len() == 1).then(|| watch(&folder, "", arguments.out.is_none()));
    let html = || -> Result<String, Failure> {
        let mut trials = PageTrials::new(&results.scenario);
        for record in results.records() {
            trials.add(record?);
        }
        Ok(page(&PageInput {
            question: question(results).as_deref(),
            scenario: &results.scenario,
            topics: &results.names.topics,
            roles: &results.names.roles,
            trials: &trials,
            summary: &results.summary,
            made_by: &manifest.made_by(),
            watch: watch.clone(),
        }))
    };
    let names = |manifest: &Manifest| manifest.files.keys().cloned().collect();
    match (&arguments.out, results.sources.len()) {
        (Some(file), many) => {
            let files = if many == 1 { names(manifest) } else { Vec::new() };
            Ok((page_file::write(file, &html()?, PAGE, "has the charts")? == Place::File).then_some(files))
        }
        (None, 1) => {
            let kept_page = folder.keep_page(manifest, &html()?);
            let files = names(kept_page.as_ref().unwrap_or(manifest));
            kept(dir, kept_page)?;
            Ok(Some(files))
        }
        (None, _) => {
            say("to have the charts of these results together, say where: --out FILE");
            Ok(Some(Vec::new()))
        }
    }
}
