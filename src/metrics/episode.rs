//! What failed in a trial, and how targets got their links back.

use serde::{Deserialize, Serialize};

use crate::engine::{ActorId, SimTime};
use crate::faults::Effect;

/// A failure, from its beginning to its end.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FaultEpisode {
    /// The fault's place in the scenario's list, from 0.
    pub fault: u16,
    /// What fails.
    pub kind: FaultKind,
    /// When it begins.
    pub from: SimTime,
    /// When it ends; `None` if it outlasts the trial.
    pub until: Option<SimTime>,
}

/// A failure of a robot that worked for a target, or of the root, on which every target counts, until the target has its links again: as many vertex-disjoint chains as
/// just before, or as it needs, if it had more. If its worker failed, or one was at the target, a live worker must also be as
/// near to the target as then, or at it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HealingEpisode {
    /// The fault's place in the scenario's list, from 0.
    pub fault: u16,
    /// The robot that failed.
    pub robot: ActorId,
    /// Its role then, an index into the protocol's roles.
    pub role: u8,
    /// The target that it worked for.
    pub target: u16,
    /// When it failed.
    pub failed_at: SimTime,
    /// Chains of the target just before, at most as many as it needs.
    pub links_before: u32,
    /// Chains of the target just after, at most as many as it needs.
    pub links_after: u32,
    /// How far the nearest live worker was from the target just before, metres; `None` without one.
    pub worker_m: Option<f64>,
    /// The first control step at which the target had its links again; the time of the failure if it did no harm, `None` if the
    /// trial ended first.
    pub healed_at: Option<SimTime>,
    /// Other failures whose harm to the same target was unmended at some time meanwhile.
    pub overlapping: u32,
    /// Way that the live robots that work for the target have made meanwhile, all together, metres.
    pub distance_m: f64,
    /// Frames that robots that work for the target have sent meanwhile, by topic.
    pub frames: Vec<u64>,
    /// Their payload, bytes.
    pub payload_bytes: Vec<u64>,
}

impl HealingEpisode {
    /// Whether the target was worse off just after than just before.
    #[must_use]
    pub fn is_harmful(&self) -> bool {
        self.healed_at != Some(self.failed_at)
    }
}

/// What fails.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum FaultKind {
    /// A robot.
    Robot {
        /// Which.
        robot: ActorId,
        /// What it cannot do.
        effect: Effect,
        /// Its role when it failed, an index into the protocol's roles.
        role: u8,
        /// The target that it worked for when it failed, if any.
        target: Option<u16>,
    },
    /// Nothing crosses a line.
    Partition,
    /// Links lose more.
    Burst,
}

impl FaultKind {
    /// The name that reports and tables use.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Robot { effect, .. } => effect.name(),
            Self::Partition => "partition",
            Self::Burst => "burst",
        }
    }

    /// The robot that fails, if it is one.
    #[must_use]
    pub const fn robot(&self) -> Option<ActorId> {
        match self {
            Self::Robot { robot, .. } => Some(*robot),
            Self::Partition | Self::Burst => None,
        }
    }
}
