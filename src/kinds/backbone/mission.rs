//! What every robot is given before the start: the targets, the root, the workers, and the settings in working units.

use crate::engine::{ActorId, Span, Streams};
use crate::geometry::{Pose, Vec2, direction};
use crate::protocol::Assignment;
use crate::protocol::control::{ControlConfig, Phases, Rhythm};
use crate::protocol::detector::{Circumstances, DetectorConfig};
use crate::protocol::gossip::{GossipConfig, Repetition, RetransmitConfig, TimeToLiveConfig, Turns};
use crate::protocol::steering::Patience;

use super::config::BackboneConfig;
use super::election::Rules;
use super::relays::relays_needed;

/// The mission: the same for all robots, and known to all from the start (paper section 4.1).
#[derive(Debug)]
pub struct Mission {
    /// How many robots there are.
    pub robots: usize,
    /// The robot that every chain ends at.
    pub root: ActorId,
    /// Where the root stands, metres in the arena's axes.
    pub origin: Vec2,
    /// The targets.
    pub targets: Vec<Target>,
    /// All chains, target by target. Chain number c, from 1, is the entry c − 1.
    pub chains: Vec<Chain>,
    /// The settings.
    pub parameters: Parameters,
}

/// A target and who works there.
#[derive(Clone, Debug)]
pub struct Target {
    /// Its place, metres in the arena's axes.
    pub at: Vec2,
    /// The robot that visits it.
    pub worker: ActorId,
    /// Numbers of its chains.
    pub chains: std::ops::Range<u8>,
}

/// One chain from the root to a worker.
#[derive(Clone, Copy, Debug)]
pub struct Chain {
    /// The target that it leads to, an index into [`Mission::targets`].
    pub target: u8,
    /// Networkers that it needs, the fewest that will do (paper eq. 2).
    pub relays: usize,
    /// Length of its springs, metres.
    pub rest: f64,
    /// The way from the root to the target, a unit vector.
    pub forward: Vec2,
    /// Where it runs beside the straight line from the root to the target, metres to the left.
    pub lane: f64,
}

impl Chain {
    /// How far to the left of the straight line the chain runs at `ahead` metres from the root: lanes part gradually over
    /// the first spring's length.
    #[must_use]
    pub fn lane_at(&self, ahead: f64) -> f64 {
        self.lane * (ahead / self.rest).clamp(0.0, 1.0)
    }

    /// The place of the relay next to the root, which stands at `origin`.
    #[must_use]
    pub fn first_place(&self, origin: Vec2) -> Vec2 {
        origin + self.forward * self.rest + self.left() * self.lane
    }

    /// Lengths of the springs between the robots of the chain and of the one at the worker, metres, where the chain has
    /// so many `relays`. With a reserve the last spring is shorter, by which the outermost relay is near to the target.
    #[must_use]
    pub fn springs(&self, relays: usize) -> Springs {
        if relays <= self.relays {
            return Springs {
                between: self.rest,
                last: self.rest,
            };
        }
        let between = self.rest * (self.relays + 1) as f64 / (relays as f64 + LAST_SPRING);
        Springs {
            between,
            last: LAST_SPRING * between,
        }
    }

    /// The left of the way from the root to the target, a unit vector.
    #[must_use]
    pub fn left(&self) -> Vec2 {
        Vec2::new(-self.forward.y, self.forward.x)
    }
}

/// Lengths of a chain's springs, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Springs {
    /// Of those between the root and the outermost relay.
    pub between: f64,
    /// Of the one from the outermost relay to the worker, as the relay feels it.
    pub last: f64,
}

/// Length of the last spring of a chain that has a reserve, as a share of its others.
const LAST_SPRING: f64 = 0.5;

/// Settings in metres, m/s, 1/s and whole control steps. See [`BackboneConfig`] for what they mean.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Parameters {
    pub safe: f64,
    pub gate: f64,
    pub critical: f64,
    pub threshold: f64,
    pub spring_gain: f64,
    pub target_gain: f64,
    pub push_limit: f64,
    pub lane_gain: f64,
    pub lane_limit: f64,
    pub lj_gain: f64,
    pub lj_delta: f64,
    pub avoidance_range: f64,
    pub backbone_avoidance_range: f64,
    pub avoidance_gain: f64,
    pub rest_speed: f64,
    pub patience: Patience,
    pub recruit_ratio: f64,
    pub request_patience: u64,
    pub refusal_memory: u64,
    pub join_timeout: u64,
    pub shortage_patience: u64,
    pub visit: u64,
    pub status_turns: Turns,
    pub status_repetition: Repetition,
    pub strand_turns: Turns,
    pub strand_repetition: Repetition,
    pub request_turns: Turns,
    pub relay_turns: Turns,
    pub retransmit: RetransmitConfig,
    pub strand_lifetime: u64,
    pub hop_limit: usize,
    pub healing_patience: u64,
    pub precedence: u64,
    pub reserve: u8,
    pub silence_steps: u64,
    pub election: Option<Rules>,
    pub detector: DetectorConfig,
    pub circumstances: Circumstances,
    pub phases: Phases,
}

impl Mission {
    /// The mission of robots that start at `poses`: the root is the robot nearest to the centre, a worker is the robot
    /// nearest to its target that has no such duty yet.
    #[must_use]
    pub fn new(config: &BackboneConfig, parameters: Parameters, poses: &[Pose]) -> Self {
        let places = config.targets();
        let duties = Assignment::nearest(poses, places.iter().map(|(at, _)| *at));
        let origin = poses[duties.root.index()].position;
        let mut chains = Vec::new();
        let mut targets = Vec::new();
        for (index, ((at, links), worker)) in places.into_iter().zip(duties.workers).enumerate() {
            let first = chains.len() as u8 + 1;
            chains.extend(parallel_chains(config, index as u8, at - origin, links));
            targets.push(Target {
                at,
                worker,
                chains: first..first + links,
            });
        }
        Self {
            robots: poses.len(),
            root: duties.root,
            origin,
            targets,
            chains,
            parameters,
        }
    }

    /// The chain with number `number`, from 1.
    #[must_use]
    pub fn chain(&self, number: u8) -> &Chain {
        &self.chains[usize::from(number) - 1]
    }

    /// Whether `number` is a chain's.
    #[must_use]
    pub fn has_chain(&self, number: u8) -> bool {
        (1..=self.chains.len()).contains(&usize::from(number))
    }

    /// The target that `robot` was assigned to as its worker.
    #[must_use]
    pub fn worker_target(&self, robot: ActorId) -> Option<u8> {
        let index = self.targets.iter().position(|target| target.worker == robot)?;
        Some(index as u8)
    }
}

/// The shortest springs, in safe distances: robots have bodies, even where a target is next to the root.
const SHORTEST_SPRING: f64 = 0.25;

/// The `links` chains to target number `target`, which lies at `displacement` from the root.
fn parallel_chains(config: &BackboneConfig, target: u8, displacement: Vec2, links: u8) -> impl Iterator<Item = Chain> {
    let safe = config.safe_distance.get();
    let distance = displacement.norm();
    let needed = relays_needed(distance, config.movement_threshold.get(), safe);
    let gaps = f64::from(links.saturating_sub(1));
    // However many the chains, the outermost stay within a spring's reach of each other.
    let spacing = config.motion.lane_spacing.get().min(safe / gaps.max(1.0));
    let taut = config.motion.taut_ratio.get();
    (0..links).map(move |link| {
        // Only one chain can be the worker's own link to the root: the others need a relay to be disjoint from it.
        let relays = needed.max(usize::from(link > 0));
        let even = distance / (relays + 1) as f64;
        Chain {
            target,
            relays,
            rest: (taut * even).clamp(SHORTEST_SPRING * safe, safe),
            forward: direction(displacement),
            lane: (f64::from(link) - gaps / 2.0) * spacing,
        }
    })
}

impl Parameters {
    /// The settings of a scenario, for robots that wake as `control` says, in a trial with these `streams`.
    #[must_use]
    pub fn new(
        config: &BackboneConfig,
        gossip: &GossipConfig,
        (detector, circumstances): (&DetectorConfig, Circumstances),
        control: &ControlConfig,
        streams: Streams,
    ) -> Self {
        let control_period = control.period();
        let phases = Phases::new(control.phase, streams);
        let turns = |timing, rhythm| Turns::new(timing, rhythm, phases, streams);
        let steps = |seconds: f64| Span::from_secs(seconds).in_periods(control_period);
        let law = &config.motion;
        let status_repetition = gossip.status.repetition(control_period);
        let strand_repetition = gossip.strand.repetition(control_period);
        let request = gossip.request.timing(control_period);
        Self {
            safe: config.safe_distance.get(),
            gate: law.movement_gate.get(),
            critical: config.critical_distance.get(),
            threshold: config.movement_threshold.get(),
            spring_gain: config.spring_gain.get(),
            target_gain: law.target_gain.get(),
            push_limit: law.push_limit.get(),
            lane_gain: law.lane_gain.get(),
            lane_limit: law.lane_limit.get(),
            // In the paper, where it settles at half a metre, distances are in metres: in units of twice what it settles at.
            lj_gain: config.lj_epsilon.get() * law.lj_speed.get() * (2.0 * config.lj_delta.get()),
            lj_delta: config.lj_delta.get(),
            avoidance_range: law.avoidance_range.get(),
            backbone_avoidance_range: law.backbone_avoidance_range.get(),
            avoidance_gain: law.avoidance_gain.get(),
            rest_speed: law.rest_speed.get(),
            patience: Patience {
                stall_steps: steps(law.stall_time.get()),
                progress: config.safe_distance.get() / SAFE_DISTANCES_OF_PROGRESS,
            },
            recruit_ratio: config.recruiting.distance_ratio.get(),
            // Patience counts repetitions too, so that rare gossip does not undo every join.
            request_patience: steps(config.recruiting.patience.get()).max(REPETITIONS * request.longest()),
            refusal_memory: steps(config.recruiting.refusal_memory.get()),
            join_timeout: steps(config.recruiting.join_timeout.get())
                .max(REPETITIONS * strand_repetition.longest_pause())
                .max(REPETITIONS * request.longest()),
            shortage_patience: steps(config.shortage.patience.get()),
            visit: steps(config.shortage.visit.get()),
            status_turns: turns(gossip.status.timing(control_period), Rhythm::Status),
            status_repetition,
            strand_turns: turns(gossip.strand.timing(control_period), Rhythm::Strand),
            strand_repetition,
            request_turns: turns(request, Rhythm::Request),
            relay_turns: turns(gossip.relay.timing(control_period), Rhythm::Relay),
            retransmit: gossip.relay.retransmit,
            strand_lifetime: match gossip.strand.time_to_live {
                TimeToLiveConfig::Unlimited => u64::MAX,
                TimeToLiveConfig::Seconds(seconds) => steps(seconds.get()),
            },
            hop_limit: gossip.strand.hop_limit.into(),
            precedence: PRECEDENCE * status_repetition.longest_pause(),
            healing_patience: steps(config.healing.patience.get()),
            election: config.election.as_ref().map(|election| Rules {
                patience: steps(election.patience.get()),
                duration: steps(election.duration.get()),
            }),
            silence_steps: steps(detector.usual_silence(circumstances).as_secs()),
            reserve: config.healing.reserve,
            detector: detector.clone(),
            circumstances,
            phases,
        }
    }
}

impl Parameters {
    /// The distance up to which the gate f is fully open, metres: beyond the safe distance, for a chain at rest is taut.
    #[must_use]
    pub fn gate_opening(&self) -> f64 {
        f64::midpoint(self.safe, self.gate)
    }
}

/// A robot has come on once it has moved by the safe distance over this: 1 cm of the paper's 1.4 m.
const SAFE_DISTANCES_OF_PROGRESS: f64 = 140.0;

/// Statuses for which a networker leaves it to each one nearer to the target to take over from a lost worker.
const PRECEDENCE: u64 = 10;

/// Repetitions of a message that may be lost before a join is given up.
const REPETITIONS: u64 = 5;

#[cfg(test)]
mod tests;
