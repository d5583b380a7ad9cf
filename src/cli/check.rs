//! `desim check`: says everything that is wrong with scenario and study files before they are run.

use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

use crate::scenario::{
    Diagnostic, Override, Plan, Report, Scenario, Style, contents, is_study, load_study, parse, question, to_ron,
};

/// Checks each of `files` with `overrides` worked in, and writes to `out`, standard output: for every file its faults,
/// or a line that it is well; where `resolved` is asked for, the whole scenario with its defaults instead of that line.
/// Answers whether all are well.
///
/// # Errors
/// If `out` cannot be written to.
pub fn check(files: &[PathBuf], overrides: &[String], resolved: bool, out: &mut dyn Write) -> io::Result<bool> {
    let parsed = match all(overrides) {
        Ok(parsed) => parsed,
        Err(report) => {
            write!(out, "{}", report.render(style(&io::stdout())))?;
            return Ok(false);
        }
    };
    let mut well = true;
    let mut accepted = Vec::new();
    for file in files {
        match read(file, &parsed) {
            Ok(checked) => accepted.push((file, checked)),
            Err(report) => {
                well = false;
                write!(out, "{}", report.render(style(&io::stdout())))?;
            }
        }
    }
    for (file, checked) in accepted {
        match checked {
            Checked::Scenario(text, scenario) if resolved => write_resolved(question(&text), &scenario, out)?,
            Checked::Scenario(_, scenario) => write_line(file, &scenario, out)?,
            Checked::Study(plan) if resolved => {
                for setting in &plan.settings {
                    write_resolved(plan.question.clone(), &setting.scenario, out)?;
                }
            }
            Checked::Study(plan) => write_study(file, &plan, out)?,
        }
    }
    Ok(well)
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
enum Checked {
    Scenario(String, Box<Scenario>),
    Study(Plan),
}

fn read(file: &Path, overrides: &[Override]) -> Result<Checked, Report> {
    let text = contents(file)?;
    if is_study(&text) {
        return match overrides.first() {
            None => load_study(file).map(Checked::Study),
            Some(given) => Err(Report::from(Diagnostic {
                message: format!(
                    "{}{} is a study, whose fields are not set from outside",
                    given.prefix(),
                    file.display()
                ),
                help: Some("check it without --set".to_owned()),
                path: None,
                place: None,
            })),
        };
    }
    let scenario = parse(&file.display().to_string(), &text, overrides)?;
    Ok(Checked::Scenario(text, Box::new(scenario)))
}

fn write_study(file: &Path, plan: &Plan, out: &mut dyn Write) -> io::Result<()> {
    let trials: u64 = plan
        .settings
        .iter()
        .map(|setting| u64::from(setting.scenario.trials))
        .sum();
    let (name, settings) = (&plan.name, plan.settings.len());
    writeln!(
        out,
        "ok {}: {name}, a study of {settings} settings, {trials} trials",
        file.display()
    )
}

fn write_resolved(question: Option<String>, scenario: &Scenario, out: &mut dyn Write) -> io::Result<()> {
    if let Some(question) = question {
        writeln!(out, "// {question}")?;
    }
    write!(out, "{}", to_ron(scenario))
}

fn write_line(file: &Path, scenario: &Scenario, out: &mut dyn Write) -> io::Result<()> {
    let Scenario {
        name, trials, swarm, ..
    } = scenario;
    let counted = |count: u32, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
    let (trials, robots) = (counted(*trials, "trial"), counted(swarm.robots, "robot"));
    writeln!(out, "ok {}: {name}, {trials}, {robots}", file.display())
}

/// Colours where `stream` is a terminal, unless the user has switched them off.
pub fn style(stream: &impl IsTerminal) -> Style {
    Style {
        colour: stream.is_terminal() && std::env::var_os("NO_COLOR").is_none(),
        ..Style::PLAIN
    }
}
