//! The targets of missions that send robots out, and who goes to which.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::engine::ActorId;
use crate::geometry::{Pose, Vec2, unit};
use crate::quantity::{Finite, Positive};

/// The targets of a mission: where robots are to go, and how many links each place needs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum TargetsConfig {
    /// Equally spaced on a circle around the centre, the first on the positive x axis (paper section 5.1: four, 90° apart).
    Ring {
        /// How many.
        count: u8,
        /// Their distance from the centre, metres.
        radius: Positive,
        /// Links that each needs, at least 1.
        #[schemars(range(min = 1))]
        #[serde(default = "one_link")]
        links: u8,
    },
    /// Each by its place.
    At(Vec<TargetConfig>),
}

/// One target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TargetConfig {
    /// Place in metres from the centre.
    pub at: (Finite, Finite),
    /// Links that it needs, at least 1.
    #[schemars(range(min = 1))]
    #[serde(default = "one_link")]
    pub links: u8,
}

fn one_link() -> u8 {
    1
}

impl TargetsConfig {
    /// Where the targets are, metres from the centre, and how many links each needs.
    #[must_use]
    pub fn places(&self) -> Vec<(Vec2, u8)> {
        match self {
            Self::Ring { count, radius, links } => (0..*count)
                .map(|index| {
                    let angle = std::f64::consts::TAU * f64::from(index) / f64::from(*count);
                    (unit(angle) * radius.get(), *links)
                })
                .collect(),
            Self::At(targets) => targets
                .iter()
                .map(|target| (Vec2::new(target.at.0.get(), target.at.1.get()), target.links))
                .collect(),
        }
    }

    /// Where target number `index` is said, from the protocol's section on, and what to do if it lies badly.
    #[must_use]
    pub fn field(&self, index: usize) -> (String, &'static str) {
        match self {
            Self::Ring { .. } => (
                "targets".to_owned(),
                "make the ring's radius less or the arena larger, or move what stands in the way",
            ),
            Self::At(_) => (format!("targets[{index}].at"), "move it, or what stands in its way"),
        }
    }
}

/// Who starts with which duty: the robot nearest to the centre is the root, and of the others the one nearest to a target, target by target, is its
/// worker.
///
/// ```
/// use desim::engine::ActorId;
/// use desim::geometry::{Pose, Vec2};
/// use desim::protocol::Assignment;
///
/// let at = |x| Pose { position: Vec2::new(x, 0.0), heading: 0.0 };
/// let places = [Vec2::new(9.0, 0.0), Vec2::new(8.0, 0.0)];
/// let duties = Assignment::nearest(&[at(2.0), at(-0.5), at(1.0)], places.into_iter());
/// assert_eq!(duties.root, ActorId(1));
/// assert_eq!(duties.workers, [ActorId(0), ActorId(2)]);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assignment {
    /// The robot at the base.
    pub root: ActorId,
    /// The worker of each target, in order of targets.
    pub workers: Vec<ActorId>,
}

impl Assignment {
    /// That of robots that start at `poses`, with targets at `places`. Of two that are equally near the one with the lower number is taken.
    ///
    /// # Panics
    /// If there are fewer robots than a root and a worker a target.
    #[must_use]
    pub fn nearest(poses: &[Pose], places: impl Iterator<Item = Vec2>) -> Self {
        let mut assigned = vec![false; poses.len()];
        let mut nearest = |place: Vec2| {
            let free = (0..poses.len()).filter(|&robot| !assigned[robot]);
            let robot = free.min_by(|&a, &b| {
                let distance = |robot: usize| (poses[robot].position - place).norm_squared();
                distance(a).total_cmp(&distance(b))
            });
            let robot = robot.expect("a checked scenario has a robot for the root and for each target");
            assigned[robot] = true;
            ActorId(robot as u32)
        };
        Self {
            root: nearest(Vec2::zeros()),
            workers: places.map(nearest).collect(),
        }
    }

    /// The target that `robot` is the worker of, by its place in the list of targets.
    #[must_use]
    pub fn target_of(&self, robot: ActorId) -> Option<usize> {
        self.workers.iter().position(|worker| *worker == robot)
    }
}
