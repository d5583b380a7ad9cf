//! Failure detectors held against the truth, which robots never see (after Chen, Toueg and Aguilera, 2002).
//!
//! An observer watches a subject from the first status of it that it reads: a *pair*. Time counts for a detector only where it has
//! a chance: a pair is *monitored* while the subject can send, the observer can hear, and the two are within the radio's range of
//! each other, except under a suspicion that is no mistake: from then until the observer trusts the subject again it tells nothing
//! about the detector's quality. Time out of range is monitored time of nobody, whenever a silence began.
//!
//! What an observer believes as the two meet is what it had heard, or not, before they did. So a pair that has come into range in
//! the course of a run is monitored once it has been there for as long as the detector waits for a status
//! ([`usual_silence`](crate::protocol::detector::DetectorConfig::usual_silence)); a subject that is still suspected then has not
//! been heard for all that time, and is mistaken for a failed one from then on, and so is one that is heard for the first time later
//! than that. Robots that are in range from the start count as
//! having been so for long.
//!
//! A suspicion is *right* if the subject cannot send at that instant. Otherwise it is *out of range* if the two are, or were while
//! the detector waited, or if most of the statuses missed were sent while they were; it is the *observer's* if most were lost because
//! the observer itself could not hear; and it is a *mistake* in every other case. So a mistake begins in monitored time. It is cut off
//! when the two part, when either fails, and at the end of the run.
//!
//! - T_MR, mistake recurrence: monitored time over mistakes; λ_M, the mistake rate, is its inverse.
//! - T_M, mistake duration: from a mistake to trust; of one that is cut off it is only known that it would have lasted longer.
//! - P_A, query accuracy: the share of the monitored time that is not spent in a mistake.
//! - T_D, detection time: from a failure to the suspicion that is in force when the failure or the run ends, zero if that
//!   was there before; one for each observer that monitored the robot as it failed. Where the two go then does not matter: who cannot
//!   send is heard nowhere.
//!
//! When robots that have met part and meet again is known to the nanosecond, for between two ticks of motion they move in straight
//! lines; a parting within a tick of the first status, at the end of that tick. When two robots met for the first time is known from
//! the statuses: half-way between the last that was sent out of range and the first that was not.

mod log;
mod pair;
mod range;
mod record;
mod score;
mod trace;

pub use record::{Cause, DetectionRecord, FailureOutcome, Missed, ObservedFailure, Suspicion, Verdict};
pub use trace::{Copy, CopyFate, Status, StatusTrace};

pub(super) use score::{Scorer, Watching};
