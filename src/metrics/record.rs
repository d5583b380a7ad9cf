//! What a trial leaves behind: plain data, read by reports and exports, never by the simulation.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::engine::{ActorId, SimTime, Span};
use crate::faults::Effect;
use crate::geometry::Pose;
use crate::radio::LossCause;

use super::detection::{DetectionRecord, StatusTrace};
use super::latency::LatencyHistogram;
use super::noted::Noted;
use super::spread::RumorSpread;

/// Everything that one trial leaves behind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrialRecord {
    /// Number of the trial, from 0.
    pub trial: u32,
    /// Seed of the experiment.
    pub seed: u64,
    /// How the mission ended.
    pub outcome: Outcome,
    /// Control steps simulated.
    pub steps: u64,
    /// Length of a control step.
    pub control_period: Span,
    /// Simulated time at the end.
    pub simulated: SimTime,
    /// Events handled: motion ticks, wakes, samples.
    pub events: u64,
    /// Digest of every event, in order.
    pub digest: u128,
    /// Frames by topic and fate, in order of topics.
    pub ledger: Vec<TopicFates>,
    /// Traffic by robot, role and topic: only rows with traffic, ordered by robot, role, topic.
    pub traffic: Vec<TrafficRow>,
    /// Time from the start of a transmission to its arrival, of all delivered frames.
    pub latency: LatencyHistogram,
    /// What robots believed of each other's failures, held against the truth.
    pub detection: DetectionRecord,
    /// What failed and when, in order of time: the truth that robots never see.
    pub faults: Vec<FaultEpisode>,
    /// Every failure of a robot that worked for a target, and how the target got its links back, in order of time.
    pub healing: Vec<HealingEpisode>,
    /// How each rumour spread, where the protocol has any.
    pub spread: Vec<RumorSpread>,
    /// What robots counted and measured under names of their own, in order of names, then of robots.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub noted: Vec<Noted>,
    /// Connectivity at each sample time.
    pub connectivity: Vec<ConnectivitySample>,
    /// Traffic over time, in order of time.
    pub series: Vec<SeriesEntry>,
    /// Robots at the end, in order of ids.
    pub robots: Vec<RobotState>,
    /// Positions at each sample time (metres, robot by robot), as f32: for pictures.
    pub trajectories: Vec<(SimTime, Vec<[f32; 2]>)>,
    /// The statuses of the robot that the run was asked to follow, if it was; kept nowhere.
    #[serde(skip)]
    pub trace: Option<StatusTrace>,
}

impl TrialRecord {
    /// The least λ₂ over the samples that find two live robots or more; `None` if none does.
    #[must_use]
    pub fn lambda2_min(&self) -> Option<f64> {
        self.connectivity
            .iter()
            .filter(|sample| sample.has_two())
            .map(|sample| sample.lambda2)
            .min_by(f64::total_cmp)
    }

    /// Share of the samples that find the live robots in one piece, of those that find any; `None` if none does.
    #[must_use]
    pub fn connected_share(&self) -> Option<f64> {
        let count = |counts: fn(&ConnectivitySample) -> bool| {
            self.connectivity.iter().filter(|sample| counts(sample)).count() as f64
        };
        let any = count(|sample| sample.components > 0);
        (any > 0.0).then(|| count(|sample| sample.components == 1) / any)
    }

    /// Each robot's bytes a control step of its own, of whatever `bytes` takes from its rows; a robot without traffic counts with 0.
    /// Steps that it missed, being down, count.
    #[must_use]
    pub fn bytes_per_step(&self, bytes: impl Fn(&TrafficRow) -> u64) -> Vec<f64> {
        let mut sums = vec![0; self.robots.len()];
        for row in &self.traffic {
            sums[row.robot.index()] += bytes(row);
        }
        // A run too short for a single control step of a robot lasts no longer than one.
        let steps = self.robots.iter().map(|robot| robot.steps.max(1) as f64);
        sums.into_iter()
            .zip(steps)
            .map(|(sum, steps)| sum as f64 / steps)
            .collect()
    }

    /// The robots that failed at some time, each once, in order of ids.
    #[must_use]
    pub fn failed_robots(&self) -> Vec<ActorId> {
        self.robots_of(|_| true)
    }

    /// The robots that something ails at the end, each once, in order of ids.
    #[must_use]
    pub fn failed_at_end(&self) -> Vec<ActorId> {
        self.robots_of(|episode| episode.until.is_none())
    }

    fn robots_of(&self, counts: impl Fn(&FaultEpisode) -> bool) -> Vec<ActorId> {
        let episodes = self.faults.iter().filter(|episode| counts(episode));
        let mut robots: Vec<_> = episodes.filter_map(|episode| episode.kind.robot()).collect();
        robots.sort_unstable();
        robots.dedup();
        robots
    }

    /// Robots that ended in another role than the one that all start in: those that the mission took. `None` where
    /// there is no mission.
    #[must_use]
    pub fn robots_used(&self) -> Option<usize> {
        let used = || self.robots.iter().filter(|robot| robot.role != 0).count();
        (self.outcome != Outcome::NoMission).then(used)
    }
}

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

/// A failure of a robot that worked for a target, until the target has its links again: as many vertex-disjoint chains as
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

/// How a mission ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Outcome {
    /// Every target was held with its links, or every live robot knew every rumour, from this control step on, for the time
    /// that the scenario asks.
    Completed {
        /// The first such control step, from 0.
        step: u64,
    },
    /// The time limit came first: the number of steps is censored.
    Censored,
    /// The protocol has no mission to complete; the run ended at its time limit.
    NoMission,
}

/// Frames of one topic by fate, counted a copy an intended receiver.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct TopicFates {
    /// Copies that transmissions offered to robots in range.
    pub offered: u64,
    /// Copies that arrived.
    pub delivered: u64,
    /// Copies lost, by [`LossCause`] in the order of [`LossCause::ALL`].
    pub lost: [u64; LossCause::ALL.len()],
    /// Copies under way at the end.
    pub in_flight: u64,
}

impl TopicFates {
    /// Whether every copy offered has exactly one fate.
    #[must_use]
    pub fn is_balanced(&self) -> bool {
        self.offered == self.delivered + self.lost.iter().sum::<u64>() + self.in_flight
    }

    /// Adds the frames of `other`.
    pub fn add(&mut self, other: &Self) {
        self.offered += other.offered;
        self.delivered += other.delivered;
        self.in_flight += other.in_flight;
        for (mine, theirs) in self.lost.iter_mut().zip(&other.lost) {
            *mine += theirs;
        }
    }
}

impl fmt::Display for TopicFates {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let causes: Vec<String> = LossCause::ALL
            .iter()
            .zip(&self.lost)
            .map(|(cause, frames)| format!("{} {frames}", cause.name()))
            .collect();
        let lost: u64 = self.lost.iter().sum();
        write!(
            f,
            "offered {}, delivered {}, lost {lost} ({}), in flight {}",
            self.offered,
            self.delivered,
            causes.join(", "),
            self.in_flight
        )
    }
}

/// Frames and their bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Volume {
    /// Number of frames.
    pub frames: u64,
    /// Their payload, bytes.
    pub payload_bytes: u64,
    /// Their headers, bytes.
    pub header_bytes: u64,
}

impl Volume {
    /// All their bytes, headers included.
    #[must_use]
    pub fn bytes(self) -> u64 {
        self.payload_bytes + self.header_bytes
    }
}

/// Traffic of one robot while in one role, on one topic.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TrafficRow {
    /// The robot.
    pub robot: ActorId,
    /// Its role then, an index into the protocol's roles.
    pub role: u8,
    /// The topic, an index into the protocol's topics.
    pub topic: u8,
    /// What it sent, a frame counted once however many robots hear it.
    pub sent: Volume,
    /// What reached it.
    pub received: Volume,
    /// The part of it that told it nothing new, as far as the protocol says.
    pub duplicate: Volume,
    /// What was meant for it and lost, by cause in the order of [`LossCause::ALL`].
    pub lost: [Volume; LossCause::ALL.len()],
}

/// The swarm's graph at one instant: robots within range of each other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConnectivitySample {
    /// When.
    pub at: SimTime,
    /// Algebraic connectivity λ₂ of the graph Laplacian; 0 if the graph is not connected.
    pub lambda2: f64,
    /// Connected components.
    pub components: u32,
    /// How many others a robot has in range, mean over robots; 0 where there are none.
    pub neighbours: f64,
    /// Robots in each role, in order of the protocol's roles.
    pub roles: Vec<u32>,
    /// Vertex-disjoint chains from each target's worker to the root, nl(t) of paper eq. 5, in order of targets.
    pub links: Vec<u32>,
    /// How each target stands, in order of targets.
    pub targets: Vec<TargetSample>,
}

/// A target at one instant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TargetSample {
    /// Whether it is held with its links, or what stands in the way.
    pub state: TargetState,
    /// How far its nearest live worker is from it, metres; `None` without one.
    pub worker_m: Option<f64>,
}

/// Whether a target is held with its links, or what stands in the way first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum TargetState {
    /// A worker is at it, with as many chains as it needs.
    Held,
    /// No live robot is its worker.
    NoWorker,
    /// Its worker is not there.
    Away,
    /// Its worker is there, with too few chains, or too few parents near.
    LinksShort,
}

impl TargetState {
    /// Every state.
    pub const ALL: [Self; 4] = [Self::Held, Self::NoWorker, Self::Away, Self::LinksShort];

    /// The name that tables use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Held => "held",
            Self::NoWorker => "no_worker",
            Self::Away => "away",
            Self::LinksShort => "links_short",
        }
    }
}

impl ConnectivitySample {
    /// Whether there were two live robots or more: then either there are as many pieces, or λ₂ is above 0.
    #[must_use]
    pub fn has_two(&self) -> bool {
        self.components > 1 || self.lambda2 > 0.0
    }
}

/// Traffic from one sample to the next, headers included: on each topic, in order of topics, then on all together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SeriesEntry {
    /// Since when: a sample.
    pub since: SimTime,
    /// Until when: a later sample.
    pub at: SimTime,
    /// Sent, a frame counted once however many robots hear it.
    pub sent: Vec<RobotBytes>,
    /// Received.
    pub received: Vec<RobotBytes>,
}

/// Bytes of robots, and how they spread over them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RobotBytes {
    /// Of all robots together.
    pub total: u64,
    /// Of the robot with the fewest.
    pub min: u64,
    /// Median over robots.
    pub median: f64,
    /// Of the robot with the most.
    pub max: u64,
}

/// A robot at the end of a trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RobotState {
    /// Where it is.
    pub pose: Pose,
    /// Its role, an index into the protocol's roles.
    pub role: u8,
    /// The target that it works for, if any.
    pub target: Option<u16>,
    /// The robots that it relies on to reach the root.
    pub parents: Vec<ActorId>,
    /// Its control steps that were due in the trial. Robots with a phase of their own may have one fewer than others.
    pub steps: u64,
}
