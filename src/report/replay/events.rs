//! What happened, told one by one: faults, suspicions with what they were due to, the end.

use std::collections::BTreeMap;

use serde::Serialize;

use super::changes::Change;
use crate::engine::Span;
use crate::metrics::detection::{Cause, Suspicion, Verdict};
use crate::metrics::{FaultKind, Outcome, TrialRecord};
use crate::protocol::Layout;
use crate::radio::LossCause;

/// A suspicion so new may be why a robot changes its role.
const LATELY: Span = Span::from_nanos(5_000_000_000);
/// So many a page lists.
const MOST_EVENTS: usize = 20_000;

/// A happening.
#[derive(Debug, Serialize)]
pub struct Event {
    pub t: f64,
    pub kind: &'static str,
    pub robot: Option<u32>,
    pub by: Option<u32>,
    pub until: Option<f64>,
    pub title: String,
    pub detail: Vec<String>,
}

/// A robot that was not well.
#[derive(Debug, Serialize)]
pub struct Fault {
    pub robot: u32,
    pub from: f64,
    pub to: Option<f64>,
    pub what: &'static str,
}

/// Robots that were not well, and since when until when.
pub fn faults(record: &TrialRecord) -> Vec<Fault> {
    let of_robots = record.faults.iter().filter_map(|episode| match episode.kind {
        FaultKind::Robot { robot, effect, .. } => Some(Fault {
            robot: robot.0,
            from: episode.from.as_secs(),
            to: episode.until.map(crate::engine::SimTime::as_secs),
            what: effect.name(),
        }),
        FaultKind::Partition | FaultKind::Burst => None,
    });
    of_robots.collect()
}

/// What events are told of, and in which words.
pub struct Told<'a> {
    pub record: &'a TrialRecord,
    /// What the command calls the results.
    pub folder: &'a str,
    pub roles: &'a [&'static str],
    pub topics: &'a [&'static str],
    pub layout: &'a Layout,
}

impl Told<'_> {
    /// All that happened, in order of time, and how many of it there was no room for.
    pub fn events(&self, roles: &[Change]) -> (Vec<Event>, u64) {
        let (mut events, mut left_out) = events(self.record, self.folder);
        let begun = roles.iter().filter(|change| change.from != change.to);
        events.extend(begun.clone().take(MOST_EVENTS).map(|change| self.change(change)));
        left_out += begun.count().saturating_sub(MOST_EVENTS) as u64;
        events.sort_by(|a, b| a.t.total_cmp(&b.t));
        (events, left_out)
    }

    /// A change of role, with what led to it as far as that is known.
    fn change(&self, change: &Change) -> Event {
        let Change { at, robot, .. } = change;
        let role = |number: u8| self.roles.get(usize::from(number)).copied().unwrap_or("unknown");
        let mut detail = Vec::new();
        if !change.relied.is_empty() {
            let mut relied: Vec<String> = change.relied.iter().map(ToString::to_string).collect();
            relied.dedup();
            detail.push(format!("relied on {} until then", relied.join(", ")));
        }
        for read in &change.read {
            if let Some(content) = read.to(*robot, self.layout) {
                let topic = self.topics.get(usize::from(read.topic.0)).copied().unwrap_or("unknown");
                detail.push(format!("had just read from {}: {topic}, {content}", read.sender));
            }
        }
        let suspicions = self.record.detection.suspicions.iter();
        let held = suspicions.filter(|suspicion| {
            suspicion.observer == *robot && suspicion.at <= *at && suspicion.until.is_none_or(|until| *at < until)
        });
        for suspicion in held {
            let relied = change.relied.contains(&suspicion.subject);
            // Of others only those that are new: what a robot has believed for long leads to nothing now.
            if relied || at.since(suspicion.at) <= LATELY {
                let on_which = if relied { ", on which it relied," } else { "" };
                detail.push(format!(
                    "suspected {}{on_which} since {:.3} s",
                    suspicion.subject,
                    suspicion.at.as_secs()
                ));
            }
        }
        let title = format!("{robot}: {} → {}", role(change.from), role(change.to));
        Event {
            detail,
            ..Event::plain(at.as_secs(), "role", Some(robot.0), title)
        }
    }
}

/// Faults, suspicions and the end.
fn events(record: &TrialRecord, folder: &str) -> (Vec<Event>, u64) {
    let mut events: Vec<Event> = Vec::new();
    for episode in &record.faults {
        let (robot, what) = match episode.kind {
            FaultKind::Robot { robot, effect, .. } => (Some(robot.0), format!("{robot} fails: {}", effect.name())),
            FaultKind::Partition => (None, "the swarm is partitioned".to_owned()),
            FaultKind::Burst => (None, "links lose bursts".to_owned()),
        };
        let until = episode.until.map(crate::engine::SimTime::as_secs);
        events.push(Event::plain(episode.from.as_secs(), "fault", robot, what));
        if let Some(until) = until {
            let what = match robot {
                Some(robot) => format!("{robot} is well again"),
                None => "links are well again".to_owned(),
            };
            events.push(Event::plain(until, "recovery", robot, what));
        }
    }
    let mut numbers: BTreeMap<u32, usize> = BTreeMap::new();
    let mut left_out = 0;
    for suspicion in &record.detection.suspicions {
        let number = numbers.entry(suspicion.subject.0).or_default();
        *number += 1;
        if events.len() < MOST_EVENTS {
            suspected(&suspicion, *number, record.trial, folder, &mut events);
        } else {
            left_out += 1;
        }
    }
    let end = record.simulated.as_secs();
    let done = match record.outcome {
        Outcome::Completed { step } => {
            let at = step as f64 * record.control_period.as_secs();
            Some(Event::plain(
                at.min(end),
                "done",
                None,
                "the mission is complete".to_owned(),
            ))
        }
        Outcome::Censored => Some(Event::plain(
            end,
            "note",
            None,
            "the time is over, the mission incomplete".to_owned(),
        )),
        Outcome::NoMission => None,
    };
    events.extend(done);
    (events, left_out)
}

fn suspected(suspicion: &Suspicion, number: usize, trial: u32, folder: &str, into: &mut Vec<Event>) {
    let (observer, subject) = (suspicion.observer.0, suspicion.subject.0);
    let until = suspicion.until.map(crate::engine::SimTime::as_secs);
    let verdict = match suspicion.verdict() {
        Verdict::Right => "right",
        Verdict::Mistake => "a mistake",
        Verdict::OutOfRange => "out of range",
        Verdict::Observer => "the observer was deaf",
    };
    let cause = suspicion.cause.name().replace('_', " ");
    let mut detail = vec![
        if verdict == cause {
            cause
        } else {
            format!("{verdict}: {cause}")
        },
        format!("last heard at {:.3} s", suspicion.heard.as_secs()),
    ];
    detail.extend(missed(suspicion));
    if let Some(until) = until {
        detail.push(format!("trusted again at {until:.3} s"));
    }
    detail.push(format!(
        "desim explain {folder} --trial {trial} --robot {subject} --suspicion {number}"
    ));
    into.push(Event {
        by: Some(observer),
        until,
        detail,
        ..Event::plain(
            suspicion.at.as_secs(),
            "suspicion",
            Some(subject),
            format!("{observer} suspects {subject}"),
        )
    });
    if let Some(until) = until {
        into.push(Event {
            by: Some(observer),
            ..Event::plain(
                until,
                "trust",
                Some(subject),
                format!("{observer} trusts {subject} again"),
            )
        });
    }
}

/// What became of the messages that the observer should have heard.
fn missed(suspicion: &Suspicion) -> Option<String> {
    let missed = &suspicion.missed;
    let lost = LossCause::ALL.into_iter().map(Cause::Lost).zip(missed.lost);
    let rest = [
        (Cause::OutOfRange, missed.out_of_range),
        (Cause::Latency, missed.under_way),
    ];
    let parts: Vec<(Cause, u32)> = lost.chain(rest).filter(|(_, count)| *count > 0).collect();
    let total: u32 = parts.iter().map(|(_, count)| count).sum();
    let words: Vec<String> = parts
        .iter()
        .map(|(cause, count)| match cause {
            Cause::Lost(cause) => format!("{count} lost to {}", cause.name().replace('_', " ")),
            Cause::OutOfRange => format!("{count} sent out of range"),
            _ => format!("{count} under way"),
        })
        .collect();
    let noun = if total == 1 { "status" } else { "statuses" };
    (total > 0).then(|| format!("{total} {noun} missed: {}", words.join(", ")))
}

impl Event {
    fn plain(t: f64, kind: &'static str, robot: Option<u32>, title: String) -> Self {
        Self {
            t,
            kind,
            robot,
            by: None,
            until: None,
            title,
            detail: Vec::new(),
        }
    }
}
