//! `desim check`: says everything that is wrong with scenario and study files before they are run.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use serde::Serialize;

use super::failure::Failure;
use super::output::{self, columns, style};
use crate::export;
use crate::predict::Preflight;
use crate::report;
use crate::scenario::{
    Diagnostic, Override, Place, Report, Scenario, Style, Warnings, contents, examine, is_study, load_study, question,
    to_ron,
};
use crate::text::{clean, shown};

/// What to say of a scenario that is well.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Say {
    /// A line that it is.
    Well,
    /// The whole scenario, with its defaults.
    Resolved,
    /// What closed forms expect of it.
    Expected,
    /// The same of all files as one JSON document, a list, and nothing else; faults go to standard error.
    ExpectedJson,
}

/// What is refused beside what is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Deny {
    /// What looks wrong, too
    Warnings,
}

/// Checks each of `files` with `overrides` worked in, and writes to `out`, standard output: for every file its faults or
/// its warnings, and what to `say` of one that is well: of one without warnings, if these are denied. Answers whether all
/// are well.
///
/// # Errors
/// If `out` cannot be written to.
pub fn check(
    files: &[PathBuf],
    overrides: &[String],
    say: Say,
    deny: Option<Deny>,
    out: &mut dyn Write,
) -> io::Result<bool> {
    let parsed = match all(overrides) {
        Ok(parsed) => parsed,
        Err(report) => {
            write_apart(say, out, |style| report.render(style))?;
            return Ok(false);
        }
    };
    let mut well = true;
    let mut accepted = Vec::new();
    let mut denied = 0;
    for file in files {
        match read(file, &parsed) {
            Ok(checked) => {
                let warnings = &checked.warnings;
                write_apart(say, out, |style| warnings.render(style))?;
                if deny.is_some() && !warnings.is_empty() {
                    denied += warnings.count();
                } else {
                    accepted.push(checked);
                }
            }
            Err(report) => {
                well = false;
                write_apart(say, out, |style| report.render(style))?;
            }
        }
    }
    if denied > 0 {
        well = false;
        write_apart(say, out, |_| format!("{}\n", refusal(denied)))?;
    }
    let scenarios = || accepted.iter().flat_map(|checked| &checked.scenarios);
    match say {
        Say::Well => {
            for checked in &accepted {
                write!(out, "{}", report::message(&checked.line, columns(&io::stdout())))?;
            }
        }
        Say::Resolved => {
            for Examined { question, scenario, .. } in scenarios() {
                write_resolved(question.as_deref(), scenario, out)?;
            }
        }
        Say::Expected => {
            let style = style(&io::stdout());
            for (index, Examined { question, scenario, .. }) in scenarios().enumerate() {
                let apart = if index > 0 { "\n" } else { "" };
                let text = report::preflight(&Preflight::of(scenario), question.as_deref(), style);
                write!(out, "{apart}{text}")?;
            }
        }
        Say::ExpectedJson if well => {
            let expected: Vec<Expected> = scenarios().map(Expected::of).collect();
            out.write_all(&export::json(&expected))?;
        }
        Say::ExpectedJson => {}
    }
    Ok(well)
}

/// Writes what is wrong, or looks so, beside what is said of files that are well: apart from it, on standard error, where
/// that is read by a program.
fn write_apart(say: Say, out: &mut dyn Write, render: impl FnOnce(Style) -> String) -> io::Result<()> {
    match say {
        Say::Well | Say::Expected => write!(out, "{}", render(style(&io::stdout()))),
        Say::Resolved | Say::ExpectedJson => {
            write!(output::stderr(), "{}", render(style(&io::stderr())))
        }
    }
}

/// Says on standard error what looks wrong.
///
/// # Errors
/// If there is anything, and it is denied.
pub fn heed(warnings: &Warnings, deny: Option<Deny>) -> Result<(), Failure> {
    // Where nobody reads them, warnings are no reason to stop.
    let _ = write!(output::stderr(), "{}", warnings.render(style(&io::stderr())));
    match deny {
        Some(Deny::Warnings) if !warnings.is_empty() => Err(Failure::Input(refusal(warnings.count()))),
        _ => Ok(()),
    }
}

fn refusal(warnings: usize) -> String {
    let counted = if warnings == 1 {
        "1 warning"
    } else {
        &format!("{warnings} warnings")
    };
    format!("error: {counted}, and warnings are denied")
}

/// What is expected of a scenario, for programs.
#[derive(Serialize)]
struct Expected<'a> {
    #[serde(flatten)]
    preflight: Preflight,
    /// What looks wrong with it.
    warnings: Vec<Warning<'a>>,
}

/// A warning, for programs.
#[derive(Serialize)]
struct Warning<'a> {
    message: &'a str,
    help: Option<&'a str>,
    path: Option<&'a str>,
    file: Option<&'a str>,
    line: Option<usize>,
    column: Option<usize>,
}

impl<'a> Expected<'a> {
    fn of(examined: &'a Examined) -> Self {
        Self {
            preflight: Preflight::of(&examined.scenario),
            warnings: examined.warnings.iter().map(Warning::of).collect(),
        }
    }
}

impl<'a> Warning<'a> {
    fn of(diagnostic: &'a Diagnostic) -> Self {
        let place: Option<&Place> = diagnostic.place.as_ref();
        Self {
            message: &diagnostic.message,
            help: diagnostic.help.as_deref(),
            path: diagnostic.path.as_deref(),
            file: place.map(|place| place.name.as_str()),
            line: place.map(|place| place.line),
            column: place.map(|place| place.column),
        }
    }
}

/// Every override.
///
/// # Errors
/// What is wrong with each that is none.
pub fn all(overrides: &[String]) -> Result<Vec<Override>, Report> {
    let mut parsed = Vec::new();
    let mut diagnostics: Vec<Diagnostic> = Vec::new();
    for text in overrides {
        match text.parse::<Override>() {
            Ok(given) => parsed.push(given),
            Err(report) => diagnostics.extend(report.diagnostics),
        }
    }
    if diagnostics.is_empty() {
        Ok(parsed)
    } else {
        Err(Report::from(diagnostics))
    }
}

/// A file that is well.
struct Checked {
    /// What to say of it in a line.
    line: String,
    /// Its scenario, or those of a study's settings.
    scenarios: Vec<Examined>,
    /// What looks wrong with it, each thing once.
    warnings: Warnings,
}

/// A scenario that holds.
struct Examined {
    /// The question that it answers.
    question: Option<String>,
    scenario: Scenario,
    /// What looks wrong with it, or with its study.
    warnings: Vec<Diagnostic>,
}

fn read(file: &Path, overrides: &[Override]) -> Result<Checked, Report> {
    let text = contents(file)?;
    if is_study(&text) {
        return read_study(file, overrides);
    }
    let (scenario, warnings) = examine(&file.display().to_string(), &text, overrides)?;
    let counted = |count: u32, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
    let (trials, robots) = (
        counted(scenario.trials, "trial"),
        counted(scenario.swarm.robots, "robot"),
    );
    Ok(Checked {
        line: format!("ok {}: {}, {trials}, {robots}", shown(file), scenario.name),
        scenarios: vec![Examined {
            question: question(&text),
            scenario,
            warnings: warnings.diagnostics.clone(),
        }],
        warnings,
    })
}

fn read_study(file: &Path, overrides: &[Override]) -> Result<Checked, Report> {
    if let Some(given) = overrides.first() {
        return Err(Report::from(Diagnostic {
            message: format!(
                "{}{} is a study, whose fields are not set from outside",
                given.prefix(),
                shown(file)
            ),
            help: Some("check it without --set".to_owned()),
            path: None,
            place: None,
        }));
    }
    let plan = load_study(file)?;
    let trials = plan.settings.iter().map(|setting| u64::from(setting.scenario.trials));
    let warnings = plan.all_warnings();
    let scenarios = plan.settings.iter().map(|setting| Examined {
        question: plan.question.clone(),
        scenario: setting.scenario.clone(),
        warnings: [&plan.warnings, &setting.warnings]
            .into_iter()
            .flat_map(|warnings| warnings.diagnostics.iter().cloned())
            .collect(),
    });
    Ok(Checked {
        line: format!(
            "ok {}: {}, a study of {} settings, {} trials",
            shown(file),
            plan.name,
            plan.settings.len(),
            trials.sum::<u64>()
        ),
        scenarios: scenarios.collect(),
        warnings,
    })
}

fn write_resolved(question: Option<&str>, scenario: &Scenario, out: &mut dyn Write) -> io::Result<()> {
    if let Some(question) = question {
        writeln!(out, "// {}", clean(question))?;
    }
    write!(out, "{}", to_ron(scenario))
}
