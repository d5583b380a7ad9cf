//! `desim trace`: runs one finished trial again and writes a part of it for other programs to read.

mod place;
pub mod select;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::failure::Failure;
use super::finished_trial::FinishedTrial;
use super::output::{self, say};
use crate::experiment::{reach, watch_trial};
use crate::export::trace::{self, Run, dissector};
use crate::happenings::log::Log;
use crate::report::seconds;
use place::Place;
use select::Part;

/// What `desim trace --help` says.
pub const LONG_ABOUT: &str = "\
Writes a part of a finished trial for other programs to read: every frame with what became of each of its copies, every event, \
every place. As Parquet tables, as a packet capture for Wireshark and tshark, as a recording for robotics viewers, or as a \
trace of events for Perfetto.

Nothing of this is stored. A run is the same every time, so the trial is run again, and its digest shows that it is the \
same run; what is asked for is written as it goes by. results/README.md says what the tables and captures hold.

  desim trace results/loss20 --as pcapng --from 10 --until 20
  desim trace --dissector > desim.lua
  tshark -X lua_script:desim.lua -r results/loss20/trace.pcapng";

/// Arguments of `desim trace`.
#[derive(Debug, Args)]
pub struct TraceArguments {
    /// Folder of finished results
    #[arg(required_unless_present = "dissector")]
    pub dir: Option<PathBuf>,
    /// What to write it as
    #[arg(
        long = "as",
        value_enum,
        value_name = "FORMAT",
        required_unless_present = "dissector"
    )]
    pub format: Option<Format>,
    /// Number of the trial, from 0
    #[arg(long, value_name = "K", default_value_t = 0)]
    pub trial: u32,
    /// What part of it
    #[command(flatten)]
    pub part: Part,
    /// Where to write it, - for standard output [default: trace in DIR, with the format's ending; of another trial than 0 trace-K]
    #[arg(long, value_name = "PATH")]
    pub out: Option<PathBuf>,
    /// Print a dissector of captures for Wireshark and tshark instead
    #[arg(long, conflicts_with_all = ["dir", "format", "from", "until", "robots", "topics", "places_every", "out"])]
    pub dissector: bool,
}

/// What a trace is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Parquet tables in a folder: frames, messages, copies, events, places
    Parquet,
    /// A packet capture, for Wireshark and tshark
    Pcapng,
    /// A recording for Foxglove, Lichtblick and Rerun: robots, links, events
    Mcap,
    /// A trace of events for Perfetto, gzipped if --out ends in .gz
    Perfetto,
}

impl From<Format> for trace::Format {
    fn from(format: Format) -> Self {
        match format {
            Format::Parquet => Self::Parquet,
            Format::Pcapng => Self::Pcapng,
            Format::Mcap => Self::Mcap,
            Format::Perfetto => Self::Perfetto,
        }
    }
}

/// Writes the trace, or prints the dissector.
///
/// # Errors
/// If there is no such trial, or no such part of it, it cannot be run again, or the trace cannot be written.
pub fn run(arguments: &TraceArguments) -> Result<(), Failure> {
    let (Some(dir), Some(format)) = (&arguments.dir, arguments.format) else {
        use std::io::Write as _;
        output::stdout().write_all(dissector().as_bytes())?;
        return Ok(());
    };
    let format = trace::Format::from(format);
    let finished = FinishedTrial::of(dir, arguments.trial)?;
    let scenario = &finished.scenario;
    let run = Run::new(
        scenario,
        finished.trial,
        finished.digest(),
        reach(scenario, finished.trial),
    );
    let selection = arguments.part.of(&run, finished.simulated_s())?;
    let place = Place::of(&finished.dir, finished.trial, format, arguments.out.as_deref())?;
    let words = format!(
        "holds {} to {} of trial {}",
        seconds(selection.from.as_secs()),
        seconds(selection.until.as_secs().min(finished.simulated_s())),
        finished.trial
    );
    let gzipped = arguments.out.as_deref().and_then(Path::extension) == Some("gz".as_ref());
    let trace = format
        .create(place.unfinished(), run, &selection, gzipped)
        .map_err(|error| place.failed(&error))?;
    let log = Log::new(selection, scenario.radio.shared().is_some(), trace);
    let (record, log) = finished.again("write", |stop| watch_trial(scenario, finished.trial, log, stop))?;
    log.into_sink()
        .and_then(|trace| trace.finish(&record))
        .map_err(|error| place.failed(&error))?;
    let shown = place.keep()?;
    if let Some(path) = shown {
        say(&format!("{path} {words}"));
    }
    Ok(())
}
