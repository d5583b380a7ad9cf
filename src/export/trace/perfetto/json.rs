//! Chrome's trace events, as JSON: one line each, so that nothing of a long trace is held.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::Value;

use crate::engine::{SimTime, Span};

/// How a trace begins.
pub const BEGINNING: &str = "{\"displayTimeUnit\":\"ns\",\"traceEvents\":[\n";

/// An event. What is `None` is left out.
#[derive(Debug, Default, Serialize)]
pub struct Entry<'a> {
    /// What kind of event it is, a letter.
    pub ph: &'static str,
    /// What is written on it.
    #[serde(skip_serializing_if = "str::is_empty")]
    pub name: &'a str,
    /// A word that events can be filtered by.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cat: Option<&'static str>,
    /// The process that it belongs to.
    pub pid: u32,
    /// The thread that it belongs to.
    pub tid: u32,
    /// When, microseconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ts: Option<f64>,
    /// How long, microseconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dur: Option<f64>,
    /// By which events that belong together are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub id: Option<u64>,
    /// To which slice the end of a flow belongs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bp: Option<&'static str>,
    /// What more there is to know.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub args: Option<Value>,
}

/// An instant as events have it. The nearest number to a whole count of nanoseconds is printed with three decimals at most.
pub fn micros(at: SimTime) -> f64 {
    at.as_nanos() as f64 / 1e3
}

/// A time as events have it.
pub fn long(span: Span) -> f64 {
    span.as_nanos() as f64 / 1e3
}

/// A list of events being written.
#[derive(Debug)]
pub struct Events<W> {
    out: W,
    is_first: bool,
}

impl<W: Write> Events<W> {
    /// Begins the list.
    ///
    /// # Errors
    /// Those of the file.
    pub fn new(mut out: W) -> io::Result<Self> {
        out.write_all(BEGINNING.as_bytes())?;
        Ok(Self { out, is_first: true })
    }

    /// Appends an event.
    ///
    /// # Errors
    /// Those of the file.
    pub fn put(&mut self, entry: &Entry<'_>) -> io::Result<()> {
        if !std::mem::replace(&mut self.is_first, false) {
            self.out.write_all(b",\n")?;
        }
        Ok(serde_json::to_writer(&mut self.out, entry)?)
    }

    /// Ends the list, and says what it is `of`.
    ///
    /// # Errors
    /// Those of the file.
    pub fn finish(mut self, of: &Value) -> io::Result<W> {
        writeln!(self.out, "\n],\"otherData\":{of}}}")?;
        self.out.flush()?;
        Ok(self.out)
    }
}
