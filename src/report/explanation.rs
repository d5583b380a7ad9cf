//! Why a robot was suspected: each status that it sent meanwhile and what became of it.

mod tell;

use serde::Serialize;

use crate::engine::{ActorId, SimTime};
use crate::metrics::detection::{self, CopyFate, StatusTrace, Suspicion};
use crate::metrics::{FaultEpisode, FaultKind, TrialRecord};

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
    /// What to make of it: a name of [`Verdict`](detection::Verdict).
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
        /// Why: a name of [`LossCause`](crate::radio::LossCause).
        cause: &'static str,
    },
    /// The observer was out of range.
    OutOfRange,
    /// It was still under way when the observer came to suspect the robot, or when the trial ended.
    UnderWay {
        /// When it was to arrive.
        arrives_s: f64,
        /// Why it was lost on its arrival, if it was: a name of [`LossCause`](crate::radio::LossCause).
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
                .map(|(number, suspicion)| explain(number, &suspicion, trace))
                .collect(),
        })
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
