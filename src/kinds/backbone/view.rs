//! What a robot knows whatever its role, and what its role routine may look at when it decides.

use std::rc::Rc;

use crate::engine::ActorId;
use crate::geometry::Vec2;
use crate::protocol::steering::forces;

use super::message::{Order, Role};
use super::mission::{Mission, Parameters};
use super::neighbours::{Neighbour, Neighbours};
use crate::protocol::detector::Detector;
use crate::protocol::gossip::Turns;

/// What a robot knows whatever its role.
#[derive(Debug)]
pub struct Knowledge {
    /// The robot itself.
    pub id: ActorId,
    /// The mission.
    pub mission: Rc<Mission>,
    /// Its control steps so far.
    pub step: u64,
    /// Where it is, metres, in the arena's axes.
    pub position: Vec2,
    /// Whom it heard of late.
    pub neighbours: Neighbours,
    /// Whom it believes to be down.
    pub detector: Detector,
    /// The newest order that it knows of.
    pub order: Order,
    /// Whom it takes for the root.
    pub root: ActorId,
}

impl Knowledge {
    /// The view of it for one control step, with near bodies as sensed then.
    #[must_use]
    pub fn view<'a>(&'a self, proximity: &'a [Vec2]) -> View<'a> {
        View {
            id: self.id,
            step: self.step,
            position: self.position,
            proximity,
            neighbours: &self.neighbours,
            mission: &self.mission,
            order: self.order,
            root: self.root,
        }
    }
}

/// A robot's view at one control step.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The robot itself.
    pub id: ActorId,
    /// Its control steps so far.
    pub step: u64,
    /// Where it is, metres, in the arena's axes.
    pub position: Vec2,
    /// Vectors from its edge to near bodies.
    pub proximity: &'a [Vec2],
    /// Whom it heard of late.
    pub neighbours: &'a Neighbours,
    /// The mission.
    pub mission: &'a Mission,
    /// What is to be expanded.
    pub order: Order,
    /// The root.
    pub root: ActorId,
}

impl<'a> View<'a> {
    /// Whether it has its turn on a topic.
    #[must_use]
    pub fn has_turn(&self, turns: &Turns) -> bool {
        turns.is_due(self.id, self.step)
    }

    /// The settings.
    #[must_use]
    pub fn parameters(&self) -> &'a Parameters {
        &self.mission.parameters
    }

    /// The way to the root, which stands where the mission says.
    #[must_use]
    pub fn way_to_root(&self) -> Vec2 {
        self.mission.origin - self.position
    }

    /// The way to `robot`, if it is the root or was heard of late.
    #[must_use]
    pub fn way_to(&self, robot: ActorId) -> Option<Vec2> {
        if robot == self.root {
            Some(self.way_to_root())
        } else {
            self.neighbours.get(robot).map(|known| known.position - self.position)
        }
    }

    /// What keeps it clear of bodies within `range` metres of its edge where it wants to go at `desired` (u^obstacle).
    #[must_use]
    pub fn avoidance(&self, desired: Vec2, range: f64) -> Vec2 {
        forces::obstacle(desired, self.proximity, range, self.parameters().avoidance_gain)
    }

    /// Whether chain number `chain` is to be built or kept.
    #[must_use]
    pub fn expands(&self, chain: u8) -> bool {
        self.order.expands(self.mission.chain(chain).target)
    }

    /// Relays that chain number `chain` is to have: the fewest that will do, and those in reserve.
    #[must_use]
    pub fn relays_wanted(&self, chain: u8) -> usize {
        self.mission.chain(chain).relays + usize::from(self.order.reserve)
    }

    /// The worker of target number `target`, if it was heard of late.
    #[must_use]
    pub fn worker_of(&self, target: u8) -> Option<&'a Neighbour> {
        let chain = self.mission.targets[usize::from(target)].chains.start;
        let is_it = |known: &&Neighbour| known.status.role == Role::Worker && known.status.chain == chain;
        self.neighbours.iter().find(is_it)
    }

    /// How many networkers of target number `target` in sight are nearer to it than this robot.
    #[must_use]
    pub fn networkers_nearer_to(&self, target: u8) -> usize {
        let plan = &self.mission.targets[usize::from(target)];
        let distance = |position: Vec2| (position - plan.at).norm_squared();
        let own = distance(self.position);
        let is_nearer = |known: &&Neighbour| {
            known.status.role == Role::Networker
                && plan.chains.contains(&known.status.chain)
                && distance(known.position)
                    .total_cmp(&own)
                    .then(known.id.cmp(&self.id))
                    .is_lt()
        };
        self.neighbours.iter().filter(is_nearer).count()
    }

    /// Whether nobody was heard of late, though somebody must have been: all others are gone or its own radio is dead.
    #[must_use]
    pub fn is_isolated(&self) -> bool {
        self.step > self.parameters().silence_steps && self.neighbours.is_empty()
    }
}
