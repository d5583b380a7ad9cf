//! What a robot does that hears nobody (ours). Either all robots around it are gone or its own radio is dead, and it
//! cannot tell which. So it goes where its radio would tell it: to a place within reach of the root, but beside all
//! chains, where it is in nobody's way if it stays deaf. On the way it keeps its duty, for it may meet those who look
//! for it; near the root it gives it up.

use std::f64::consts::TAU;

use crate::geometry::{Vec2, unit};
use crate::protocol::steering::forces;

use super::view::View;

/// How near to its waiting place a robot stops, in safe distances.
const NEAR: f64 = 0.15;
/// Share of the angle between two targets over which robots that wait there spread.
const SPREAD: f64 = 0.4;
/// Fractional part of the golden ratio: its multiples spread evenly.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Whether a robot that hears nobody must be deaf: it is so near to the root that a robot with a radio would hear it, or
/// at its waiting place, where it stops.
#[must_use]
pub fn must_be_deaf(view: &View<'_>) -> bool {
    view.way_to_root().norm() <= view.parameters().critical || is_waiting(view)
}

fn is_waiting(view: &View<'_>) -> bool {
    (waiting_place(view) - view.position).norm() <= NEAR * view.parameters().safe
}

/// The velocity of a robot that hears nobody.
#[must_use]
pub fn velocity(view: &View<'_>) -> Vec2 {
    let parameters = view.parameters();
    if is_waiting(view) {
        return Vec2::zeros();
    }
    let way = waiting_place(view) - view.position;
    let desired = forces::target(way, parameters.target_gain);
    desired + view.avoidance(desired, parameters.avoidance_range)
}

/// Midway between the directions of the two targets that the robot is between, at the critical distance from the root:
/// within the radio's range, and out of the cluster.
fn waiting_place(view: &View<'_>) -> Vec2 {
    let bearing = |place: Vec2| (place - view.mission.origin).y.atan2((place - view.mission.origin).x);
    let own = bearing(view.position);
    let to_target = |target: &super::mission::Target| (bearing(target.at) - own).rem_euclid(TAU);
    let targets = view.mission.targets.iter().map(to_target);
    let (next, last) = targets.fold((TAU, 0.0_f64), |(next, last), angle| (next.min(angle), last.max(angle)));
    // The target before is the one that is last on the way round, less a whole turn.
    let gap = next - (last - TAU);
    let spread = SPREAD * ((f64::from(view.id.0) * GOLDEN).fract() - 0.5);
    let angle = own + next - gap * (0.5 + spread);
    view.mission.origin + unit(angle) * view.parameters().critical
}
