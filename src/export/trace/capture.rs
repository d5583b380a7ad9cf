//! A trace as a packet capture: an interface with the frames on air, and one with what became of each copy.
//!
//! A frame is captured when its sender hands it to its radio. It has the bytes that were accounted for it, but that its
//! [link](Link)'s headers stand for what is accounted a frame: the captured length is the accounted one minus a [constant](Capture::constant), which the capture's comment states.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::Path;

use super::Trace;
use super::context::Run;
use super::pcapng::Pcapng;
use crate::engine::SimTime;
use crate::happenings::log::{CopyRecord, Fate, Frame, Sink};
use crate::metrics::TrialRecord;
use crate::protocol::Address;
use crate::radio::LossCause;

const AIR: u32 = 0;
const FATES: u32 = 1;
/// The link type of fates: USER1.
const USER_1: u16 = 148;
/// In place of a cause where there is none.
const NO_CAUSE: u8 = 0xff;

/// A capture being written.
pub struct Capture {
    run: Run,
    header: MessageHeader,
    file: Pcapng<BufWriter<File>>,
    /// What is captured later than something that is yet to come: when, on which interface, as the how manyth, what. A frame comes before its copies.
    waiting: BinaryHeap<Reverse<Packet>>,
    captured: u64,
}

/// When, on which interface, as the how manyth; its bytes, and a comment.
type Packet = (SimTime, u32, u64, Vec<u8>, Option<String>);

/// What stands in front of each message in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MessageHeader {
    /// Whether its topic does, in a byte.
    pub topic: bool,
    /// Whether its length does, in two.
    pub length: bool,
    /// Bytes of zero that fill it up to what is accounted.
    pub padding: u16,
}

impl MessageHeader {
    /// As much of it as is accounted, and what a reader cannot do without.
    pub fn of(run: &Run) -> Self {
        let accounted = run.message_header;
        let topic = accounted >= 1 || run.topics.len() > 1;
        let length = accounted >= 3 || run.several;
        Self {
            topic,
            length,
            padding: accounted.saturating_sub(u16::from(topic) + 2 * u16::from(length)),
        }
    }

    /// How many bytes it has.
    fn bytes(self) -> u16 {
        u16::from(self.topic) + 2 * u16::from(self.length) + self.padding
    }

    fn put(self, topic: u8, length: u16, into: &mut Vec<u8>) {
        if self.topic {
            into.push(topic);
        }
        if self.length {
            into.extend(length.to_be_bytes());
        }
        into.resize(into.len() + usize::from(self.padding), 0);
    }
}

impl Capture {
    /// Begins the capture at `path`.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn create(path: &Path, run: Run) -> io::Result<Self> {
        let header = MessageHeader::of(&run);
        let file = BufWriter::new(File::create(path)?);
        let application = concat!("desim ", env!("CARGO_PKG_VERSION"));
        let mut file = Pcapng::new(file, application, &comment(&run, header))?;
        let protocol = run.scenario.protocol.name();
        let topics = run.topics.join("|");
        let MessageHeader { topic, length, padding } = header;
        let layout = format!("{},{},{padding}", u8::from(topic), 2 * u8::from(length));
        let air = format!("desim {protocol}; message header {layout}; topics {topics}");
        file.interface(run.link.number(), "air", &air)?;
        file.interface(USER_1, "fates", &format!("desim {protocol}; topics {topics}"))?;
        Ok(Self {
            run,
            header,
            file,
            waiting: BinaryHeap::new(),
            captured: 0,
        })
    }

    fn wait(&mut self, at: SimTime, interface: u32, bytes: Vec<u8>, comment: Option<String>) {
        self.waiting
            .push(Reverse((at, interface, self.captured, bytes, comment)));
        self.captured += 1;
    }
}

/// By how much accounted bytes of a frame of one message are more than captured ones.
fn constant(run: &Run, header: MessageHeader) -> i64 {
    let accounted = i64::from(run.frame_header) + i64::from(run.message_header);
    let captured = run.link.header_bytes() as u32 + u32::from(header.bytes());
    accounted - i64::from(captured)
}

fn comment(run: &Run, header: MessageHeader) -> String {
    let constant = constant(run, header);
    let more = header.bytes() - run.message_header;
    let each = if run.several && more > 0 {
        format!(", and {more} more for each message after a frame's first")
    } else {
        String::new()
    };
    format!(
        "{}, trial {}, seed {}, digest {}. Interface air: frames when they were handed to the radio; captured length = accounted bytes - ({constant}){each}. Interface fates: a copy at a receiver each, when it arrived or was lost.",
        run.scenario.name, run.trial, run.scenario.seed, run.digest,
    )
}

impl Sink for Capture {
    fn frame(&mut self, frame: &Frame) -> io::Result<()> {
        let mut bytes = Vec::new();
        self.run.link.put_header(frame, &mut bytes);
        for (message, payload) in frame.contents() {
            self.header.put(message.topic.0, message.payload_bytes, &mut bytes);
            bytes.extend(payload);
        }
        let comment = fates_in_words(frame);
        self.wait(frame.at, AIR, bytes, Some(comment));
        Ok(())
    }

    fn copy(&mut self, record: &CopyRecord) -> io::Result<()> {
        let copy = &record.copy;
        let at = record.at.unwrap_or(copy.sent_at);
        let mut bytes = Vec::with_capacity(36);
        for number in [copy.sender.0, copy.receiver.0, record.frame, copy.sequence] {
            bytes.extend(number.to_be_bytes());
        }
        let fate = match record.fate {
            Fate::Delivered => 0,
            Fate::Lost(_) => 1,
            Fate::InFlight => 2,
            Fate::Strayed => 3,
        };
        let address = match copy.address {
            Address::Everyone => 0,
            Address::Me => 1,
            Address::Another => 2,
        };
        let cause = record.fate.cause().map_or(NO_CAUSE, |cause| cause as u8);
        bytes.extend([copy.topic.0, fate, cause, address]);
        for measured in [record.power, record.distance] {
            bytes.extend(measured.unwrap_or(f32::NAN).to_be_bytes());
        }
        bytes.extend(at.as_nanos().saturating_sub(copy.sent_at.as_nanos()).to_be_bytes());
        self.wait(at, FATES, bytes, None);
        Ok(())
    }

    fn settled(&mut self, until: SimTime) -> io::Result<()> {
        while self.waiting.peek().is_some_and(|Reverse(first)| first.0 < until) {
            let Some(Reverse((at, interface, _, bytes, comment))) = self.waiting.pop() else {
                break;
            };
            self.file.packet(interface, at, &bytes, comment.as_deref())?;
        }
        Ok(())
    }
}

impl Trace for Capture {
    fn finish(mut self: Box<Self>, _: &TrialRecord) -> io::Result<()> {
        self.settled(SimTime::NEVER)?;
        self.file.finish()
    }
}

/// What became of a frame's copies.
fn fates_in_words(frame: &Frame) -> String {
    let mut words = format!("{} of {} delivered", frame.delivered, frame.offered);
    for (cause, &copies) in LossCause::ALL.iter().zip(&frame.lost) {
        if copies > 0 {
            let _ = write!(words, ", {copies} lost: {}", cause.name().replace('_', " "));
        }
    }
    words
}
