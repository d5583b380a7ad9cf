//! `desim check`: says everything that is wrong with scenario files before they are run.

use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

use crate::scenario::{Diagnostic, Override, Report, Scenario, Style, contents, parse, question, to_ron};

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
            Ok((text, scenario)) => accepted.push((file, text, scenario)),
            Err(report) => {
                well = false;
                write!(out, "{}", report.render(style(&io::stdout())))?;
            }
        }
    }
    for (file, text, scenario) in accepted {
        if resolved {
            write_resolved(&text, &scenario, out)?;
        } else {
            write_line(file, &scenario, out)?;
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

fn read(file: &Path, overrides: &[Override]) -> Result<(String, Scenario), Report> {
    let text = contents(file)?;
    let scenario = parse(&file.display().to_string(), &text, overrides)?;
    Ok((text, scenario))
}

fn write_resolved(text: &str, scenario: &Scenario, out: &mut dyn Write) -> io::Result<()> {
    if let Some(question) = question(text) {
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
