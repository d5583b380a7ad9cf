//! The truth about failures: who is well, and every episode.

use crate::engine::{ActorId, SimTime};
use crate::faults::{Change, Health, LinkFaultKind, Subject};

use super::episode::{FaultEpisode, FaultKind};
use super::reports::Reports;

/// What has failed so far and what fails now.
#[derive(Debug)]
pub(super) struct Failures {
    episodes: Vec<FaultEpisode>,
    health: Vec<Health>,
}

impl Failures {
    /// Every robot of `robots` well.
    pub(super) fn new(robots: usize) -> Self {
        Self {
            episodes: Vec::new(),
            health: vec![Health::WELL; robots],
        }
    }

    /// A fault begins or ends at `now`, with robots as `reports` say.
    pub(super) fn change(&mut self, now: SimTime, change: &Change, reports: &Reports) {
        if let Subject::Robot { robot, health, .. } = change.subject {
            self.health[robot.index()] = health;
        }
        if change.begins {
            self.episodes.push(FaultEpisode {
                fault: change.fault,
                kind: kind(change.subject, reports),
                from: now,
                until: None,
            });
        } else {
            let mut open = self.episodes.iter_mut().rev().filter(|episode| episode.until.is_none());
            let ended = open.find(|episode| episode.fault == change.fault && is_about(&episode.kind, change.subject));
            if let Some(episode) = ended {
                episode.until = Some(now);
            }
        }
    }

    /// Whether the radio of `robot` both sends and hears.
    #[inline]
    pub(super) fn is_live(&self, robot: ActorId) -> bool {
        self.health[robot.index()].is_live()
    }

    /// Every episode, by its beginning.
    pub(super) fn into_episodes(self) -> Vec<FaultEpisode> {
        self.episodes
    }
}

fn kind(subject: Subject, reports: &Reports) -> FaultKind {
    match subject {
        Subject::Robot { robot, effect, .. } => FaultKind::Robot {
            robot,
            effect,
            role: reports.roles[robot.index()].0,
            target: reports.targets[robot.index()],
        },
        Subject::Links(LinkFaultKind::Partition) => FaultKind::Partition,
        Subject::Links(LinkFaultKind::Burst) => FaultKind::Burst,
    }
}

/// Whether an episode of `kind`, of the same fault, is about `subject`.
fn is_about(kind: &FaultKind, subject: Subject) -> bool {
    match (kind, subject) {
        (FaultKind::Robot { robot: failed, .. }, Subject::Robot { robot, .. }) => *failed == robot,
        (FaultKind::Robot { .. }, Subject::Links(_)) | (_, Subject::Robot { .. }) => false,
        (FaultKind::Partition | FaultKind::Burst, Subject::Links(_)) => true,
    }
}
