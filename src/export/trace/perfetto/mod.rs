//! A trace for Perfetto (ui.perfetto.dev), as Chrome's trace events (docs.google.com/document/d/1CvAClvFfyA5R-PhYUmn5OOQtYMH4h6I0nSsKchNAySU):
//! a process a robot, with tracks of its role, what ails it, whom it comes to suspect, what it says and what it hears; arrows from what one says to what others
//! hear, and from what was heard last to a suspicion.
//!
//! What is told is drawn in order of time, as soon as nothing earlier is to come. What is in memory does not grow with the run.

mod air;
mod heard;
mod json;
mod states;
#[cfg(test)]
mod tests;
mod tracks;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::json;

use super::Trace;
use super::context::Run;
use crate::engine::{ActorId, SimTime};
use crate::happenings::Vocabulary;
use crate::happenings::log::{CopyRecord, Event, Frame, Selection, Sink};
use crate::metrics::TrialRecord;
use crate::motion::World;
use crate::radio::{Phy, SharedConfig};
use air::{Reached, Said};
use heard::Heard;
use json::{BEGINNING, Events};
use states::{States, take_number};
use tracks::{INSTANT, Tracks};

/// How a gzipped one does: a header without a date and without a system, which few others write.
const GZIPPED: [u8; 10] = [0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 0xff];

/// Whether a file that begins with these bytes may be such a trace, gzipped or not.
pub fn is_begun_by(bytes: &[u8]) -> bool {
    let shared = bytes.len().min(BEGINNING.len());
    let is_plain = bytes.starts_with(b"{") && bytes[..shared] == BEGINNING.as_bytes()[..shared];
    is_plain || bytes.starts_with(&GZIPPED)
}

/// A trace being written.
pub struct Perfetto<W> {
    run: Run,
    selection: Selection,
    /// Over a radio on which frames take time.
    phy: Option<Phy>,
    tracks: Tracks<W>,
    states: States,
    heard: Heard,
    /// What is yet to be drawn, in order of time; at the same time frames first, then copies, then events, in the order in which they were told.
    waiting: BTreeMap<Key, Waiting>,
    told: u64,
    /// Which copies wait whose frame has not been told: by when it was sent, by whom, as the how manyth.
    copies: BTreeMap<(SimTime, ActorId, u32), Vec<Key>>,
    last_number: u64,
    has_begun: bool,
}

type Key = (SimTime, u8, u64);

enum Waiting {
    Said(Said),
    Reached(Reached),
    Happened(Event),
}

impl Perfetto<Output> {
    /// Begins the trace of a `selection` of `run` at `path`, gzipped or not.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn create(path: &Path, run: Run, selection: &Selection, gzipped: bool) -> io::Result<Self> {
        let file = BufWriter::new(File::create(path)?);
        let out = if gzipped {
            Output::Gzipped(GzEncoder::new(file, Compression::default()))
        } else {
            Output::Plain(file)
        };
        Self::begin(out, run, selection)
    }
}

impl<W: Write> Perfetto<W> {
    fn begin(out: W, run: Run, selection: &Selection) -> io::Result<Self> {
        let robots = run.scenario.swarm.robots;
        let shown = (0..robots).map(ActorId).filter(|robot| selection.has_robot(*robot));
        Ok(Self {
            phy: run.scenario.radio.shared().map(SharedConfig::phy),
            states: States::of(shown, run.roles),
            tracks: Tracks::new(Events::new(out)?, robots),
            selection: selection.clone(),
            run,
            heard: Heard::default(),
            waiting: BTreeMap::new(),
            told: 0,
            copies: BTreeMap::new(),
            last_number: 0,
            has_begun: false,
        })
    }

    fn wait(&mut self, at: SimTime, what: Waiting) -> Key {
        let rank = match what {
            Waiting::Said(_) => 0,
            Waiting::Reached(_) => 1,
            Waiting::Happened(_) => 2,
        };
        let key = (at, rank, take_number(&mut self.told));
        self.waiting.insert(key, what);
        key
    }

    /// Draws what waits from before `until`.
    fn draw(&mut self, until: SimTime) -> io::Result<()> {
        while let Some(first) = self.waiting.first_entry().filter(|first| first.key().0 < until) {
            let ((at, ..), what) = first.remove_entry();
            self.begin_states()?;
            match what {
                Waiting::Said(said) => self.draw_said(said)?,
                Waiting::Reached(reached) => self.draw_reached(&reached, at)?,
                Waiting::Happened(event) => self.take(&event)?,
            }
        }
        Ok(())
    }

    fn draw_said(&mut self, mut said: Said) -> io::Result<()> {
        let (begin, lasts) = (said.begin, said.lasts);
        let track = self.tracks.slice(said.slice(), begin, lasts)?;
        if let Some(arrow) = said.arrow {
            self.tracks.flow("s", "copy", arrow, (track, begin))?;
        }
        Ok(())
    }

    fn draw_reached(&mut self, reached: &Reached, at: SimTime) -> io::Result<()> {
        let name = reached.name(&self.run);
        let track = self.tracks.slice(reached.slice(&name), at, INSTANT)?;
        if let Some(arrow) = reached.arrow {
            self.tracks.flow("f", "copy", arrow, (track, at))?;
        }
        let CopyRecord { copy, fate, read, .. } = reached.record;
        if fate.cause().is_none() {
            let pair = (copy.receiver, copy.sender);
            self.heard
                .note(pair, copy.topic, at, read.unwrap_or(SimTime::NEVER), track);
        }
        Ok(())
    }

    fn take(&mut self, event: &Event) -> io::Result<()> {
        self.states
            .take(event, &mut self.heard, &mut self.tracks, &mut self.last_number)
    }

    /// Draws what holds at the beginning, once all that was before it is known.
    fn begin_states(&mut self) -> io::Result<()> {
        if std::mem::replace(&mut self.has_begun, true) {
            return Ok(());
        }
        self.states.begin(&mut self.tracks, self.selection.from)
    }

    /// Figures of the swarm, while the selection lasts.
    fn count(&mut self, record: &TrialRecord) -> io::Result<()> {
        let is_then = |at: SimTime| self.selection.is_then(at);
        for sample in record.connectivity.iter().filter(|sample| is_then(sample.at)) {
            self.tracks
                .counter("connectivity", sample.at, json!({ "λ₂": sample.lambda2 }))?;
        }
        for entry in record.series.iter().filter(|entry| is_then(entry.since)) {
            let seconds = entry.at.since(entry.since).as_secs();
            if seconds > 0.0 {
                let rate = |bytes: u64| bytes as f64 / seconds;
                let sent = rate(entry.sent.iter().map(|bytes| bytes.total).sum());
                let received = rate(entry.received.iter().map(|bytes| bytes.total).sum());
                let values = json!({ "sent": sent, "received": received });
                self.tracks.counter("bytes a second", entry.since, values)?;
            }
        }
        Ok(())
    }

    fn close(mut self, record: &TrialRecord) -> io::Result<W> {
        self.draw(SimTime::NEVER)?;
        self.begin_states()?;
        self.states
            .end(&mut self.tracks, self.selection.until.min(record.simulated))?;
        self.count(record)?;
        let of = json!({
            "made_by": concat!("desim ", env!("CARGO_PKG_VERSION")),
            "scenario": self.run.scenario.name,
            "trial": self.run.trial,
            "seed": self.run.scenario.seed,
            "digest": self.run.digest,
        });
        self.tracks.finish(&of)
    }
}

impl<W: Write + Send> Sink for Perfetto<W> {
    fn begin(&mut self, _: &Vocabulary, _: &World) -> io::Result<()> {
        Ok(())
    }

    fn frame(&mut self, frame: &Frame) -> io::Result<()> {
        let mut said = Said::of(&self.run, self.phy.as_ref(), frame);
        let copies = self.copies.remove(&(frame.at, frame.sender, frame.number));
        for key in copies.unwrap_or_default() {
            // Arrows lead forwards.
            if let Some(Waiting::Reached(reached)) = self.waiting.get_mut(&key).filter(|_| key.0 >= said.begin) {
                let last = &mut self.last_number;
                reached.arrow = Some(*said.arrow.get_or_insert_with(|| take_number(last)));
            }
        }
        self.wait(said.begin, Waiting::Said(said));
        Ok(())
    }

    fn copy(&mut self, record: &CopyRecord) -> io::Result<()> {
        let Some(at) = Reached::at(record) else { return Ok(()) };
        let reached = Reached {
            record: *record,
            arrow: None,
        };
        let key = self.wait(at, Waiting::Reached(reached));
        let frame = (record.copy.sent_at, record.copy.sender, record.frame);
        self.copies.entry(frame).or_default().push(key);
        Ok(())
    }

    fn settled(&mut self, until: SimTime) -> io::Result<()> {
        self.draw(until)?;
        // Of copies that strayed the frame may have been told before.
        while let Some(first) = self.copies.first_entry().filter(|first| first.key().0 < until) {
            first.remove();
        }
        self.heard.forget(until);
        Ok(())
    }

    fn event(&mut self, event: &Event) -> io::Result<()> {
        self.wait(event.at, Waiting::Happened(event.clone()));
        Ok(())
    }

    fn aside(&mut self, event: &Event) -> io::Result<()> {
        if event.at < self.selection.from && self.selection.has_event(event) {
            self.take(event)?;
        }
        Ok(())
    }
}

impl Trace for Perfetto<Output> {
    fn finish(self: Box<Self>, record: &TrialRecord) -> io::Result<()> {
        match self.close(record)? {
            Output::Plain(mut file) => file.flush(),
            Output::Gzipped(file) => file.finish()?.flush(),
        }
    }
}

/// Where a trace goes.
pub enum Output {
    /// As it is.
    Plain(BufWriter<File>),
    /// Gzipped, without a date.
    Gzipped(GzEncoder<BufWriter<File>>),
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Plain(file) => file.write(bytes),
            Self::Gzipped(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Plain(file) => file.flush(),
            Self::Gzipped(file) => file.flush(),
        }
    }
}
