//! What a scenario says beside its protocol, as a protocol's config sees it; and the swarm that it makes robots for.

use crate::engine::{ActorId, Span, Streams};
use crate::faults::FaultConfig;
use crate::geometry::{Pose, Vec2};
use crate::metrics::MetricsConfig;
use crate::motion::{ArenaConfig, DeployConfig, MotionConfig};
use crate::protocol::control::{ControlConfig, Phases, Rhythm};
use crate::protocol::detector::{Circumstances, Detector, DetectorConfig};
use crate::protocol::gossip::{GossipConfig, OwnTurns, Turns};
use crate::protocol::wander::{Ground, WanderConfig};
use crate::radio::RadioConfig;

/// The sections of a scenario around its protocol.
#[derive(Clone, Copy, Debug)]
pub struct Sections<'a> {
    /// Number of robots.
    pub robots: u32,
    /// Simulated seconds after which a trial ends at the latest.
    pub time_limit: f64,
    /// The arena.
    pub arena: &'a ArenaConfig,
    /// Where robots start.
    pub deploy: &'a DeployConfig,
    /// How robots move.
    pub motion: &'a MotionConfig,
    /// When robots wake.
    pub control: &'a ControlConfig,
    /// How robots move whose protocol has no motion of its own.
    pub wander: &'a WanderConfig,
    /// How robots repeat what they gossip.
    pub gossip: &'a GossipConfig,
    /// When a robot believes that a neighbour is down.
    pub detector: &'a DetectorConfig,
    /// The radio.
    pub radio: &'a RadioConfig,
    /// How robots and links fail.
    pub faults: &'a [FaultConfig],
    /// What is measured.
    pub metrics: &'a MetricsConfig,
}

impl Sections<'_> {
    /// What a failure detector is told of the swarm.
    #[must_use]
    pub fn circumstances(&self) -> Circumstances {
        Circumstances {
            robots: self.robots as usize,
            status_interval: self.gossip.status.longest_pause(self.period()),
        }
    }

    /// Length of a control step.
    #[must_use]
    pub fn period(&self) -> Span {
        self.control.period()
    }
}

/// The swarm of a trial, before it starts.
#[derive(Clone, Copy, Debug)]
pub struct Swarm<'a> {
    /// Where each robot starts, in order of ids.
    pub poses: &'a [Pose],
    /// What the scenario says.
    pub sections: Sections<'a>,
    /// The random streams of the trial.
    pub streams: Streams,
}

impl Swarm<'_> {
    /// A robot for each id, in order.
    pub fn each<R>(&self, robot: impl FnMut(ActorId) -> R) -> Vec<R> {
        (0..self.poses.len() as u32).map(ActorId).map(robot).collect()
    }

    /// At which phase of its interval each robot begins what it repeats.
    #[must_use]
    pub fn phases(&self) -> Phases {
        Phases::new(self.sections.control.phase, self.streams)
    }

    /// The failure detector that the scenario sets, for robot `id`. The robots' kind heeds [`Shared::Detector`] and
    /// [`Shared::Status`]; [its module](crate::protocol::detector) shows a whole robot.
    ///
    /// [`Shared::Detector`]: super::Shared::Detector
    /// [`Shared::Status`]: super::Shared::Status
    #[must_use]
    pub fn detector(&self, id: ActorId) -> Detector {
        let sections = &self.sections;
        Detector::new(sections.detector, sections.circumstances(), self.phases(), id)
    }

    /// At which of its control steps robot `id` says its status, by `gossip.status`.
    #[must_use]
    pub fn status_turns(&self, id: ActorId) -> OwnTurns {
        let timing = self.sections.gossip.status.timing(self.sections.period());
        Turns::new(timing, Rhythm::Status, self.phases(), self.streams).of(id)
    }

    /// Where robots go that wander as the scenario says.
    #[must_use]
    pub fn ground(&self) -> Ground {
        let Sections {
            arena, motion, control, ..
        } = self.sections;
        let (width, height) = &arena.size;
        let size = Vec2::new(width.get(), height.get());
        Ground::new(
            *self.sections.wander,
            size,
            motion.body_radius.get(),
            control,
            self.streams,
        )
    }
}
