//! A part of one trial as others read it: frame logs, packet captures, recordings.
//!
//! Each format is a [`Sink`] of what a [`Log`](crate::happenings::log::Log) puts together while the trial runs, and writes as it goes: what is in memory does
//! not grow with the run.

mod capture;
mod context;
mod dissector;
mod link;
mod mcap;
mod palette;
mod pcapng;
mod perfetto;
mod standing;
#[cfg_attr(not(feature = "parquet"), path = "no_tables.rs")]
mod tables;
#[cfg(test)]
mod traced;

use std::io;
use std::path::Path;

pub use super::files::{TRACE as NAME, TRACE_TABLES as TABLES};
pub use context::Run;
pub use dissector::dissector;
pub use link::Link;

use crate::engine::{ActorId, SimTime};
use crate::happenings::Vocabulary;
use crate::happenings::log::{CopyRecord, Event, Frame, Selection, Sink};
use crate::metrics::TrialRecord;
use crate::motion::World;

/// What a trace is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Tables, in a folder.
    Parquet,
    /// A packet capture, read by Wireshark and tshark.
    Pcapng,
    /// A recording, read by Foxglove, Lichtblick and Rerun.
    Mcap,
    /// A trace of events, read by Perfetto.
    Perfetto,
}

/// A trace that is being written.
pub trait Trace: Sink {
    /// The run is over, with this record: writes what is left.
    ///
    /// # Errors
    /// If the file system refuses.
    fn finish(self: Box<Self>, record: &TrialRecord) -> io::Result<()>;
}

impl Format {
    /// How the names of such files end; `None` for a folder.
    #[must_use]
    pub const fn ending(self) -> Option<&'static str> {
        match self {
            Self::Parquet => None,
            Self::Pcapng => Some("pcapng"),
            Self::Mcap => Some("mcap"),
            Self::Perfetto => Some("json"),
        }
    }

    /// Whether a file that begins with these bytes is one.
    #[must_use]
    pub fn begins_with(self, bytes: &[u8]) -> bool {
        match self {
            Self::Parquet => false,
            Self::Pcapng => bytes.starts_with(&[0x0a, 0x0d, 0x0d, 0x0a]),
            Self::Mcap => bytes.starts_with(::mcap::MAGIC),
            Self::Perfetto => perfetto::is_begun_by(bytes),
        }
    }

    /// Begins a trace of a `selection` of `run` at `path`: a new file, or an empty folder. `gzipped` where the format is read so, and nothing to the others.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn create(self, path: &Path, run: Run, selection: &Selection, gzipped: bool) -> io::Result<Box<dyn Trace>> {
        Ok(match self {
            Self::Parquet => Box::new(tables::Tables::create(path, run)?),
            Self::Pcapng => Box::new(capture::Capture::create(path, run)?),
            Self::Mcap => Box::new(mcap::Recording::create(path, run)?),
            Self::Perfetto => Box::new(perfetto::Perfetto::create(path, run, selection, gzipped)?),
        })
    }
}

impl Sink for Box<dyn Trace> {
    fn begin(&mut self, vocabulary: &Vocabulary, world: &World) -> io::Result<()> {
        (**self).begin(vocabulary, world)
    }

    fn frame(&mut self, frame: &Frame) -> io::Result<()> {
        (**self).frame(frame)
    }

    fn copy(&mut self, record: &CopyRecord) -> io::Result<()> {
        (**self).copy(record)
    }

    fn settled(&mut self, until: SimTime) -> io::Result<()> {
        (**self).settled(until)
    }

    fn event(&mut self, event: &Event) -> io::Result<()> {
        (**self).event(event)
    }

    fn aside(&mut self, event: &Event) -> io::Result<()> {
        (**self).aside(event)
    }

    fn spoke(&mut self, now: SimTime, robot: ActorId, frames: u32, world: &World) -> io::Result<()> {
        (**self).spoke(now, robot, frames, world)
    }

    fn places(&mut self, world: &World) -> io::Result<()> {
        (**self).places(world)
    }
}
