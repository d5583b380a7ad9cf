//! The free robot: waits in the cluster around the root, and makes way (paper algorithm 3, eq. 17 and 18).

use crate::geometry::Vec2;
use crate::protocol::steering::forces;

use super::message::Role;
use super::view::View;

/// Distance between centres, in multiples of the avoidance range, within which a free robot makes way for one of the
/// backbone: before that one would have to avoid it.
const MAKE_WAY: f64 = 2.0;

/// The velocity of a free robot, or of one that waits like one (paper eq. 18).
#[must_use]
pub fn velocity(view: &View<'_>) -> Vec2 {
    let parameters = view.parameters();
    let root = view.way_to_root();
    // Beyond the safe distance the cluster is out of the potential's reach: a spring brings the robot back (ours).
    let back = forces::stay_within(root, parameters.safe, parameters.spring_gain);
    let desired = forces::lennard_jones(root, parameters.lj_gain, parameters.lj_delta) + back + among_neighbours(view);
    desired + view.avoidance(desired, parameters.avoidance_range)
}

fn among_neighbours(view: &View<'_>) -> Vec2 {
    let parameters = view.parameters();
    let make_way = MAKE_WAY * parameters.avoidance_range;
    view.neighbours.iter().fold(Vec2::zeros(), |sum, other| {
        let way = other.position - view.position;
        match other.status.role {
            Role::Free => sum + forces::lennard_jones(way, parameters.lj_gain, parameters.lj_delta),
            Role::Networker | Role::Worker if way.norm_squared() < make_way * make_way => {
                sum + forces::obstacle(Vec2::zeros(), &[way], make_way, parameters.avoidance_gain)
            }
            _ => sum,
        }
    })
}
