//! `desim check`: says everything that is wrong with scenario and study files before they are run.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::output::{self, columns, style};
use crate::export;
use crate::predict::Preflight;
use crate::report;
use crate::scenario::{
    Diagnostic, Override, Plan, Report, Scenario, contents, is_study, load_study, parse, question, to_ron,
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

/// Checks each of `files` with `overrides` worked in, and writes to `out`, standard output: for every file its faults,
/// or what to `say` of one that is well. Answers whether all are well.
///
/// # Errors
/// If `out` cannot be written to.
pub fn check(files: &[PathBuf], overrides: &[String], say: Say, out: &mut dyn Write) -> io::Result<bool> {
    let parsed = match all(overrides) {
        Ok(parsed) => parsed,
        Err(report) => {
            write_faults(&report, say, out)?;
            return Ok(false);
        }
    };
    let mut well = true;
    let mut accepted = Vec::new();
    for file in files {
        match read(file, &parsed) {
            Ok(checked) => accepted.push(checked),
            Err(report) => {
                well = false;
                write_faults(&report, say, out)?;
            }
        }
    }
    let scenarios = || accepted.iter().flat_map(|checked| &checked.scenarios);
    match say {
        Say::Well => {
            for checked in &accepted {
                write!(out, "{}", report::message(&checked.line, columns(&io::stdout())))?;
            }
        }
        Say::Resolved => {
            for (question, scenario) in scenarios() {
                write_resolved(question.as_deref(), scenario, out)?;
            }
        }
        Say::Expected => {
            let style = style(&io::stdout());
            for (index, (question, scenario)) in scenarios().enumerate() {
                let apart = if index > 0 { "\n" } else { "" };
                let text = report::preflight(&Preflight::of(scenario), question.as_deref(), style);
                write!(out, "{apart}{text}")?;
            }
        }
        Say::ExpectedJson if well => {
            let expected: Vec<Preflight> = scenarios().map(|(_, scenario)| Preflight::of(scenario)).collect();
            out.write_all(&export::json(&expected))?;
        }
        Say::ExpectedJson => {}
    }
    Ok(well)
}

fn write_faults(faults: &Report, say: Say, out: &mut dyn Write) -> io::Result<()> {
    if say == Say::ExpectedJson {
        return write!(output::stderr(), "{}", faults.render(style(&io::stderr())));
    }
    write!(out, "{}", faults.render(style(&io::stdout())))
}

/// Every override.
///
/// # Errors
/// What is wrong with each that is none.
pub fn all(overrides: &[String]) -> Result<Vec<Override>, Report> {
    let mut parsed = Vec::new();
    let mut diagnostics: Vec<Diagnostic> = Vec::new();
    for text in overrides {
        match text.parse() {
            Ok(given) => parsed.push(given),
            Err(Report { diagnostics: found }) => diagnostics.extend(found),
        }
    }
    if diagnostics.is_empty() {
        Ok(parsed)
    } else {
        Err(Report { diagnostics })
    }
}

/// A file that is well.
struct Checked {
    /// What to say of it in a line.
    line: String,
    /// Its scenario, or those of a study's settings, each with the question that it answers.
    scenarios: Vec<(Option<String>, Scenario)>,
}

fn read(file: &Path, overrides: &[Override]) -> Result<Checked, Report> {
    let text = contents(file)?;
    if is_study(&text) {
        return read_study(file, overrides);
    }
    let scenario = parse(&file.display().to_string(), &text, overrides)?;
    let counted = |count: u32, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
    let (trials, robots) = (
        counted(scenario.trials, "trial"),
        counted(scenario.swarm.robots, "robot"),
    );
    Ok(Checked {
        line: format!("ok {}: {}, {trials}, {robots}", shown(file), scenario.name),
        scenarios: vec![(question(&text), scenario)],
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
    let Plan {
        name,
        question,
        settings,
        ..
    } = load_study(file)?;
    let trials: u64 = settings.iter().map(|setting| u64::from(setting.scenario.trials)).sum();
    Ok(Checked {
        line: format!(
            "ok {}: {name}, a study of {} settings, {trials} trials",
            shown(file),
            settings.len()
        ),
        scenarios: settings
            .into_iter()
            .map(|setting| (question.clone(), setting.scenario))
            .collect(),
    })
}

fn write_resolved(question: Option<&str>, scenario: &Scenario, out: &mut dyn Write) -> io::Result<()> {
    if let Some(question) = question {
        writeln!(out, "// {}", clean(question))?;
    }
    write!(out, "{}", to_ron(scenario))
}
