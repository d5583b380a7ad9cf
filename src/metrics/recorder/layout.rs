//! What a recorder is told before a run and after it.

use crate::engine::{SimTime, Span};
use crate::geometry::Pose;
use crate::metrics::mission::Mission;
use crate::metrics::traffic::HeaderBytes;
use crate::protocol::{CompletionConfig, Topic};
use crate::radio::Reach;
use crate::spool::Scratch;

/// The shape of a run, known before it starts.
#[derive(Clone, Debug)]
pub struct Layout {
    /// Number of robots.
    pub robots: usize,
    /// Number of topics of the protocol.
    pub topics: usize,
    /// Number of roles of the protocol.
    pub roles: usize,
    /// Bytes of headers on air.
    pub headers: HeaderBytes,
    /// Who is in range of whom.
    pub reach: Reach,
    /// Length of a control step.
    pub control_period: Span,
    /// What the swarm is asked to do, if anything.
    pub mission: Option<Mission>,
    /// How many rumours there are that all robots are to know; 0 for none.
    pub rumors: usize,
    /// When the mission, or the spread of the rumours, is complete.
    pub completion: CompletionConfig,
    /// How far back a suspicion is traced to the statuses that were missed.
    pub status_memory: Span,
    /// How long the robots' failure detector waits for a status before it suspects.
    pub patience: Span,
    /// The topic of the statuses that the robots' failure detector listens to, if they run one.
    pub status: Option<Topic>,
    /// Where what grows with simulated time has its files.
    pub scratch: Scratch,
}

/// What only the hub knows when a run is over.
#[derive(Clone, Debug, PartialEq)]
pub struct RunEnd {
    /// Number of the trial, from 0.
    pub trial: u32,
    /// Seed of the experiment.
    pub seed: u64,
    /// Control steps simulated.
    pub steps: u64,
    /// Simulated time at the end.
    pub simulated: SimTime,
    /// Events handled.
    pub events: u64,
    /// Digest of every event, in order.
    pub digest: u128,
    /// Control steps of each robot that were due, in order of ids.
    pub robot_steps: Vec<u64>,
    /// Where every robot is, in order of ids.
    pub poses: Vec<Pose>,
}
