//! Failure detectors held against the truth, which robots never see (after Chen, Toueg and Aguilera, 2002).
//!
//! An observer watches a subject from the first status of it that it reads: a *pair*. A pair is *monitored* while the
//! subject can send and the observer can hear, except under a suspicion that is no mistake: from then until the observer
//! trusts the subject again it tells nothing about the detector's quality.
//!
//! A suspicion is *right* if the subject cannot send at that instant. Otherwise it is *out of range* if most of the
//! statuses missed were sent while the observer was out of range: a robot out of range is no failed robot; it is the
//! *observer's* if most were lost because the observer itself could not hear; and it is a *mistake* in every other case.
//!
//! - T_MR, mistake recurrence: monitored time over mistakes; λ_M, the mistake rate, is its inverse.
//! - T_M, mistake duration: from a mistake to trust; those that end with the run, with a failure or out of range were cut off.
//! - P_A, query accuracy: the share of the monitored time that is not spent in a mistake.
//! - T_D, detection time: from a failure to the suspicion that is in force when the failure or the run ends, zero if that
//!   was there before; one for each observer that monitored the robot as it failed.

mod log;
mod record;
mod score;
mod trace;

pub use record::{Cause, DetectionRecord, FailureOutcome, Missed, ObservedFailure, Suspicion, Verdict};
pub use trace::{Copy, CopyFate, Status, StatusTrace};

pub(super) use score::Scorer;
