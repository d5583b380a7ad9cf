//! `desim explain`: runs one finished trial again and tells why a robot was suspected, or what became of a frame.

use std::io::{self, Write};
use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;

use super::failure::Failure;
use super::finished_trial::{FinishedTrial, refuse};
use super::output;
use super::shown::Format;
use crate::engine::ActorId;
use crate::experiment::{trace_trial, watch_trial};
use crate::export;
use crate::happenings::log::{Log, Selection};
use crate::report::{Explanation, FrameStory, FrameTrace};
use crate::scenario::Scenario;

/// What `desim explain --help` says.
pub const LONG_ABOUT: &str = "\
Tells in words and times why a robot was suspected: every status that it sent since it was last heard, and what became of \
each at the robot that came to suspect it, and whether and when it had really failed. Or, with --frame, who heard one frame of \
a robot, who did not, and why.

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
    #[arg(long, value_name = "R", required_unless_present = "frame")]
    pub robot: Option<u32>,
    /// Explain only this suspicion, by its number in the list, with every status on a line of its own
    #[arg(long, value_name = "N")]
    pub suspicion: Option<usize>,
    /// Explain a frame instead: the robot that sent it, and its number among that robot's, from 0
    #[arg(long, value_name = "ROBOT:NUMBER", conflicts_with_all = ["robot", "suspicion"])]
    pub frame: Option<FrameNumber>,
    /// What to print on standard output
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// A frame, by its sender and its number among its sender's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameNumber(u32, u32);

impl FromStr for FrameNumber {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text
            .split_once(':')
            .and_then(|(robot, number)| Some(Self(robot.trim().parse().ok()?, number.trim().parse().ok()?)));
        numbers.ok_or_else(|| "a frame is a robot and the frame's number among that robot's, such as 7:120".to_owned())
    }
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
    match (arguments.frame, arguments.robot) {
        (Some(frame), _) => explain_frame(&finished, frame, arguments.format),
        (None, robot) => explain_robot(&finished, robot.expect("it is required without a frame"), arguments),
    }
}

fn explain_robot(finished: &FinishedTrial, robot: u32, arguments: &ExplainArguments) -> Result<(), Failure> {
    let scenario = &finished.scenario;
    if !scenario.protocol.has_statuses() {
        return refuse(format!(
            "robots that run {} send no statuses: nobody watches over them, and nobody is suspected",
            scenario.protocol.name()
        ));
    }
    check_robot(scenario, robot)?;
    let (record, ()) = finished.again("tell", |stop| {
        trace_trial(scenario, arguments.trial, ActorId(robot), stop).map(|record| (record, ()))
    })?;
    let mut explanation = Explanation::of(&scenario.name, &record).expect("the robot was traced");
    explanation.rule = scenario.detector.words();
    let chosen = chosen(&explanation, robot, arguments)?;
    let mut out = output::stdout();
    match (arguments.format, chosen) {
        (Format::Json, None) => out.write_all(&export::json(&explanation))?,
        (Format::Json, Some(number)) => out.write_all(&export::json(&explanation.suspicions[number - 1]))?,
        (Format::Text, chosen) => out.write_all(explanation.text(chosen, output::style(&io::stdout())).as_bytes())?,
    }
    Ok(out.flush()?)
}

fn explain_frame(finished: &FinishedTrial, frame: FrameNumber, format: Format) -> Result<(), Failure> {
    let (scenario, FrameNumber(robot, number)) = (&finished.scenario, frame);
    check_robot(scenario, robot)?;
    let selection = Selection {
        robots: Some([ActorId(robot)].into()),
        ..Selection::default()
    };
    let trace = FrameTrace::new(ActorId(robot), number);
    let log = Log::new(selection, scenario.radio.shared().is_some(), trace);
    let (_, log) = finished.again("tell", |stop| watch_trial(scenario, finished.trial, log, stop))?;
    let trace = log.into_sink()?;
    let said = trace.said();
    let Some(story) = FrameStory::of(scenario, finished.trial, trace) else {
        let numbers = match said {
            0 => "it sent none".to_owned(),
            said => format!("it sent frames 0 to {}", said - 1),
        };
        return refuse(format!(
            "robot {robot} sent no frame {number} in trial {}: {numbers}",
            finished.trial
        ));
    };
    let mut out = output::stdout();
    match format {
        Format::Json => out.write_all(&export::json(&story))?,
        Format::Text => out.write_all(story.text(output::style(&io::stdout())).as_bytes())?,
    }
    Ok(out.flush()?)
}

fn check_robot(scenario: &Scenario, robot: u32) -> Result<(), Failure> {
    let robots = scenario.swarm.robots;
    if robot < robots {
        return Ok(());
    }
    refuse(format!(
        "there is no robot {robot}: the scenario has robots 0 to {}",
        robots - 1
    ))
}

/// The number of the suspicion asked for, if one was and there is one.
fn chosen(explanation: &Explanation, robot: u32, arguments: &ExplainArguments) -> Result<Option<usize>, Failure> {
    let known = explanation.suspicions.len();
    match arguments.suspicion {
        Some(number) if known > 0 && !(1..=known).contains(&number) => refuse(format!(
            "there is no suspicion {number}: robot {robot} was suspected {known} time{}",
            if known == 1 { "" } else { "s" }
        )),
        chosen => Ok(chosen.filter(|_| known > 0)),
    }
}
