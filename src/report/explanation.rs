//! Why a robot was suspected, in words and times: each status that it sent meanwhile and what became of it.

use serde::Serialize;

use super::grid::{Column, Grid};
use super::layout::Page;
use super::number::count;
use crate::engine::{ActorId, SimTime};
use crate::metrics::detection::{self, CopyFate, StatusTrace, Suspicion, Verdict};
use crate::metrics::{FaultEpisode, FaultKind, TrialRecord};
use crate::radio::LossCause;
use crate::text::Style;

/// What a line on statuses begins with that goes on with the one before.
const GOES_ON: &str = "     ";

/// Why one robot was suspected in one trial.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explanation {
    /// The scenario's name.
    pub scenario: String,
    /// Number of the trial.
    pub trial: u32,
    /// The robot.
    pub robot: u32,
    /// What the robots' failure detector went by, in a sentence, where that needs words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rule: Option<String>,
    /// When it failed.
    pub outages: Vec<Outage>,
    /// When it was suspected, in order of time.
    pub suspicions: Vec<Explained>,
}

/// A failure of the robot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outage {
    /// What it could not do.
    pub effect: &'static str,
    /// Since when, seconds.
    pub from_s: f64,
    /// Until when, seconds; `None` to the end of the trial.
    pub until_s: Option<f64>,
}

/// One suspicion of the robot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explained {
    /// Its number among those of the robot, from 1.
    pub number: usize,
    /// Who suspected the robot.
    pub observer: u32,
    /// When, seconds.
    pub suspected_s: f64,
    /// When the last status of the robot had arrived, seconds.
    pub heard_s: f64,
    /// When the observer trusted the robot again, seconds.
    pub trusted_s: Option<f64>,
    /// When it ceased to count as a mistake without trust, seconds: one of the two failed or left the other's range, or the trial ended.
    pub cut_off_s: Option<f64>,
    /// What to make of it: a name of [`Verdict`].
    pub verdict: &'static str,
    /// What it was due to: a name of [`detection::Cause`].
    pub cause: &'static str,
    /// The statuses that the robot sent since the newest that had arrived.
    pub statuses: Vec<Status>,
    /// The status that made the observer trust the robot again.
    pub restored_by: Option<Status>,
}

/// A status of the robot and what became of it at the observer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Status {
    /// Its number among the robot's frames.
    pub sequence: u32,
    /// When it was sent, seconds.
    pub sent_s: f64,
    /// How far the observer was then, metres.
    pub distance_m: f32,
    /// What became of it.
    #[serde(flatten)]
    pub fate: Fate,
}

/// What became of a status at one observer, times in seconds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "fate", rename_all = "snake_case")]
pub enum Fate {
    /// It was lost.
    Lost {
        /// Why: a name of [`LossCause`].
        cause: &'static str,
    },
    /// The observer was out of range.
    OutOfRange,
    /// It was still under way when the observer came to suspect the robot, or when the trial ended.
    UnderWay {
        /// When it was to arrive.
        arrives_s: f64,
        /// Why it was lost on its arrival, if it was: a name of [`LossCause`].
        lost: Option<&'static str>,
    },
    /// It arrived.
    Arrived {
        /// When.
        arrived_s: f64,
        /// When the observer woke and read it.
        read_s: Option<f64>,
    },
}

impl Explanation {
    /// Explains every suspicion of the robot that `record` has traced; `None` if it has traced none.
    #[must_use]
    pub fn of(scenario: &str, record: &TrialRecord) -> Option<Self> {
        let trace = record.trace.as_ref()?;
        let all = record.detection.suspicions.iter();
        let of_robot = all.filter(|suspicion| suspicion.subject == trace.robot);
        let suspicions = (1..).zip(of_robot);
        Some(Self {
            scenario: scenario.to_owned(),
            trial: record.trial,
            robot: trace.robot.0,
            rule: None,
            outages: record
                .faults
                .iter()
                .filter_map(|episode| outage(trace.robot, episode))
                .collect(),
            suspicions: suspicions
                .map(|(number, suspicion)| explain(number, suspicion, trace))
                .collect(),
        })
    }

    /// The explanation as text: a list, then a section a suspicion. With a `chosen` one, its
    /// section alone, and every status on a line of its own.
    #[must_use]
    pub fn text(&self, chosen: Option<usize>, style: Style) -> String {
        let mut page = Page::new(style);
        self.introduce(&mut page);
        match chosen.and_then(|number| self.suspicions.get(number.checked_sub(1)?)) {
            Some(suspicion) => self.tell(suspicion, true, &mut page),
            None => {
                self.list(&mut page);
                self.suspicions
                    .iter()
                    .for_each(|suspicion| self.tell(suspicion, false, &mut page));
            }
        }
        page.text()
    }

    fn introduce(&self, page: &mut Page) {
        let times = match self.suspicions.len() {
            0 => "was never suspected".to_owned(),
            1 => "was suspected once".to_owned(),
            times => format!("was suspected {} times", count(times as u64)),
        };
        let Self {
            robot, trial, scenario, ..
        } = self;
        page.paragraph(
            "",
            "",
            &format!("Robot {robot} {times} in trial {trial} of {scenario}."),
        );
        if let Some(rule) = &self.rule {
            page.paragraph("", "", rule);
        }
        for outage in &self.outages {
            let until = outage
                .until_s
                .map_or_else(|| "to the end".to_owned(), |until| format!("to {until:.3} s"));
            let words = format!("It failed ({}) from {:.3} s {until}.", outage.effect, outage.from_s);
            page.paragraph("", "", &words);
        }
    }

    fn list(&self, page: &mut Page) {
        if self.suspicions.is_empty() {
            return;
        }
        page.gap();
        let [words, figures] = [Column::Words, Column::Figures];
        let columns = [figures, figures, figures, figures, words, words];
        let mut list = Grid::new(&columns, ["N", "by robot", "suspected", "trusted", "verdict", "cause"]);
        for suspicion in &self.suspicions {
            let trusted = suspicion
                .trusted_s
                .map_or_else(|| "never".to_owned(), |at| format!("{at:.3} s"));
            list.row([
                suspicion.number.to_string(),
                suspicion.observer.to_string(),
                format!("{:.3} s", suspicion.suspected_s),
                trusted,
                spaced(suspicion.verdict),
                spaced(suspicion.cause),
            ]);
        }
        page.table(&list);
    }

    fn tell(&self, suspicion: &Explained, singly: bool, page: &mut Page) {
        let Explained {
            number,
            observer,
            suspected_s,
            heard_s,
            statuses,
            ..
        } = suspicion;
        let robot = self.robot;
        page.gap();
        let judged = judgement(suspicion.verdict);
        let title = format!("{number}. Robot {observer} suspected robot {robot} at {suspected_s:.3} s: {judged}.");
        page.paragraph("", "", &title);
        let silence = suspected_s - heard_s;
        let sent = match statuses.len() {
            0 => format!("robot {robot} sent no status"),
            1 => format!("robot {robot} sent one status"),
            many => format!("robot {robot} sent {} statuses", count(many as u64)),
        };
        let words = format!(
            "The last status to arrive had done so at {heard_s:.3} s. In the {silence:.3} s since then, none arrived, though {sent}."
        );
        let words = if suspicion.cause == detection::Cause::Unanswered.name() {
            format!(
                "It went by probes, which were not answered in time, or by what others said of them. The last frame had arrived at {heard_s:.3} s; in the {silence:.3} s since then, {sent}."
            )
        } else if statuses.is_empty() {
            words.replace(", though", ":")
        } else {
            words
        };
        page.paragraph("   ", "   ", &words);
        let size = if singly { 1 } else { usize::MAX };
        for alike in statuses.chunk_by(|a, b| a.fate.is_like(b.fate)) {
            alike.chunks(size).for_each(|group| tell_alike(group, page));
        }
        if let Some(at) = suspicion.cut_off_s {
            let words = format!(
                "It counts as a mistake until {at:.3} s, when one of the two failed, they parted or the trial ended."
            );
            page.paragraph("   ", "   ", &words);
        }
        let end = match (suspicion.trusted_s, &suspicion.restored_by) {
            (Some(at), Some(status)) => format!(
                "Robot {observer} trusted it again at {at:.3} s, when it read the status sent at {:.3} s{}.",
                status.sent_s,
                match status.fate {
                    Fate::Arrived { arrived_s, .. } => format!(", which had arrived at {arrived_s:.3} s"),
                    _ => String::new(),
                }
            ),
            (Some(at), None) => format!("Robot {observer} trusted it again at {at:.3} s."),
            (None, _) => format!("Robot {observer} did not hear it again."),
        };
        page.paragraph("   ", "   ", &end);
    }
}

fn outage(robot: ActorId, episode: &FaultEpisode) -> Option<Outage> {
    match episode.kind {
        FaultKind::Robot {
            robot: failed, effect, ..
        } if failed == robot => Some(Outage {
            effect: effect.name(),
            from_s: episode.from.as_secs(),
            until_s: episode.until.map(SimTime::as_secs),
        }),
        FaultKind::Robot { .. } | FaultKind::Partition | FaultKind::Burst => None,
    }
}

fn explain(number: usize, suspicion: &Suspicion, trace: &StatusTrace) -> Explained {
    let Suspicion {
        observer, at, sequence, ..
    } = *suspicion;
    let is_newer = |status: &&detection::Status| status.sequence.wrapping_sub(sequence).cast_signed() > 0;
    let missed = trace
        .statuses
        .iter()
        .filter(is_newer)
        .filter(|status| status.sent_at < at);
    let restoring = |trusted: SimTime| {
        let copies = trace.statuses.iter().filter(|status| {
            let read = status.copy_for(observer).and_then(|copy| copy.read);
            read == Some(trusted)
        });
        let arrival = |status: &&detection::Status| match status.copy_for(observer).map(|copy| copy.fate) {
            Some(CopyFate::Arrives(at)) => at,
            _ => SimTime::NEVER,
        };
        copies.min_by_key(arrival)
    };
    Explained {
        number,
        observer: observer.0,
        suspected_s: at.as_secs(),
        heard_s: suspicion.heard.as_secs(),
        trusted_s: suspicion.until.map(SimTime::as_secs),
        cut_off_s: suspicion
            .duration
            .filter(|_| suspicion.cut_off)
            .map(|duration| (at + duration).as_secs()),
        verdict: suspicion.verdict().name(),
        cause: suspicion.cause.name(),
        statuses: missed.map(|status| status_at(observer, status, at)).collect(),
        restored_by: suspicion
            .until
            .and_then(|trusted| Some(status_at(observer, restoring(trusted)?, trusted))),
    }
}

/// What has become of `status` at `observer` by `now`.
fn status_at(observer: ActorId, status: &detection::Status, now: SimTime) -> Status {
    let fate = match status.copy_for(observer) {
        None => Fate::OutOfRange,
        Some(copy) => match (copy.due, copy.fate) {
            (Some(at), fate) if at > now => Fate::UnderWay {
                arrives_s: at.as_secs(),
                lost: match fate {
                    CopyFate::Lost(cause) => Some(cause.name()),
                    CopyFate::Arrives(_) => None,
                },
            },
            (_, CopyFate::Lost(cause)) => Fate::Lost { cause: cause.name() },
            (_, CopyFate::Arrives(at)) => Fate::Arrived {
                arrived_s: at.as_secs(),
                read_s: copy.read.map(SimTime::as_secs),
            },
        },
    };
    Status {
        sequence: status.sequence,
        sent_s: status.sent_at.as_secs(),
        distance_m: status.distances.get(observer.index()).copied().unwrap_or(f32::NAN),
        fate,
    }
}

impl Fate {
    /// Whether one line can tell of both.
    fn is_like(self, other: Self) -> bool {
        match (self, other) {
            (Self::Lost { cause }, Self::Lost { cause: other }) => cause == other,
            (Self::OutOfRange, Self::OutOfRange) => true,
            _ => false,
        }
    }
}

/// A line on statuses in a row that met the same fate.
fn tell_alike(group: &[Status], page: &mut Page) {
    let [first, .., last] = group else {
        for status in group {
            tell_one(status, page);
        }
        return;
    };
    let range = |of: fn(f32, f32) -> f32| {
        group
            .iter()
            .map(|status| status.distance_m)
            .reduce(of)
            .unwrap_or(f32::NAN)
    };
    let far = format!("{:.3} to {:.3} m", range(f32::min), range(f32::max));
    let what = fate(first, &format!("out of range, {far} away"));
    let sent = format!("{:.3} to {:.3} s", first.sent_s, last.sent_s);
    page.paragraph(&format!("   {sent:>24}  {:>4} statuses ", group.len()), GOES_ON, &what);
}

fn tell_one(status: &Status, page: &mut Page) {
    let what = fate(status, &format!("out of range, {:.3} m away", status.distance_m));
    page.paragraph(&format!("   {:>22.3} s       status ", status.sent_s), GOES_ON, &what);
}

fn fate(status: &Status, out_of_range: &str) -> String {
    match status.fate {
        Fate::Lost { cause } => loss(cause).to_owned(),
        Fate::OutOfRange => out_of_range.to_owned(),
        Fate::UnderWay { arrives_s, lost: None } => format!("under way until {arrives_s:.3} s"),
        Fate::UnderWay {
            arrives_s,
            lost: Some(cause),
        } => format!("under way until {arrives_s:.3} s, then {}", loss(cause)),
        Fate::Arrived {
            arrived_s,
            read_s: None,
        } => format!("arrived {arrived_s:.3} s, never read"),
        Fate::Arrived {
            arrived_s,
            read_s: Some(read_s),
        } => format!("arrived {arrived_s:.3} s, read {read_s:.3} s"),
    }
}

fn loss(cause: &str) -> &str {
    match cause {
        _ if cause == LossCause::Channel.name() => "lost in the channel",
        _ if cause == LossCause::LinkFault.name() => "stopped by a fault of the link",
        _ if cause == LossCause::ReceiverDown.name() => "lost: the receiver was down",
        _ if cause == LossCause::BelowSensitivity.name() => "sent to it alone, and out of range",
        other => other,
    }
}

fn judgement(verdict: &str) -> &'static str {
    match verdict {
        _ if verdict == Verdict::Right.name() => "rightly, for it could not send",
        _ if verdict == Verdict::OutOfRange.name() => "it was well, but not within range all the while",
        _ if verdict == Verdict::Observer.name() => "it was well, but the observer could not hear",
        _ => "a mistake",
    }
}

fn spaced(name: &str) -> String {
    name.replace('_', " ")
}
