//! What a scenario says about local trees.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::protocol::{CompletionConfig, TargetsConfig};
use crate::quantity::{NonNegative, Positive};

/// Most robots whose ids fit the two bytes that a message has for each.
const MOST_ROBOTS: u32 = 1 << 16;

/// Local minimum spanning trees with kept links: each robot builds the tree of the robots that it hears, and stays linked to those that are next to it
/// there. (Li, Hou and Sha 2003 for the tree; Aragues et al. 2014, and Ji and Egerstedt 2007, for staying linked.)
///
/// ```
/// let text = r#"Scenario(
///     name: "local",
///     time_limit: 15.0,
///     swarm: (robots: 20, deploy: Cluster(radius: 2.0)),
///     protocol: LocalTree(memory: 5, links: Union),
///     motion: (max_speed: 0.2),
///     wander: RandomWalk(speed: 0.2, leg: 4.0),
///     radio: (loss: Bernoulli(0.2)),
/// )"#;
/// assert!(desim::scenario::parse("local.ron", text, &[]).is_ok());
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LocalTreeConfig {
    /// Where workers go, one link each. Without targets, the default, all robots move as `wander` says.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "TargetsConfig")]
    pub targets: Option<TargetsConfig>,
    /// When the mission is complete: `Reached`, `Held(seconds)` or `EachVisited`; by default held for 10 s, or for `metrics.hold`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "CompletionConfig")]
    pub completion: Option<CompletionConfig>,
    /// Control steps for which a robot still counts as a neighbour after the one at which it was heard: with 0, only who was heard since the last step.
    pub memory: u16,
    /// Which links a robot keeps of those that it and its neighbours have in their trees.
    pub links: Links,
    /// When a robot builds its tree anew.
    pub renew: Renew,
    /// How a robot stays linked.
    pub keep: Keep,
    /// How fast a robot without a duty follows the middle of those that it is linked to, 1/s (ours: the sources say nothing of robots without a
    /// task). Without targets nobody follows.
    pub follow_gain: NonNegative,
    /// A worker this near to its target holds it, metres.
    pub movement_threshold: Positive,
    /// Gain of a worker's attraction to its target, 1/s.
    pub target_gain: Positive,
    /// Distance from edge to body, metres, within which robots avoid it.
    pub avoidance_range: NonNegative,
    /// Speed away from a body that is touched, m/s.
    pub avoidance_gain: NonNegative,
}

impl Default for LocalTreeConfig {
    fn default() -> Self {
        Self {
            targets: None,
            completion: None,
            memory: 5,
            links: Links::Union,
            renew: Renew::EachStep,
            keep: Keep::default(),
            follow_gain: NonNegative::new(0.8),
            movement_threshold: Positive::new(0.3),
            target_gain: Positive::new(1.6),
            avoidance_range: NonNegative::new(0.1),
            avoidance_gain: NonNegative::new(0.05),
        }
    }
}

/// Which links a robot keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Links {
    /// Those that it or the other has: a robot honours whoever counts on it.
    Union,
    /// Those that both have.
    Intersection,
}

/// When a robot builds its tree anew.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Renew {
    /// At each control step.
    EachStep,
    /// When one of its tree is heard no more, or holds it back from where it wants to go (Aragues et al. 2014).
    WhenHeldBack,
}

/// How a robot stays linked.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Keep {
    /// Within a disk around the middle of each link, half the radio's range less a margin wide: then two robots that know where
    /// they are never part (Aragues et al. 2014).
    Midpoint {
        /// By how much the disks are smaller, metres: what two robots may move while the one knows of the other's place.
        #[serde(default = "margin")]
        margin: NonNegative,
    },
    /// Pulled by an edge tension d²/(R − d), whose gradient is (2R − d)/(R − d)² a metre (Ji and Egerstedt 2007), at most at full speed and before
    /// anything else: bounded so, it is no proof any more that links last.
    Tension {
        /// Speed of one unit of it, m²/s.
        gain: Positive,
    },
}

impl Default for Keep {
    fn default() -> Self {
        Self::Midpoint { margin: margin() }
    }
}

fn margin() -> NonNegative {
    NonNegative::new(0.1)
}

impl LocalTreeConfig {
    /// What is wrong with these settings together, for `robots` robots that hear each other up to `range` metres and move
    /// at up to `speed` m/s: the field at fault and what would be right.
    #[must_use]
    pub fn own_problems(&self, robots: u32, range: f64) -> Vec<(String, String)> {
        let mut found = Vec::new();
        let mut complain = |field: &str, message: String| found.push((field.to_owned(), message));
        if let Keep::Midpoint { margin } = self.keep
            && margin.get() >= range / 2.0
        {
            complain(
                "keep",
                format!(
                    "a margin of {} m leaves nothing of half the radio's range ({} m): make it less",
                    margin.get(),
                    range / 2.0
                ),
            );
        }
        if robots > MOST_ROBOTS {
            complain("", format!("{robots} robots: at most {MOST_ROBOTS} can be named"));
        }
        let Some(targets) = self.targets.as_ref().map(TargetsConfig::places) else {
            if self.completion.is_some() {
                complain(
                    "completion",
                    "there are no targets, and so no mission to complete: leave it out, or give `targets`".into(),
                );
            }
            return found;
        };
        if targets.is_empty() {
            complain(
                "targets",
                "there must be at least one target; leave the field out for robots that wander".into(),
            );
        }
        if let Some(target) = targets.iter().position(|(_, links)| *links != 1) {
            complain(
                "targets",
                format!(
                    "target {target} needs {} links: a tree gives each one",
                    targets[target].1
                ),
            );
        }
        if (robots as usize) < 1 + targets.len() {
            complain(
                "targets",
                format!(
                    "{} targets need at least {} robots (a root and a worker each), but there are {robots}",
                    targets.len(),
                    1 + targets.len()
                ),
            );
        }
        found
    }
}
