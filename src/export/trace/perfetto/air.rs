//! Frames and copies as slices.

use serde_json::{Map, Value, json};

use super::super::context::Run;
use super::tracks::{INSTANT, Kind, Owner, Slice};
use crate::engine::{SimTime, Span};
use crate::happenings::log::{CopyRecord, Fate, Frame};
use crate::radio::{LossCause, Phy};

/// A frame to be drawn.
#[derive(Debug)]
pub struct Said {
    /// From when on.
    pub begin: SimTime,
    /// How long.
    pub lasts: Span,
    /// The number of the arrows to its copies, if any are drawn.
    pub arrow: Option<u64>,
    owner: Owner,
    name: String,
    args: Value,
}

impl Said {
    /// That of `frame`: while its radio had it on air for the first time, over one whose frames take time as `phy` says; else when it was handed over.
    pub fn of(run: &Run, phy: Option<&Phy>, frame: &Frame) -> Self {
        let began = frame.sending.and_then(|sending| sending.began);
        let bytes = run.bytes(frame.messages.len(), frame.payloads.len());
        let payload = bytes - u64::from(run.frame_header);
        let lasts = match (began, phy) {
            (Some(_), Some(phy)) => phy.airtime(payload as u32).max(INSTANT),
            _ => INSTANT,
        };
        let topic = run.topic(frame.messages[0].topic.0);
        let name = match frame.messages.len() {
            1 => topic.to_owned(),
            several => format!("{topic} +{}", several - 1),
        };
        Self {
            begin: began.unwrap_or(frame.at),
            lasts,
            arrow: None,
            owner: Owner::Robot(frame.sender),
            name,
            args: Value::Object(frame_arguments(frame, bytes)),
        }
    }

    /// The slice.
    pub fn slice(&mut self) -> Slice<'_> {
        Slice {
            owner: self.owner,
            kind: Kind::Says,
            name: &self.name,
            args: self.args.take(),
        }
    }
}

fn frame_arguments(frame: &Frame, bytes: u64) -> Map<String, Value> {
    let mut arguments = Map::new();
    let mut say = |name: &str, value: Value| arguments.insert(name.to_owned(), value);
    say("frame", json!(frame.number));
    if let Some(to) = frame.to() {
        say("to", json!(to.0));
    }
    say("bytes", json!(bytes));
    say("offered", json!(frame.offered));
    say("delivered", json!(frame.delivered));
    for (cause, &copies) in LossCause::ALL.iter().zip(&frame.lost) {
        if copies > 0 {
            say(&format!("lost: {}", cause.name().replace('_', " ")), json!(copies));
        }
    }
    if let Some(sending) = frame.sending {
        say("handed_over_s", json!(frame.at.as_secs()));
        say("attempts", json!(sending.attempts));
        say("outcome", json!(sending.outcome.name()));
    }
    arguments
}

/// A copy to be drawn.
#[derive(Debug)]
pub struct Reached {
    /// What is known of it.
    pub record: CopyRecord,
    /// The number of the arrow that leads to it: that of its frame.
    pub arrow: Option<u64>,
}

impl Reached {
    /// When it arrived or was lost; `None` of those that are under way at the end.
    pub fn at(record: &CopyRecord) -> Option<SimTime> {
        record.at.filter(|_| record.fate != Fate::InFlight)
    }

    /// What is written on it.
    pub fn name(&self, run: &Run) -> String {
        let topic = run.topic(self.record.copy.topic.0);
        match self.record.fate.cause() {
            Some(cause) => format!("{topic} lost: {}", cause.name().replace('_', " ")),
            None => topic.to_owned(),
        }
    }

    /// The slice, with that name.
    pub fn slice<'a>(&self, name: &'a str) -> Slice<'a> {
        let CopyRecord { copy, frame, fate, .. } = self.record;
        let mut args = json!({ "fate": fate.name(), "from": copy.sender.0, "frame": frame });
        if let Some(power) = self.record.power {
            args["power_dbm"] = json!(power);
        }
        Slice {
            owner: Owner::Robot(copy.receiver),
            kind: Kind::Hears,
            name,
            args,
        }
    }
}
