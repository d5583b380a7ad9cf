//! `desim explain`: runs one finished trial again and tells why a robot was suspected.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::Args;

use super::failure::Failure;
use super::finished_trial::{FinishedTrial, refuse};
use super::output;
use super::shown::Format;
use crate::engine::ActorId;
use crate::experiment::trace_trial;
use crate::export;
use crate::report::Explanation;

/// What `desim explain --help` says.
pub const LONG_ABOUT: &str = "\
Tells in words and times why a robot was suspected: every status that it sent since it was last heard, and what became of \
each at the robot that came to suspect it, and whether and when it had really failed.

Nothing of this is stored. A run is the same every time, so the trial is run again, and its digest shows that it is the \
same run; where this version of desim would run it otherwise, it says so and explains nothing.";

/// Arguments of `desim explain`.
#[derive(Debug, Args)]
pub struct ExplainArguments {
    /// Folder of finished results
    pub dir: PathBuf,
    /// Number of the trial, from 0
    #[arg(long, value_name = "K")]
    pub trial: u32,
    /// Number of the robot that was suspected, from 0
    #[arg(long, value_name = "R")]
    pub robot: u32,
    /// Explain only this suspicion, by its number in the list, with every status on a line of its own
    #[arg(long, value_name = "N")]
    pub suspicion: Option<usize>,
    /// What to print on standard output
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// Explains.
///
/// # Errors
/// If there is nothing to explain by these arguments, or the trial cannot be run again.
///
/// # Panics
/// Never: what is asked for is traced.
pub fn run(arguments: &ExplainArguments) -> Result<(), Failure> {
    let finished = FinishedTrial::of(&arguments.dir, arguments.trial)?;
    let scenario = &finished.scenario;
    if !scenario.protocol.has_statuses() {
        return refuse(format!(
            "robots that run {} send no statuses: nobody watches over them, and nobody is suspected",
            scenario.protocol.name()
        ));
    }
    if arguments.robot >= scenario.swarm.robots {
        let robots = scenario.swarm.robots;
        return refuse(format!(
            "there is no robot {}: the scenario has robots 0 to {}",
            arguments.robot,
            robots - 1
        ));
    }
    let (record, ()) = finished.again("tell", |stop| {
        trace_trial(scenario, arguments.trial, ActorId(arguments.robot), stop).map(|record| (record, ()))
    })?;
    let mut explanation = Explanation::of(&scenario.name, &record).expect("the robot was traced");
    explanation.rule = scenario.detector.words();
    let chosen = chosen(&explanation, arguments)?;
    let mut out = output::stdout();
    match (arguments.format, chosen) {
        (Format::Json, None) => out.write_all(&export::json(&explanation))?,
        (Format::Json, Some(number)) => out.write_all(&export::json(&explanation.suspicions[number - 1]))?,
        (Format::Text, chosen) => out.write_all(explanation.text(chosen, output::style(&io::stdout())).as_bytes())?,
    }
    Ok(out.flush()?)
}

/// The number of the suspicion asked for, if one was and there is one.
fn chosen(explanation: &Explanation, arguments: &ExplainArguments) -> Result<Option<usize>, Failure> {
    let known = explanation.suspicions.len();
    match arguments.suspicion {
        Some(number) if known > 0 && !(1..=known).contains(&number) => refuse(format!(
            "there is no suspicion {number}: robot {} was suspected {known} time{}",
            arguments.robot,
            if known == 1 { "" } else { "s" }
        )),
        chosen => Ok(chosen.filter(|_| known > 0)),
    }
}
