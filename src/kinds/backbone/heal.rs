//! Healing: how the two ends of a broken chain find each other again (paper section 4.3, algorithms 1 and 2).
//!
//! A robot whose parent is lost goes to where it was last heard and on towards the root, never so far that it loses
//! another neighbour of its chains. On the way it asks a robot of its own chain that is nearer to the root and has lost
//! its child to become its parent, until it is near enough to the root to be linked to it. A robot whose child is lost
//! goes to where that one was last heard, never so far that it loses its parent, passes on a need to grow, for the chain
//! has one robot less, and waits to be asked. The root, which never moves, sends a free robot in its stead. So both ends
//! take their half, and the robot that replaces the failed one comes in at the root's end.
//!
//! A hop takes about a minute at the paper's pace. Where the scenario asks for it (`healing.reserve`, ours), chains get relays in
//! reserve from the first lost robot on (the root orders them, `shortage.rs`): gaps are then shorter than a hop, and the outermost
//! relay, which follows the worker closely, takes over from it within seconds. By default, and without a failure, chains have the
//! fewest robots.

use crate::engine::ActorId;
use crate::geometry::Vec2;
use crate::protocol::steering::forces;

use super::message::Role;
use super::neighbours::Neighbour;
use super::view::View;

/// How near to a lost robot's last place, in safe distances, another one need not go on looking for it.
const THERE: f64 = 0.25;

/// A break between a robot and its parent: until it is mended, the root stands for the parent, however far it is.
#[derive(Debug, Default)]
pub struct Break {
    /// Where the parent was last heard, until the robot has been there.
    pub place: Option<Vec2>,
    /// A robot that agreed to become the parent, or says that it is.
    pub offer: Option<ActorId>,
}

impl Break {
    /// The way to go: to the lost parent's place, and then to the root.
    #[must_use]
    pub fn way(&self, view: &View<'_>) -> Vec2 {
        self.place
            .map_or_else(|| view.way_to_root(), |place| place - view.position)
    }

    /// Ends the search at the lost parent's place when the robot is there.
    pub fn look_around(&mut self, view: &View<'_>) {
        let there = THERE * view.parameters().safe;
        if self.place.is_some_and(|place| (place - view.position).norm() <= there) {
            self.place = None;
        }
    }
}

/// Whether `known` can be the parent of this robot in `chain`: a relay of it within reach. Of a relay itself, which knows
/// `descendants` on the side of the worker, none of these can, and none that is farther from the root, by which no two
/// relays ever choose each other. A worker, of which nobody descends, has `None`.
#[must_use]
pub fn can_serve(view: &View<'_>, known: &Neighbour, chain: u8, descendants: Option<&[ActorId]>) -> bool {
    let from_root = |place: Vec2| (place - view.mission.origin).norm_squared();
    let is_upstream = |descendants: &[ActorId]| {
        !descendants.contains(&known.id) && from_root(known.position) < from_root(view.position)
    };
    known.status.role == Role::Networker
        && known.status.chain == chain
        && (known.position - view.position).norm() <= view.parameters().critical
        && descendants.is_none_or(is_upstream)
}

/// The velocity, without avoidance, of a robot at a break that goes `way` while `ties` lead to those that it must not
/// lose: slower from the gate on, and back from the critical distance on.
#[must_use]
pub fn velocity(view: &View<'_>, way: Vec2, ties: impl Iterator<Item = Vec2>) -> Vec2 {
    let parameters = view.parameters();
    let mut farthest = 0.0_f64;
    let tension = ties.fold(Vec2::zeros(), |sum, tie| {
        farthest = farthest.max(tie.norm());
        sum + forces::stay_within(tie, parameters.gate, parameters.spring_gain)
    });
    let open = forces::gate(farthest, parameters.gate, parameters.critical);
    forces::target(way, parameters.target_gain) * open + tension
}
