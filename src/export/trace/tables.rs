//! A trace as Parquet tables: frames, messages, copies, events, places.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::io;
use std::path::Path;

use super::super::files::TRACE_TABLES;
use super::super::table::{Column, Table};
use super::Trace;
use super::context::Run;
use super::standing::Standing;
use crate::engine::{ActorId, SimTime};
use crate::happenings::Vocabulary;
use crate::happenings::log::{CopyRecord, Event, Frame, Message, Sink, What, address_name};
use crate::metrics::TrialRecord;
use crate::motion::World;
use crate::radio::LossCause;

/// The tables of a trace being written.
pub struct Tables {
    run: Run,
    frames: Table<FrameRow>,
    messages: Table<MessageRow>,
    copies: Table<CopyRow>,
    events: Table<EventRow>,
    places: Table<PlaceRow>,
    standing: Standing,
}

struct FrameRow {
    frame: Frame,
    topic: &'static str,
    bytes: u64,
}

struct MessageRow {
    at: SimTime,
    sender: u32,
    frame: u32,
    message: Message,
    topic: &'static str,
    header_bytes: u64,
    payload: String,
    content: Option<String>,
}

struct CopyRow {
    record: CopyRecord,
    topic: &'static str,
}

struct EventRow {
    event: Event,
    number: Option<u32>,
    name: Option<&'static str>,
    value: Option<f64>,
    others: Vec<u32>,
}

struct PlaceRow {
    at: SimTime,
    robot: u32,
    place: [f64; 3],
    role: &'static str,
}

impl Tables {
    /// Begins the tables in the folder `dir`.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn create(dir: &Path, run: Run) -> io::Result<Self> {
        let path = |index: usize| dir.join(TRACE_TABLES[index]);
        Ok(Self {
            run,
            frames: Table::create(&path(0), frame_columns())?,
            messages: Table::create(&path(1), message_columns())?,
            copies: Table::create(&path(2), copy_columns())?,
            events: Table::create(&path(3), event_columns())?,
            places: Table::create(&path(4), place_columns())?,
            standing: Standing::default(),
        })
    }
}

impl Trace for Tables {
    fn finish(self: Box<Self>, _: &TrialRecord) -> io::Result<()> {
        self.frames.finish()?;
        self.messages.finish()?;
        self.copies.finish()?;
        self.events.finish()?;
        self.places.finish()
    }
}

impl Sink for Tables {
    fn begin(&mut self, _: &Vocabulary, world: &World) -> io::Result<()> {
        self.standing = Standing::of(world.positions().len());
        Ok(())
    }

    fn frame(&mut self, frame: &Frame) -> io::Result<()> {
        let run = &self.run;
        let mut first = u64::from(run.frame_header);
        let rows = frame.contents().map(|(message, payload)| MessageRow {
            at: frame.at,
            sender: frame.sender.0,
            frame: frame.number,
            message: *message,
            topic: run.topic(message.topic.0),
            header_bytes: std::mem::take(&mut first) + u64::from(run.message_header),
            payload: hexadecimal(payload),
            content: (!run.layout.is_empty()).then(|| run.layout.read(payload).to_string()),
        });
        self.messages.extend(rows)?;
        self.frames.extend([FrameRow {
            topic: run.topic(frame.messages[0].topic.0),
            bytes: run.bytes(frame.messages.len(), frame.payloads.len()),
            frame: frame.clone(),
        }])
    }

    fn copy(&mut self, record: &CopyRecord) -> io::Result<()> {
        self.copies.extend([CopyRow {
            topic: self.run.topic(record.copy.topic.0),
            record: *record,
        }])
    }

    fn event(&mut self, event: &Event) -> io::Result<()> {
        self.standing.take(event);
        let (mut number, mut name, mut value, mut others) = (None, None, None, Vec::new());
        match &event.what {
            What::Fails(effect) | What::Recovers(effect) => name = Some(effect.name()),
            What::LinksFail(kind) | What::LinksRecover(kind) => name = Some(*kind),
            What::Suspects(_, heard) => value = Some(heard.as_secs()),
            What::Enters(role) => name = Some(self.run.role(*role)),
            What::Serves(target) => number = target.map(u32::from),
            What::ReliesOn(robots) => others = robots.iter().map(|robot| robot.0).collect(),
            What::Learns(rumor, _) => number = Some(u32::from(*rumor)),
            What::Counts(what, n) => (name, value) = (Some(*what), Some(*n as f64)),
            What::Measures(what, measured) => (name, value) = (Some(*what), Some(*measured)),
            What::Watches(_) | What::Trusts(_) => {}
        }
        self.events.extend([EventRow {
            event: event.clone(),
            number,
            name,
            value,
            others,
        }])
    }

    fn aside(&mut self, event: &Event) -> io::Result<()> {
        self.standing.take(event);
        Ok(())
    }

    fn places(&mut self, world: &World) -> io::Result<()> {
        let at = world.now();
        let (run, standing) = (&self.run, &self.standing);
        let robots = 0..standing.robots() as u32;
        self.places.extend(robots.map(|robot| PlaceRow {
            at,
            robot,
            place: world.pose(ActorId(robot), at).into(),
            role: run.role(standing.role(robot as usize)),
        }))
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(2 * bytes.len());
    for byte in bytes {
        let _ = write!(text, "{byte:02x}");
    }
    text
}

fn frame_columns() -> Vec<Column<FrameRow>> {
    type Col = Column<FrameRow>;
    vec![
        Col::f64("time_s", |row| row.frame.at.as_secs()),
        Col::id("sender", |row| row.frame.sender.0),
        Col::id("frame", |row| row.frame.number),
        Col::optional_id("to", |row| row.frame.to().map(|to| to.0)),
        Col::text("topic", |row| row.topic.into()),
        Col::id("messages", |row| row.frame.messages.len() as u32),
        Col::count("bytes", |row| row.bytes),
        Col::count("payload_bytes", |row| row.frame.payloads.len() as u64),
        Col::optional_f64("began_s", |row| Some(row.frame.sending?.began?.as_secs())),
        Col::optional_id("attempts", |row| Some(row.frame.sending?.attempts)),
        Col::optional_text("outcome", |row| Some(row.frame.sending?.outcome.name().into())),
        Col::count("offered", |row| row.frame.offered),
        Col::count("delivered", |row| row.frame.delivered),
        Col::count("lost", |row| row.frame.lost()),
    ]
}

fn message_columns() -> Vec<Column<MessageRow>> {
    type Col = Column<MessageRow>;
    vec![
        Col::f64("time_s", |row| row.at.as_secs()),
        Col::id("sender", |row| row.sender),
        Col::id("frame", |row| row.frame),
        Col::id("message", |row| row.message.sequence),
        Col::text("topic", |row| row.topic.into()),
        Col::optional_id("to", |row| row.message.to.map(|to| to.0)),
        Col::count("payload_bytes", |row| row.message.payload_bytes.into()),
        Col::count("header_bytes", |row| row.header_bytes),
        Col::text("payload", |row| Cow::Owned(row.payload.clone())),
        Col::optional_text("content", |row| row.content.clone().map(Cow::Owned)),
    ]
}

fn copy_columns() -> Vec<Column<CopyRow>> {
    type Col = Column<CopyRow>;
    let seconds = |at: Option<SimTime>| at.map(SimTime::as_secs);
    vec![
        Col::f64("sent_s", |row| row.record.copy.sent_at.as_secs()),
        Col::id("sender", |row| row.record.copy.sender.0),
        Col::id("frame", |row| row.record.frame),
        Col::id("message", |row| row.record.copy.sequence),
        Col::text("topic", |row| row.topic.into()),
        Col::id("receiver", |row| row.record.copy.receiver.0),
        Col::text("address", |row| address_name(row.record.copy.address).into()),
        Col::text("fate", |row| row.record.fate.name().into()),
        Col::optional_text("cause", |row| {
            row.record.fate.cause().map(LossCause::name).map(Into::into)
        }),
        Col::optional_f64("time_s", move |row| seconds(row.record.at)),
        Col::optional_f64("read_s", move |row| seconds(row.record.read)),
        Col::optional_f64("power_dbm", |row| row.record.power.map(f64::from)),
        Col::optional_f64("distance_m", |row| row.record.distance.map(f64::from)),
    ]
}

fn event_columns() -> Vec<Column<EventRow>> {
    type Col = Column<EventRow>;
    vec![
        Col::f64("time_s", |row| row.event.at.as_secs()),
        Col::optional_id("robot", |row| row.event.robot.map(|robot| robot.0)),
        Col::text("event", |row| row.event.what.name().into()),
        Col::optional_id("about", |row| row.event.what.about().map(|robot| robot.0)),
        Col::optional_id("number", |row| row.number),
        Col::optional_text("name", |row| row.name.map(Into::into)),
        Col::optional_f64("value", |row| row.value),
        Col::list_of_ids("others", |row| row.others.clone()),
    ]
}

fn place_columns() -> Vec<Column<PlaceRow>> {
    type Col = Column<PlaceRow>;
    vec![
        Col::f64("time_s", |row| row.at.as_secs()),
        Col::id("robot", |row| row.robot),
        Col::f64("x_m", |row| row.place[0]),
        Col::f64("y_m", |row| row.place[1]),
        Col::f64("heading_rad", |row| row.place[2]),
        Col::text("role", |row| row.role.into()),
    ]
}
