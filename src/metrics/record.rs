//! What a trial leaves behind: plain data, read by reports and exports, never by the simulation.

use serde::{Deserialize, Serialize};

use crate::engine::{ActorId, SimTime, Span};
use crate::geometry::{Pose, Vec2};
use crate::radio::Reach;
use crate::spool::{Entry, Spool, Spooled, entry};

use super::air::AirRecord;
use super::asked::Asked;
use super::connectivity::Graph;
use super::detection::{DetectionRecord, ObservedFailure, StatusTrace, Suspicion};
use super::episode::{FaultEpisode, HealingEpisode};
use super::latency::LatencyHistogram;
use super::noted::Noted;
use super::pairs::PairRecord;
use super::spread::RumorSpread;
use super::volume::{TopicFates, TrafficRow};

/// Robots of which pictures are drawn, at most.
const MOST_DRAWN: usize = 20_000;

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
    /// What passed from each robot to each, by sender and receiver, where the scenario asks for it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pairs: Vec<PairRecord>,
    /// What radios did, over a radio that keeps accounts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub air: Option<AirRecord>,
    /// What else the scenario asks for, table by table.
    #[serde(default, skip_serializing_if = "Asked::is_empty")]
    pub asked: Asked,
    /// Connectivity at each sample time.
    pub connectivity: Spool<ConnectivitySample>,
    /// Traffic over time, in order of time.
    pub series: Spool<SeriesEntry>,
    /// Robots at the end, in order of ids.
    pub robots: Vec<RobotState>,
    /// Positions at each sample time (metres, robot by robot), as f32: for pictures.
    pub trajectories: Spool<(SimTime, Vec<[f32; 2]>)>,
    /// The statuses of the robot that the run was asked to follow, if it was; kept nowhere.
    #[serde(skip)]
    pub trace: Option<StatusTrace>,
}

impl TrialRecord {
    /// Adds what somebody noted, in the place of what that robot noted under the same name, if it did: for what an observer found out, and no robot
    /// could.
    pub fn note(&mut self, noted: Noted) {
        match self.noted.binary_search_by(|known| known.place().cmp(&noted.place())) {
            Ok(place) => self.noted[place] = noted,
            Err(place) => self.noted.insert(place, noted),
        }
    }

    /// The least λ₂ over the samples that find two live robots or more; `None` if none does.
    #[must_use]
    pub fn lambda2_min(&self) -> Option<f64> {
        self.connectivity
            .iter()
            .filter(ConnectivitySample::has_two)
            .map(|sample| sample.lambda2)
            .min_by(f64::total_cmp)
    }

    /// Share of the samples that find the live robots in one piece, of those that find any; `None` if none does.
    #[must_use]
    pub fn connected_share(&self) -> Option<f64> {
        let count = |counts: fn(&ConnectivitySample) -> bool| self.connectivity.iter().filter(counts).count() as f64;
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

    /// The places at the end of every two robots that hear each other as `reach` says, in order of their numbers.
    #[must_use]
    pub fn links_at_end(&self, reach: &Reach) -> Vec<(Vec2, Vec2)> {
        let place = |robot: ActorId| self.robots[robot.index()].pose.position;
        let robots = (0..self.robots.len() as u32).map(ActorId);
        let (graph, vertices) = Graph::with_robots(robots.map(|robot| (robot, place(robot))), reach);
        let ends = graph
            .edges()
            .iter()
            .map(|edge| edge.map(|vertex| vertices[vertex as usize]));
        let mut links: Vec<[ActorId; 2]> = ends.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        links.sort_unstable();
        links.into_iter().map(|[a, b]| (place(a), place(b))).collect()
    }

    /// Whether its robots are few enough for a picture: of more nothing could be made out, and it would be longer than all tables together.
    #[must_use]
    pub fn can_be_drawn(&self) -> bool {
        self.robots.len() <= MOST_DRAWN
    }

    /// Robots that ended in another role than the one that all start in: those that the mission took. `None` where
    /// there is no mission.
    #[must_use]
    pub fn robots_used(&self) -> Option<usize> {
        let used = || self.robots.iter().filter(|robot| robot.role != 0).count();
        (self.outcome != Outcome::NoMission).then(used)
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

entry! {
    ConnectivitySample { at, lambda2, components, neighbours, roles, links, targets }
    TargetSample { state, worker_m }
    SeriesEntry { since, at, sent, received }
    RobotBytes { total, min, median, max }
}

impl Entry for TargetState {
    fn put(&self, into: &mut Vec<u8>) {
        (*self as u8).put(into);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        Self::ALL.get(usize::from(u8::take(from)?)).copied()
    }
}

/// The lists of a record that grow with simulated time.
#[derive(Debug, Default)]
pub struct Lists {
    suspicions: Spool<Suspicion>,
    failures: Spool<ObservedFailure>,
    connectivity: Spool<ConnectivitySample>,
    series: Spool<SeriesEntry>,
    trajectories: Spool<(SimTime, Vec<[f32; 2]>)>,
    asked: Asked,
}

impl Lists {
    /// All of them, always in this order.
    pub fn all(&mut self) -> [&mut dyn Spooled; 10] {
        let [delays, degree, hops, traffic, roles] = self.asked.lists();
        [
            &mut self.suspicions,
            &mut self.failures,
            &mut self.connectivity,
            &mut self.series,
            &mut self.trajectories,
            delays,
            degree,
            hops,
            traffic,
            roles,
        ]
    }
}

impl TrialRecord {
    /// Puts `lists` in the place of its own, which it gives.
    pub fn exchange(&mut self, lists: &mut Lists) {
        use std::mem::swap;
        swap(&mut self.detection.suspicions, &mut lists.suspicions);
        swap(&mut self.detection.failures, &mut lists.failures);
        swap(&mut self.connectivity, &mut lists.connectivity);
        swap(&mut self.series, &mut lists.series);
        swap(&mut self.trajectories, &mut lists.trajectories);
        self.asked.exchange_lists(&mut lists.asked);
    }
}
