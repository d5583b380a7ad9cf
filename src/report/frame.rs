//! One frame: who heard it, who did not, and why.

use std::io;

use serde::Serialize;

use super::grid::{Column, Grid};
use super::layout::Page;
use super::number::{NOTHING, count};
use crate::engine::{ActorId, SimTime};
use crate::happenings::log::{CopyRecord, Fate, Frame, Sink};
use crate::motion::World;
use crate::scenario::Scenario;
use crate::text::Style;

/// Keeps one frame of a run, with its copies and with how far everybody was when it was said: for a [`Log`](crate::happenings::log::Log).
#[derive(Debug)]
pub struct FrameTrace {
    sender: ActorId,
    number: u32,
    /// How many frames the sender has said by now.
    said: u32,
    frame: Option<Frame>,
    copies: Vec<CopyRecord>,
    distances: Vec<f64>,
}

impl FrameTrace {
    /// Of frame `number` of `sender`.
    #[must_use]
    pub const fn new(sender: ActorId, number: u32) -> Self {
        Self {
            sender,
            number,
            said: 0,
            frame: None,
            copies: Vec::new(),
            distances: Vec::new(),
        }
    }

    /// How many frames the sender said in all of the run.
    #[must_use]
    pub const fn said(&self) -> u32 {
        self.said
    }
}

impl Sink for FrameTrace {
    fn spoke(&mut self, now: SimTime, robot: ActorId, frames: u32, world: &World) -> io::Result<()> {
        if robot != self.sender {
            return Ok(());
        }
        if (self.said..frames).contains(&self.number) {
            let here = world.position(robot, now);
            let robots = 0..world.positions().len() as u32;
            self.distances = robots
                .map(|other| (world.position(ActorId(other), now) - here).norm())
                .collect();
        }
        self.said = frames;
        Ok(())
    }

    fn frame(&mut self, frame: &Frame) -> io::Result<()> {
        if (frame.sender, frame.number) == (self.sender, self.number) {
            self.frame = Some(frame.clone());
        }
        Ok(())
    }

    fn copy(&mut self, record: &CopyRecord) -> io::Result<()> {
        if (record.copy.sender, record.frame) == (self.sender, self.number) {
            self.copies.push(*record);
        }
        Ok(())
    }
}

/// What became of one frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrameStory {
    /// The scenario's name.
    pub scenario: String,
    /// Number of the trial.
    pub trial: u32,
    /// Who sent it.
    pub robot: u32,
    /// Its number among its sender's frames, from 0.
    pub frame: u32,
    /// When it was handed to the radio, seconds.
    pub at_s: f64,
    /// Its bytes, headers included.
    pub bytes: u64,
    /// The messages in it.
    pub messages: Vec<MessageStory>,
    /// When it first went on air, seconds, over a radio on which frames take time.
    pub began_s: Option<f64>,
    /// How often it was on air, over such a radio.
    pub attempts: Option<u32>,
    /// How that ended, over such a radio.
    pub outcome: Option<&'static str>,
    /// Its copies, in order of receivers.
    pub copies: Vec<CopyStory>,
    /// Robots that it was not offered to, the nearest first, and how far away they were, metres.
    pub others: Vec<(u32, f64)>,
}

/// A message of the frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MessageStory {
    /// Its number among its sender's messages.
    pub message: u32,
    /// Its topic.
    pub topic: &'static str,
    /// The robot that it is for, if it is for one.
    pub to: Option<u32>,
    /// Bytes of its payload.
    pub payload_bytes: u16,
    /// What it says, where its protocol describes that.
    pub content: Option<String>,
}

/// A copy of a message of the frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CopyStory {
    /// For whom.
    pub receiver: u32,
    /// Of which topic.
    pub topic: &'static str,
    /// How far its receiver was away when the frame was said, metres.
    pub distance_m: f64,
    /// What became of it: delivered, lost, in_flight or strayed.
    pub fate: &'static str,
    /// Why it was lost.
    pub cause: Option<&'static str>,
    /// When it arrived or was lost, seconds.
    pub at_s: Option<f64>,
    /// When it was read, seconds.
    pub read_s: Option<f64>,
    /// With what power it arrived, dBm.
    pub power_dbm: Option<f32>,
}

impl FrameStory {
    /// The story of what `trace` kept of a trial of `scenario`; `None` if there was no such frame.
    #[must_use]
    pub fn of(scenario: &Scenario, trial: u32, trace: FrameTrace) -> Option<Self> {
        let FrameTrace {
            frame,
            mut copies,
            distances,
            ..
        } = trace;
        let frame = frame?;
        copies.sort_by_key(|record| (record.copy.receiver, record.copy.sequence));
        let topics = scenario.topics();
        let topic = |number: u8| topics.get(usize::from(number)).copied().unwrap_or("unknown");
        let layout = scenario.layout();
        let messages = frame.contents().map(|(message, payload)| MessageStory {
            message: message.sequence,
            topic: topic(message.topic.0),
            to: message.to.map(|to| to.0),
            payload_bytes: message.payload_bytes,
            content: (!layout.is_empty()).then(|| layout.read(payload).to_string()),
        });
        let away = |robot: ActorId| distances.get(robot.index()).copied().unwrap_or(f64::NAN);
        let mut others: Vec<(u32, f64)> = (0..)
            .zip(&distances)
            .filter(|(robot, _)| *robot != frame.sender.0)
            .filter(|(robot, _)| copies.iter().all(|record| record.copy.receiver.0 != *robot))
            .map(|(robot, distance)| (robot, *distance))
            .collect();
        others.sort_by(|a, b| a.1.total_cmp(&b.1));
        let [header, each] = scenario.header_bytes();
        Some(Self {
            scenario: scenario.name.clone(),
            trial,
            robot: frame.sender.0,
            frame: frame.number,
            at_s: frame.at.as_secs(),
            bytes: u64::from(header) + frame.messages.len() as u64 * u64::from(each) + frame.payloads.len() as u64,
            messages: messages.collect(),
            began_s: frame.sending.and_then(|sending| sending.began).map(SimTime::as_secs),
            attempts: frame.sending.map(|sending| sending.attempts),
            outcome: frame.sending.map(|sending| sending.outcome.name()),
            copies: copies
                .iter()
                .map(|record| CopyStory {
                    receiver: record.copy.receiver.0,
                    topic: topic(record.copy.topic.0),
                    distance_m: away(record.copy.receiver),
                    fate: record.fate.name(),
                    cause: record.fate.cause().map(crate::radio::LossCause::name),
                    at_s: record.at.map(SimTime::as_secs),
                    read_s: record.read.map(SimTime::as_secs),
                    power_dbm: record.power,
                })
                .collect(),
            others,
        })
    }

    /// The story as text.
    #[must_use]
    pub fn text(&self, style: Style) -> String {
        let mut page = Page::new(style);
        self.introduce(&mut page);
        self.list(&mut page);
        if let Some(((nearest, distance), more)) = self.others.split_first() {
            let words = match more.len() {
                0 => format!("Robot {nearest} was out of range, {distance:.2} m away."),
                more => format!(
                    "{} robots were out of range, the nearest robot {nearest}, {distance:.2} m away.",
                    count(more as u64 + 1)
                ),
            };
            page.gap();
            page.paragraph("", "", &words);
        }
        page.text()
    }

    fn introduce(&self, page: &mut Page) {
        let Self {
            robot,
            frame,
            trial,
            scenario,
            at_s,
            bytes,
            ..
        } = self;
        let words = format!(
            "Robot {robot} said frame {frame} at {at_s:.3} s in trial {trial} of {scenario}: {}, headers included.",
            plural(*bytes, "byte")
        );
        page.paragraph("", "", &words);
        for message in &self.messages {
            let to = message.to.map_or_else(String::new, |to| format!(" to robot {to}"));
            let content = message
                .content
                .as_ref()
                .map_or_else(String::new, |content| format!(": {content}"));
            let length = plural(message.payload_bytes.into(), "byte");
            page.paragraph(
                "",
                "",
                &format!("{}{to}, {length}{content}.", capitalised(message.topic)),
            );
        }
        if let (Some(attempts), Some(outcome)) = (self.attempts, self.outcome) {
            let began = self.began_s.map_or_else(
                || "It never went on air".to_owned(),
                |began| format!("It went on air at {began:.6} s, {} in all", times(attempts)),
            );
            let ended = match outcome {
                "sent" => String::new(),
                "acknowledged" => ", and was acknowledged".to_owned(),
                "unacknowledged" => ", and was never acknowledged".to_owned(),
                cause => format!(": {}", cause.replace('_', " ")),
            };
            page.paragraph("", "", &format!("{began}{ended}."));
        }
        let of = |fate: Fate| self.copies.iter().filter(|copy| copy.fate == fate.name()).count() as u64;
        let offered = self.copies.len() as u64 - of(Fate::Strayed);
        let copies = match offered {
            0 => "It was offered to nobody.".to_owned(),
            _ => format!("{} of {} arrived.", count(of(Fate::Delivered)), plural_copies(offered)),
        };
        page.paragraph("", "", &copies);
    }

    fn list(&self, page: &mut Page) {
        if self.copies.is_empty() {
            return;
        }
        page.gap();
        let several = self.messages.len() > 1;
        let powers = self.copies.iter().any(|copy| copy.power_dbm.is_some());
        let mut head = vec!["robot", "away", "what became of it", "at", "read at"];
        let mut columns = vec![
            Column::Figures,
            Column::Figures,
            Column::Words,
            Column::Figures,
            Column::Figures,
        ];
        if powers {
            head.push("power");
            columns.push(Column::Figures);
        }
        if several {
            head.push("topic");
            columns.push(Column::Words);
        }
        let mut list = Grid::new(&columns, head);
        let time = |at: Option<f64>| at.map_or_else(|| NOTHING.to_owned(), |at| format!("{at:.3} s"));
        for copy in &self.copies {
            let became = match (copy.fate, copy.cause) {
                (_, Some(cause)) => format!("lost: {}", cause.replace('_', " ")),
                ("in_flight", None) => "under way at the end".to_owned(),
                ("strayed", None) => "arrived, though out of range".to_owned(),
                (fate, None) => fate.to_owned(),
            };
            let mut row = vec![
                copy.receiver.to_string(),
                format!("{:.2} m", copy.distance_m),
                became,
                time(copy.at_s),
                time(copy.read_s),
            ];
            if powers {
                row.push(
                    copy.power_dbm
                        .map_or_else(|| NOTHING.to_owned(), |power| format!("{power:.1} dBm")),
                );
            }
            if several {
                row.push(copy.topic.to_owned());
            }
            list.row(row);
        }
        page.table(&list);
    }
}

fn plural(number: u64, what: &str) -> String {
    match number {
        1 => format!("1 {what}"),
        number => format!("{} {what}s", count(number)),
    }
}

fn plural_copies(number: u64) -> String {
    match number {
        1 => "1 copy".to_owned(),
        number => format!("{} copies", count(number)),
    }
}

fn times(number: u32) -> String {
    match number {
        1 => "once".to_owned(),
        number => format!("{} times", count(number.into())),
    }
}

fn capitalised(words: &str) -> String {
    let mut letters = words.chars();
    letters
        .next()
        .map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
