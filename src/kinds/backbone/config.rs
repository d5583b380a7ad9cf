//! What a scenario says about the backbone protocol. Symbols and values are those of the paper's table 1; settings
//! without a symbol are ours, where the paper is silent.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::geometry::Vec2;
use crate::protocol::{CompletionConfig, TargetsConfig};
use crate::quantity::{NonNegative, Positive, Probability};

use super::relays::relays_needed;

/// Most chains that a status can name: its target chain is one byte, and 0 means none.
const MOST_CHAINS: usize = 255;
/// Most robots that a request can name: ids are two bytes on air.
const MOST_ROBOTS: u32 = 1 << 16;

/// The failure-tolerant connectivity backbone (paper section 4).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BackboneConfig {
    /// Where the workers go and how many links each needs.
    pub targets: TargetsConfig,
    /// When the mission is complete: `Reached`, `Held(seconds)` or `EachVisited`; by default held for 10 s, or for `metrics.hold`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "CompletionConfig")]
    pub completion: Option<CompletionConfig>,
    /// d_s, the safe communication distance: length of the virtual springs, metres.
    #[serde(default = "safe_distance")]
    pub safe_distance: Positive,
    /// d_c, the critical communication distance, metres; above `movement_gate`, within the radio's range.
    #[serde(default = "critical_distance")]
    pub critical_distance: Positive,
    /// d_δ, the movement threshold: a worker this near to its target holds it, metres.
    #[serde(default = "movement_threshold")]
    pub movement_threshold: Positive,
    /// k, the spring constant, 1/s.
    #[serde(default = "spring_gain")]
    pub spring_gain: Positive,
    /// ε of the Lennard-Jones potential between free robots.
    #[serde(default = "lj_epsilon")]
    pub lj_epsilon: NonNegative,
    /// δ of the Lennard-Jones potential, the distance that it settles at, metres.
    #[serde(default = "lj_delta")]
    pub lj_delta: Positive,
    /// Settings of the motion that the paper leaves open.
    #[serde(default)]
    pub motion: ControlLawConfig,
    /// Settings of recruiting that the paper leaves open.
    #[serde(default)]
    pub recruiting: RecruitingConfig,
    /// Settings of healing that the paper leaves open.
    #[serde(default)]
    pub healing: HealingConfig,
    /// Settings of the root that the paper leaves open.
    #[serde(default)]
    pub shortage: ShortageConfig,
    /// How robots elect a new root when it is lost, which faults may then take. By default they do not, and no fault may: the paper, whose future
    /// work this is, takes the root as given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "ElectionConfig")]
    pub election: Option<ElectionConfig>,
}

/// Electing a new root: the robot nearest to the place of the old one, free ones first, by bids that are passed on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ElectionConfig {
    /// Seconds for which a robot near to the root's place suspects the root, and hears others, before it calls an election.
    pub patience: NonNegative,
    /// Seconds for which bids are passed on, at each turn of `gossip.request`: longer than the best takes to reach all.
    pub duration: Positive,
}

impl Default for ElectionConfig {
    fn default() -> Self {
        Self {
            patience: NonNegative::new(1.0),
            duration: Positive::new(5.0),
        }
    }
}

/// Settings of the control laws (paper eq. 8 to 16) that the paper leaves open.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ControlLawConfig {
    /// Distance to a parent, metres, at which the gate f of the worker and the networker has closed; between
    /// `safe_distance` and `critical_distance`. The paper closes it at `safe_distance`, where a spring has no tension:
    /// chains then stay slack and do not reach their targets.
    pub movement_gate: Positive,
    /// k_t, the gain of a worker's attraction to its target, 1/s.
    pub target_gain: Positive,
    /// Springs of a chain are at most this share of its even spacing, so that a finished chain is under tension and
    /// therefore straight. Below 1.
    pub taut_ratio: Probability,
    /// Most that a compressed spring pushes, m/s: a chain that is pushed hard buckles.
    pub push_limit: NonNegative,
    /// Distance between the chains that run side by side to one target, metres.
    pub lane_spacing: NonNegative,
    /// Gain that draws a networker into its chain's lane, 1/s.
    pub lane_gain: NonNegative,
    /// Most that a lane pulls, m/s: enough to bring a networker past one of another chain that stands in its way.
    pub lane_limit: NonNegative,
    /// Speed, m/s, of one unit of the Lennard-Jones potential, in which distances are in units of twice `lj_delta`: metres, in the
    /// paper.
    pub lj_speed: NonNegative,
    /// Distance from edge to body, metres, within which free robots avoid it.
    pub avoidance_range: NonNegative,
    /// The same for robots of the backbone, which have the right of way: at most `avoidance_range`.
    pub backbone_avoidance_range: NonNegative,
    /// Speed away from a body that is touched, m/s.
    pub avoidance_gain: NonNegative,
    /// Commands below this speed, m/s, are none, so that robots at rest stand still.
    pub rest_speed: NonNegative,
    /// A robot that wants to move and does not for this many seconds steps aside in a random direction.
    pub stall_time: Positive,
}

impl Default for ControlLawConfig {
    fn default() -> Self {
        Self {
            movement_gate: Positive::new(1.6),
            target_gain: Positive::new(1.6),
            taut_ratio: Probability::new(0.95),
            push_limit: NonNegative::new(0.05),
            lane_spacing: NonNegative::new(0.35),
            lane_gain: NonNegative::new(0.8),
            lane_limit: NonNegative::new(0.3),
            lj_speed: NonNegative::new(0.001),
            avoidance_range: NonNegative::new(0.2),
            backbone_avoidance_range: NonNegative::new(0.1),
            avoidance_gain: NonNegative::new(0.05),
            rest_speed: NonNegative::new(0.005),
            stall_time: Positive::new(3.0),
        }
    }
}

/// Settings of recruiting that the paper leaves open.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RecruitingConfig {
    /// A robot linked to the root recruits from this far from it on, as a share of its chain's spring length: early, so
    /// that the chain need not wait.
    pub distance_ratio: Positive,
    /// Seconds after which a request without an answer is given up.
    pub patience: Positive,
    /// Seconds for which a robot that refused or did not answer is not asked again.
    pub refusal_memory: NonNegative,
    /// Seconds without a sign after which a join that is not confirmed is undone, at either end.
    pub join_timeout: Positive,
}

impl Default for RecruitingConfig {
    fn default() -> Self {
        Self {
            distance_ratio: Positive::new(0.75),
            patience: Positive::new(2.0),
            refusal_memory: NonNegative::new(10.0),
            join_timeout: Positive::new(4.0),
        }
    }
}

/// Settings of healing that the paper leaves open.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct HealingConfig {
    /// Seconds for which a robot that has lost its child, and the root that hears nothing of a target, wait for those
    /// beyond the break: as long as these may need to come to it.
    pub patience: Positive,
    /// Relays that each chain gets beyond the fewest once the root has learnt that a robot was lost, at most, and fewer
    /// as robots run out. The outermost follows the worker closely, so that a lost worker or relay is replaced within seconds.
    /// 0, the default, for none: the paper's aim is fewest robots. Without failures there is none in any case.
    pub reserve: u8,
}

impl Default for HealingConfig {
    fn default() -> Self {
        Self {
            patience: Positive::new(60.0),
            reserve: 0,
        }
    }
}

/// Settings of the root's dismantling of chains when robots are too few (paper algorithm 3).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ShortageConfig {
    /// Seconds for which too few robots must be predicted before the root acts on it.
    pub patience: Positive,
    /// Seconds for which a target is held before the next one is visited.
    pub visit: Positive,
}

impl Default for ShortageConfig {
    fn default() -> Self {
        Self {
            patience: Positive::new(10.0),
            visit: Positive::new(10.0),
        }
    }
}

fn safe_distance() -> Positive {
    Positive::new(1.4)
}

fn critical_distance() -> Positive {
    Positive::new(1.7)
}

fn movement_threshold() -> Positive {
    Positive::new(0.3)
}

fn spring_gain() -> Positive {
    Positive::new(0.8)
}

fn lj_epsilon() -> NonNegative {
    NonNegative::new(60.0)
}

fn lj_delta() -> Positive {
    Positive::new(0.5)
}

impl BackboneConfig {
    /// Where the targets are, metres from the centre, and how many links each needs.
    #[must_use]
    pub fn targets(&self) -> Vec<(Vec2, u8)> {
        self.targets.places()
    }

    /// The fewest robots that a mission takes: a root, a worker for each target, and for each of its links as many relays as the
    /// distance asks for.
    #[must_use]
    pub fn robots_needed(&self) -> usize {
        let of_target = |(at, links): (Vec2, u8)| 1 + usize::from(links) * self.relays(at.norm());
        1 + self.targets().into_iter().map(of_target).sum::<usize>()
    }

    /// Robots of the longest chain that the targets need, the worker among them, seen from the centre.
    #[must_use]
    pub fn longest_chain(&self) -> usize {
        let relays = |(place, links): (Vec2, u8)| {
            let (threshold, safe) = (self.movement_threshold.get(), self.safe_distance.get());
            relays_needed(place.norm(), threshold, safe).max(usize::from(links > 1))
        };
        self.targets().into_iter().map(relays).max().unwrap_or(0) + 1
    }

    /// What is wrong with these settings together, for `robots` robots that hear each other up to `radio_range` metres:
    /// the field at fault and what would be right.
    #[must_use]
    pub fn own_problems(&self, robots: u32, radio_range: f64) -> Vec<(String, String)> {
        let mut problems = self.distance_problems(radio_range);
        problems.extend(self.target_problems(robots));
        problems
    }

    fn distance_problems(&self, radio_range: f64) -> Vec<(String, String)> {
        let (safe, critical) = (self.safe_distance.get(), self.critical_distance.get());
        let gate = self.motion.movement_gate.get();
        let ranges = [self.motion.avoidance_range, self.motion.backbone_avoidance_range].map(NonNegative::get);
        let rules = [
            (
                gate > safe,
                "motion.movement_gate",
                format!("must be above safe_distance ({safe} m)"),
            ),
            (
                gate < critical,
                "motion.movement_gate",
                format!("must be below critical_distance ({critical} m)"),
            ),
            (
                critical < radio_range,
                "critical_distance",
                format!("must be below the radio's range ({radio_range} m)"),
            ),
            (
                self.motion.taut_ratio.get() > 0.0 && self.motion.taut_ratio.get() < 1.0,
                "motion.taut_ratio",
                "must be above 0 and below 1".into(),
            ),
            (
                self.recruiting.distance_ratio.get() <= 1.0,
                "recruiting.distance_ratio",
                "must be at most 1: beyond the springs' length nobody would be recruited".into(),
            ),
            (
                ranges[1] <= ranges[0],
                "motion.backbone_avoidance_range",
                format!("must be at most avoidance_range ({} m)", ranges[0]),
            ),
        ];
        rules
            .into_iter()
            .filter(|(holds, ..)| !holds)
            .map(|(_, field, message)| (field.to_owned(), message))
            .collect()
    }

    fn target_problems(&self, robots: u32) -> Vec<(String, String)> {
        let targets = self.targets();
        let mut problems = Vec::new();
        let mut complain = |message: String| problems.push(("targets".to_owned(), message));
        if targets.is_empty() {
            complain("there must be at least one target".into());
        }
        if targets.iter().any(|(_, links)| *links == 0) {
            complain("every target needs at least 1 link".into());
        }
        let chains: usize = targets.iter().map(|(_, links)| usize::from(*links)).sum();
        if chains > MOST_CHAINS {
            complain(format!(
                "{chains} links in all: at most {MOST_CHAINS} can be told apart"
            ));
        }
        let longest = targets.iter().map(|(at, _)| self.relays(at.norm())).max().unwrap_or(0);
        if longest >= MOST_CHAINS {
            complain(format!("a chain would need {longest} relays: at most 254 can be named"));
        }
        let needed = 1 + targets.len();
        if (robots as usize) < needed {
            complain(format!(
                "{} targets need at least {needed} robots (a root and a worker each), but there are {robots}",
                targets.len()
            ));
        }
        if robots > MOST_ROBOTS {
            complain(format!("{robots} robots: at most {MOST_ROBOTS} can be named"));
        }
        problems
    }

    /// Relays that a chain to a target `distance` metres from the root needs.
    fn relays(&self, distance: f64) -> usize {
        relays_needed(distance, self.movement_threshold.get(), self.safe_distance.get())
    }
}

#[cfg(test)]
mod tests;
