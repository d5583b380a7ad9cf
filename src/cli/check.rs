//! `desim check`: says everything that is wrong with scenario and study files before they are run.

use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

use crate::export;
use crate::predict::Preflight;
use crate::report;
use crate::scenario::{
    Diagnostic, Override, Plan, Report, Scenario, Style, contents, is_study, load_study, parse, question, to_ron,
};

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
            Ok(checked) => accepted.push((file, checked)),
            Err(report) => {
                well = false;
                write_faults(&report, say, out)?;
            }
        }
    }
    if say == Say::ExpectedJson {
        if well {
            let scenarios = accepted.iter().flat_map(|(_, checked)| checked.scenarios());
            let expected: Vec<Preflight> = scenarios.map(Preflight::of).collect();
            out.write_all(&export::json(&expected))?;
        }
        return Ok(well);
    }
    let colour = style(&io::stdout()).colour;
    let mut apart = "";
    for (file, checked) in &accepted {
        let question = checked.question();
        if say == Say::Well {
            write_line(file, checked, out)?;
            continue;
        }
        for scenario in checked.scenarios() {
            if say == Say::Resolved {
                write_resolved(question.as_deref(), scenario, out)?;
            } else {
                let text = report::preflight(&Preflight::of(scenario), question.as_deref(), colour);
                write!(out, "{apart}{text}")?;
                apart = "\n";
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

/// A file that is well.
enum Checked {
    Scenario(String, Box<Scenario>),
    Study(Plan),
}

impl Checked {
    /// The question that it asks.
    fn question(&self) -> Option<String> {
        match self {
            Self::Scenario(text, _) => question(text),
            Self::Study(plan) => plan.question.clone(),
        }
    }

    /// Its scenario, or those of its settings.
    fn scenarios(&self) -> Vec<&Scenario> {
        match self {
            Self::Scenario(_, scenario) => vec![scenario],
            Self::Study(plan) => plan.settings.iter().map(|setting| &setting.scenario).collect(),
        }
    }
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

fn write_resolved(question: Option<&str>, scenario: &Scenario, out: &mut dyn Write) -> io::Result<()> {
    if let Some(question) = question {
        writeln!(out, "// {question}")?;
    }
    write!(out, "{}", to_ron(scenario))
}

fn write_line(file: &Path, checked: &Checked, out: &mut dyn Write) -> io::Result<()> {
    let Scenario {
        name, trials, swarm, ..
    } = match checked {
        Checked::Scenario(_, scenario) => &**scenario,
        Checked::Study(plan) => return write_study(file, plan, out),
    };
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
