//! What the failure detectors of one trial did.

use serde::{Deserialize, Serialize};

use crate::engine::{ActorId, SimTime, Span};
use crate::radio::LossCause;
use crate::spool::{Entry, Spool, entry};

/// What the failure detectors of one trial did, held against the truth.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DetectionRecord {
    /// Pairs of an observer and a subject that it read a status of.
    pub pairs: u64,
    /// Monitored time, summed over pairs, seconds.
    pub monitored_s: f64,
    /// The part of it that pairs spent in a mistake, seconds.
    pub mistaken_s: f64,
    /// Every suspicion, in order of time.
    pub suspicions: Spool<Suspicion>,
    /// Every failure of a robot to send, once for each observer that monitored it then, in order of time.
    pub failures: Spool<ObservedFailure>,
}

/// An observer came to believe that a subject is down.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Suspicion {
    /// Who suspects.
    pub observer: ActorId,
    /// Whom.
    pub subject: ActorId,
    /// Since when.
    pub at: SimTime,
    /// When the subject's last status had arrived; its last frame, where the observer's detector probes.
    pub heard: SimTime,
    /// The newest of the subject's frames that had arrived, by its number among them.
    pub sequence: u32,
    /// When the observer trusted the subject again; `None` if it never did.
    pub until: Option<SimTime>,
    /// Whether the subject could not send at that instant.
    pub subject_down: bool,
    /// What it was due to.
    pub cause: Cause,
    /// What became of the statuses that the observer should have heard.
    pub missed: Missed,
    /// How long a mistake lasted: until trust, or until it was cut off. `None` of what is no mistake.
    pub duration: Option<Span>,
    /// Whether a mistake was cut off before it could end in trust: by the end of the run, by a failure of the subject or of the
    /// observer, or because the pair was no longer within range. It would have lasted longer.
    pub cut_off: bool,
}

impl Suspicion {
    /// What to make of it.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        match self.cause {
            _ if self.subject_down => Verdict::Right,
            Cause::OutOfRange | Cause::Lost(LossCause::BelowSensitivity) => Verdict::OutOfRange,
            Cause::Lost(LossCause::ReceiverDown) => Verdict::Observer,
            _ => Verdict::Mistake,
        }
    }
}

/// What to make of a suspicion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// The subject could not send.
    Right,
    /// The subject was well and so was the way to it: the detector erred.
    Mistake,
    /// The subject was well and out of range, or had just been.
    OutOfRange,
    /// The observer could not hear.
    Observer,
}

impl Verdict {
    /// Every verdict.
    pub const ALL: [Self; 4] = [Self::Right, Self::Mistake, Self::OutOfRange, Self::Observer];

    /// The name that tables use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Mistake => "mistake",
            Self::OutOfRange => "out_of_range",
            Self::Observer => "observer",
        }
    }
}

/// What a suspicion was due to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Cause {
    /// The subject could not send: at that instant, or for more than half of the silence.
    Failure,
    /// Most of the statuses missed were lost for this reason.
    Lost(LossCause),
    /// The two were out of range of each other at that instant, or at some time while the detector waited; or most of the statuses
    /// missed were sent while they were.
    OutOfRange,
    /// Most of them were still under way.
    Latency,
    /// The subject sent none.
    NotSent,
    /// The subject was within range, but probes of it went unanswered, as far as the observer could know.
    Unanswered,
}

impl Cause {
    /// Every cause, in the order in which reports name them.
    pub const ALL: [Self; LossCause::ALL.len() + 5] = {
        let mut all = [Self::Failure; LossCause::ALL.len() + 5];
        let mut cause = 0;
        while cause < LossCause::ALL.len() {
            all[cause + 1] = Self::Lost(LossCause::ALL[cause]);
            cause += 1;
        }
        all[cause + 1] = Self::OutOfRange;
        all[cause + 2] = Self::Latency;
        all[cause + 3] = Self::NotSent;
        all[cause + 4] = Self::Unanswered;
        all
    };

    /// The name that reports and tables use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Failure => "failure",
            Self::Lost(cause) => cause.name(),
            Self::OutOfRange => "out_of_range",
            Self::Latency => "latency",
            Self::NotSent => "not_sent",
            Self::Unanswered => "unanswered",
        }
    }
}

/// What became of the statuses that a subject sent after the newest that arrived and before it was suspected.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Missed {
    /// Lost on the way, by cause in the order of [`LossCause::ALL`].
    pub lost: [u32; LossCause::ALL.len()],
    /// Sent while the observer was out of range.
    pub out_of_range: u32,
    /// Still under way.
    pub under_way: u32,
}

impl Missed {
    /// What most of them suffered; of equals, losses come first, in the order of [`LossCause::ALL`], then the range.
    #[must_use]
    pub fn cause(&self) -> Cause {
        let lost = LossCause::ALL.into_iter().map(Cause::Lost).zip(self.lost);
        let rest = [(Cause::OutOfRange, self.out_of_range), (Cause::Latency, self.under_way)];
        lost.chain(rest)
            .fold(
                (Cause::NotSent, 0),
                |most, next| if next.1 > most.1 { next } else { most },
            )
            .0
    }
}

/// A robot failed to send, as one observer that monitored it then saw it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ObservedFailure {
    /// Who failed.
    pub subject: ActorId,
    /// Who watched it.
    pub observer: ActorId,
    /// When it failed.
    pub at: SimTime,
    /// What the observer made of it.
    pub outcome: FailureOutcome,
    /// How long it was watched: until it was detected, else until the robot was well again, the observer could hear no more, or
    /// the run ended.
    pub watched: Span,
}

/// What an observer made of a failure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum FailureOutcome {
    /// It suspected the robot for good after so long: zero if it did already.
    Detected(Span),
    /// The robot was well again before the observer suspected it.
    Recovered,
    /// The observer could hear no more before it suspected the robot.
    ObserverFailed,
    /// The run ended first.
    Undetected,
}

impl FailureOutcome {
    /// The name that tables use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Detected(_) => "detected",
            Self::Recovered => "recovered",
            Self::ObserverFailed => "observer_failed",
            Self::Undetected => "undetected",
        }
    }
}

entry! {
    Suspicion { observer, subject, at, heard, sequence, until, subject_down, cause, missed, duration, cut_off }
    Missed { lost, out_of_range, under_way }
    ObservedFailure { subject, observer, at, outcome, watched }
}

impl Entry for Cause {
    fn put(&self, into: &mut Vec<u8>) {
        let place = Self::ALL.iter().position(|cause| cause == self);
        place.map_or(u8::MAX, |place| place as u8).put(into);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        Self::ALL.get(usize::from(u8::take(from)?)).copied()
    }
}

impl Entry for FailureOutcome {
    fn put(&self, into: &mut Vec<u8>) {
        let (kind, after) = match *self {
            Self::Detected(after) => (0_u8, after),
            Self::Recovered => (1, Span::ZERO),
            Self::ObserverFailed => (2, Span::ZERO),
            Self::Undetected => (3, Span::ZERO),
        };
        (kind, after).put(into);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        let (kind, after) = <(u8, Span)>::take(from)?;
        [
            Self::Detected(after),
            Self::Recovered,
            Self::ObserverFailed,
            Self::Undetected,
        ]
        .get(usize::from(kind))
        .copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn missed(channel: u32, out_of_range: u32, under_way: u32) -> Missed {
        let mut missed = Missed {
            out_of_range,
            under_way,
            ..Missed::default()
        };
        missed.lost[LossCause::Channel as usize] = channel;
        missed
    }

    #[test]
    fn the_cause_is_what_most_statuses_suffered_and_a_loss_before_its_equals() {
        assert_eq!(missed(0, 0, 0).cause(), Cause::NotSent);
        assert_eq!(missed(2, 3, 1).cause(), Cause::OutOfRange);
        assert_eq!(missed(2, 1, 3).cause(), Cause::Latency);
        assert_eq!(missed(2, 2, 2).cause(), Cause::Lost(LossCause::Channel));
    }

    #[test]
    fn every_cause_is_listed_once_under_a_name_of_its_own() {
        let mut names = Cause::ALL.map(Cause::name).to_vec();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), Cause::ALL.len());
    }
}
