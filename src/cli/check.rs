//! `desim check`: says everything that is wrong with scenario files before they are run.

use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

use crate::export;
use crate::predict::Preflight;
use crate::report;
use crate::scenario::{Diagnostic, Override, Report, Scenario, Style, contents, parse, question, to_ron};

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
            Ok((text, scenario)) => accepted.push((file, text, scenario)),
            Err(report) => {
                well = false;
                write_faults(&report, say, out)?;
            }
        }
    }
    if say == Say::ExpectedJson {
        if well {
            let expected: Vec<Preflight> = accepted.iter().map(|(.., scenario)| Preflight::of(scenario)).collect();
            out.write_all(&export::json(&expected))?;
        }
        return Ok(well);
    }
    let colour = style(&io::stdout()).colour;
    for (index, (file, text, scenario)) in accepted.iter().enumerate() {
        match say {
            Say::Well => write_line(file, scenario, out)?,
            Say::Resolved => write_resolved(text, scenario, out)?,
            Say::Expected | Say::ExpectedJson => {
                let apart = if index > 0 { "\n" } else { "" };
                let text = report::preflight(&Preflight::of(scenario), question(text).as_deref(), colour);
                write!(out, "{apart}{text}")?;
            }
        }
    }
    Ok(well)
}

fn write_faults(faults: &Report, say: Say, out: &mut dyn Write) -> io::Result<()> {
    if say == Say::ExpectedJson {
        let mut standard_error = io::stderr();
        return write!(standard_error, "{}", faults.render(style(&standard_error)));
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
