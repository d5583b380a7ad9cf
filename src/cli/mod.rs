//! The command line: the only place that prints and the only exit code.
//!
//! [`main`] is the whole command. A program of one's own becomes it, with a protocol of its own beside those that desim
//! ships, in two lines:
//!
//! ```no_run
//! # fn with<Flood: desim::kind::Kind>() -> std::process::ExitCode {
//! desim::kinds::add::<Flood>();
//! desim::cli::main()
//! # }
//! ```

pub mod check;
pub mod compare;
pub mod explain;
mod failure;
mod finished_trial;
mod interrupt;
pub mod log;
pub mod merge;
pub mod new;
mod output;
mod page_file;
mod progress;
pub mod replay;
pub mod report;
pub mod scenario;
pub mod schema;
mod shard;
pub mod shown;
pub mod status;
mod told;
pub mod trace;
pub mod validate;

use std::ffi::OsString;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use check::{Deny, Say};
use compare::CompareArguments;
use explain::ExplainArguments;
use failure::FAULTY_INPUT;
pub use failure::Failure;
use merge::MergeArguments;
use new::NewArguments;
use replay::ReplayArguments;
use report::ReportArguments;
use scenario::ScenarioArguments;
use shown::Format;
use status::StatusArguments;
use trace::TraceArguments;
use validate::ValidateArguments;

use crate::text::clean_lines;

/// The command: reads the program's arguments, does what they ask for, and answers the exit status.
#[must_use]
pub fn main() -> ExitCode {
    match arguments(std::env::args_os()) {
        Ok(arguments) => {
            log::to_stderr();
            exit(run(arguments.command))
        }
        Err(status) => status,
    }
}

/// What the user asks for.
#[derive(Debug, Parser)]
#[command(name = "desim", version, about, long_about = LONG_ABOUT, after_help = EXIT_STATUS)]
pub struct Cli {
    /// The command.
    #[command(subcommand)]
    pub command: Command,
}

const LONG_ABOUT: &str = "\
Runs a robot swarm's protocol over a radio that loses and delays frames, often enough to say how sure the answer is: \
what the protocol costs, when it finishes, and what breaks it.

A scenario file holds one question. `desim scenario` answers it: a report on the terminal, tables, pictures and a \
summary in a folder. `desim report` makes a page of charts of that folder. A study file varies a scenario; `desim compare` says \
which of its settings is better, by how much, how sure.";

const EXIT_STATUS: &str = "\
Exit status:
  0    done
  2    the input is wrong: one message, nothing written
  1    anything else that went wrong
  130  interrupted by Ctrl-C or SIGTERM; finished trials are kept

Environment:
  COLUMNS    width that text is laid out for, from 20 to 160 [default: the terminal's; 80 where there is none]
  DESIM_LOG  what to log on stderr, such as `info` or `desim=debug`; nothing if unset
  NO_COLOR   no colours on a terminal either";

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run the trials of a scenario and report what they show
    #[command(long_about = scenario::LONG_ABOUT)]
    Scenario(ScenarioArguments),
    /// Compare the settings of a study, or several scenarios, under common random numbers
    #[command(long_about = compare::LONG_ABOUT)]
    Compare(CompareArguments),
    /// Put together what shards of a scenario or a study have left
    #[command(long_about = merge::LONG_ABOUT)]
    Merge(MergeArguments),
    /// Say how far trials are that run here or elsewhere
    #[command(long_about = status::LONG_ABOUT)]
    Status(StatusArguments),
    /// Say everything that is wrong with scenario and study files, without running them
    ///
    /// Of a study, every combination is checked. Each fault comes with its file, line and column, and with what would be right. Exit status 2 if there is any.
    /// What is allowed and hardly meant, such as a failure after the end, is warned of in the same way, and leaves the exit status 0.
    Check {
        /// Scenario files and study files (RON)
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// Set a value of the scenarios, such as `radio.loss=Bernoulli(0.3)`; may be given many times
        #[arg(long = "set", value_name = "PATH=VALUE")]
        overrides: Vec<String>,
        /// Print each scenario whole, those of a study's settings too, with every default and override in it
        #[arg(long)]
        resolved: bool,
        /// Print what closed forms expect of each scenario: neighbours, loss, latency, bytes, mistakes of the detector, each with
        /// its formula and with what it takes for granted
        #[arg(long, conflicts_with = "resolved")]
        predict: bool,
        /// How to print what is expected: as tables, or as one JSON list with an entry a file
        #[arg(long, value_enum, default_value_t, requires = "predict")]
        format: Format,
        /// Refuse what is warned of, for scripts
        #[arg(long, value_enum, value_name = "WHAT")]
        deny: Option<Deny>,
    },
    /// Report finished results again: on the terminal, and as a page of charts
    #[command(long_about = report::LONG_ABOUT)]
    Report(ReportArguments),
    /// Tell in words and times why a robot was suspected in a finished trial
    #[command(long_about = explain::LONG_ABOUT)]
    Explain(ExplainArguments),
    /// Make a page on which a finished trial can be watched
    #[command(long_about = replay::LONG_ABOUT)]
    Replay(ReplayArguments),
    /// Write frames, copies, events and places of a finished trial: tables, a packet capture, recordings
    #[command(long_about = trace::LONG_ABOUT)]
    Trace(TraceArguments),
    /// Hold every model against its closed form on this machine
    #[command(long_about = validate::LONG_ABOUT)]
    Validate(ValidateArguments),
    /// Write a scenario to begin with, or a crate with a protocol of your own
    #[command(long_about = new::LONG_ABOUT)]
    New(NewArguments),
    /// Print the JSON Schema of scenario files, for editors
    Schema {
        /// That of study files instead
        #[arg(long)]
        study: bool,
    },
}

/// What the user asks for by `arguments`, the first of which is the command's own name. Help, and what is wrong with the
/// arguments, is said at once.
///
/// # Errors
/// The exit status, if nothing is left to do.
pub fn arguments(arguments: impl IntoIterator<Item = OsString>) -> Result<Cli, ExitCode> {
    let style = output::style(&io::stdout());
    let command = Cli::command().term_width(style.width);
    let matches = command.try_get_matches_from(arguments);
    let error = match matches.and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => return Ok(cli),
        Err(error) => error,
    };
    let text = error.render();
    if error.use_stderr() {
        // It is laid out, but holds what was asked for.
        let text = text.to_string();
        let _ = output::stderr().write_all(clean_lines(&text).as_bytes());
        return Err(FAULTY_INPUT.into());
    }
    let text = if style.colour {
        text.ansi().to_string()
    } else {
        text.to_string()
    };
    let _ = output::stdout().write_all(text.as_bytes());
    Err(ExitCode::SUCCESS)
}

/// Runs a command.
///
/// # Errors
/// Whatever keeps it from being done.
pub fn run(command: Command) -> Result<(), Failure> {
    let mut out = output::stdout();
    match command {
        Command::Scenario(arguments) => scenario::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Merge(arguments) => merge::run(&arguments),
        Command::Status(arguments) => status::run(&arguments),
        Command::Check {
            files,
            overrides,
            resolved,
            predict,
            format,
            deny,
        } => {
            let say = match (resolved, predict, format) {
                (true, ..) => Say::Resolved,
                (_, true, Format::Text) => Say::Expected,
                (_, true, Format::Json) => Say::ExpectedJson,
                (false, false, _) => Say::Well,
            };
            let well = check::check(&files, &overrides, say, deny, &mut out)?;
            if well { Ok(()) } else { Err(Failure::Shown) }
        }
        Command::Report(arguments) => report::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Replay(arguments) => replay::run(&arguments),
        Command::Trace(arguments) => trace::run(&arguments),
        Command::Validate(arguments) => validate::run(&arguments),
        Command::New(arguments) => new::run(&arguments, &mut out),
        Command::Schema { study } => Ok(schema::schema(study, &mut out)?),
    }
}

/// Says on stderr what went wrong, if anything, and answers the exit status.
#[must_use]
pub fn exit(result: Result<(), Failure>) -> ExitCode {
    let Err(failure) = result else { return ExitCode::SUCCESS };
    match &failure {
        Failure::Drawn(faults) => {
            let _ = output::stderr().write_all(faults.as_bytes());
        }
        Failure::Input(words) | Failure::Other(words) | Failure::Interrupted(words) => output::say(words),
        Failure::Shown | Failure::Differs => {}
    }
    failure.status().into()
}
