//! The virtual forces that robots move by, as velocities (paper section 4). All are pure functions of relative
//! positions: vectors from this robot to the other, metres, in the arena's axes; results in m/s.

use crate::geometry::{Vec2, clamp_length, direction};

/// u_ij = k (d_ij − d_s) towards the other robot (paper eq. 9): it pulls beyond `rest` and pushes below, there by
/// `push_limit` at most (ours, for a chain that is pushed hard buckles).
#[must_use]
pub fn spring(other: Vec2, rest: f64, gain: f64, push_limit: f64) -> Vec2 {
    let distance = other.norm();
    if distance == 0.0 {
        return Vec2::zeros();
    }
    other * ((gain * (distance - rest)).max(-push_limit) / distance)
}

/// Towards the other robot as a spring of length `limit` pulls beyond it, and nothing below.
#[must_use]
pub fn stay_within(other: Vec2, limit: f64, gain: f64) -> Vec2 {
    if other.norm() > limit {
        spring(other, limit, gain, 0.0)
    } else {
        Vec2::zeros()
    }
}

/// The gate f (paper eq. 13 and 16), which takes a robot's other intentions away when its chain is stretched: 1 up to
/// `opening`, 0 from `closing` on, falling evenly between, so that robots come to rest there and do not chatter.
#[must_use]
pub fn gate(distance: f64, opening: f64, closing: f64) -> f64 {
    ((closing - distance) / (closing - opening)).clamp(0.0, 1.0)
}

/// u^target = k_t times the way to the target (paper eq. 12, whose sign there points away from it).
#[must_use]
pub fn target(way: Vec2, gain: f64) -> Vec2 {
    way * gain
}

/// u^lj (paper eq. 17): away from the other robot below `delta`, towards it beyond. `epsilon` is in m²/s. Two robots never stand in
/// one place, though a sensed distance may come out as zero: it counts as a fiftieth of `delta` at least.
#[must_use]
pub fn lennard_jones(other: Vec2, epsilon: f64, delta: f64) -> Vec2 {
    let squared = other.norm_squared().max((delta / 50.0).powi(2));
    let ratio = delta * delta / squared;
    other * (-epsilon / squared * (ratio * ratio - ratio))
}

/// u^obstacle: what near `bodies` (vectors from this robot's edge to each) change about the velocity `desired`. Within
/// `range`, the nearer the more, motion into a body is turned aside, to the side that it leans to already or, head on,
/// to the right, so that robots slide past each other; and the body repels with up to `gain`.
#[must_use]
pub fn obstacle(desired: Vec2, bodies: &[Vec2], range: f64, gain: f64) -> Vec2 {
    bodies.iter().fold(Vec2::zeros(), |change, &body| {
        let distance = body.norm();
        if distance >= range {
            return change;
        }
        let nearness = 1.0 - distance / range;
        let towards = direction(body);
        let inward = (desired + change).dot(&towards).max(0.0);
        let left = Vec2::new(-towards.y, towards.x);
        let side = if desired.dot(&left) > 0.0 { left } else { -left };
        change + (side - towards) * (inward * nearness) - towards * (gain * nearness * nearness)
    })
}

/// The pull of a chain's lane (ours): across the chain, whose left is the unit vector `left`, over the signed distance
/// `offset` to the lane, metres to the left; by `limit` at most.
#[must_use]
pub fn lane_pull(offset: f64, left: Vec2, gain: f64, limit: f64) -> Vec2 {
    left * (gain * offset).clamp(-limit, limit)
}

/// `first` as fast as it may be, and of `then` what is left of `limit`, m/s, so that what must be is never given up for what is wanted.
#[must_use]
pub fn in_order(first: Vec2, then: Vec2, limit: f64) -> Vec2 {
    let first = clamp_length(first, limit);
    first + clamp_length(then, limit - first.norm())
}

/// Shortens `velocity` by `rest_speed`, to zero if it is no faster: small commands fade out, and robots stand still.
#[must_use]
pub fn settle(velocity: Vec2, rest_speed: f64) -> Vec2 {
    let speed = velocity.norm();
    if speed <= rest_speed {
        Vec2::zeros()
    } else {
        velocity * (1.0 - rest_speed / speed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: Vec2, b: Vec2) -> bool {
        (a - b).norm() < 1e-12
    }

    #[test]
    fn a_spring_pulls_in_proportion_beyond_its_length_and_pushes_within_bounds_below_it() {
        let at = |x| spring(Vec2::new(x, 0.0), 1.4, 0.8, 0.05);
        assert!(close(at(1.5), Vec2::new(0.08, 0.0)));
        assert!(close(at(1.38), Vec2::new(-0.016, 0.0)));
        assert!(close(at(0.5), Vec2::new(-0.05, 0.0)));
        assert!(close(at(0.0), Vec2::zeros()));
    }

    #[test]
    fn the_gate_is_open_when_near_shut_when_far_and_half_way_in_the_middle() {
        let at = |distance| gate(distance, 1.5, 1.6);
        assert_eq!((at(1.0), at(1.7)), (1.0, 0.0));
        assert!((at(1.55) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn the_target_attracts() {
        assert!(close(target(Vec2::new(0.0, -2.0), 1.5), Vec2::new(0.0, -3.0)));
    }

    #[test]
    fn the_lennard_jones_potential_repels_attracts_and_rests_as_in_its_closed_form() {
        let at = |x: f64| lennard_jones(Vec2::new(x, 0.0), 60.0, 0.5).x;
        assert!(at(0.5).abs() < 1e-12);
        assert!(at(0.3) < 0.0 && at(0.9) > 0.0);
        let closed_form = |x: f64| -60.0 / x * ((0.5 / x).powi(4) - (0.5 / x).powi(2));
        for x in [0.2, 0.4, 0.7, 1.5] {
            assert!((at(x) - closed_form(x)).abs() < 1e-9);
        }
        assert!(at(0.0).is_finite());
    }

    #[test]
    fn motion_into_a_touched_body_turns_fully_aside_and_motion_away_is_left_alone() {
        let bodies = [Vec2::new(1e-9, 0.0)];
        let desired = Vec2::new(1.0, 0.2);
        let turned = desired + obstacle(desired, &bodies, 0.2, 0.0);
        assert!((turned - Vec2::new(0.0, 1.2)).norm() < 1e-6);
        let away = Vec2::new(-1.0, 0.2);
        assert!(obstacle(away, &bodies, 0.2, 0.0).norm() < 1e-9);
    }

    #[test]
    fn robots_that_meet_head_on_each_turn_to_their_right() {
        let body = |x: f64| [Vec2::new(x, 0.0)];
        assert!(obstacle(Vec2::new(1.0, 0.0), &body(0.1), 0.2, 0.0).y < 0.0);
        assert!(obstacle(Vec2::new(-1.0, 0.0), &body(-0.1), 0.2, 0.0).y > 0.0);
    }

    #[test]
    fn a_body_repels_with_the_gain_when_touched_and_not_at_all_from_the_range_on() {
        let at = |x: f64| obstacle(Vec2::zeros(), &[Vec2::new(x, 0.0)], 0.2, 0.05).x;
        assert!((at(1e-12) + 0.05).abs() < 1e-6);
        assert!((at(0.1) + 0.0125).abs() < 1e-12);
        assert!(at(0.2).abs() < 1e-12);
    }

    #[test]
    fn a_lane_pulls_across_the_chain_in_proportion_up_to_its_limit() {
        let west = Vec2::new(-1.0, 0.0);
        assert!(close(lane_pull(0.02, west, 0.5, 0.05), Vec2::new(-0.01, 0.0)));
        assert!(close(lane_pull(-2.0, west, 0.5, 0.05), Vec2::new(0.05, 0.0)));
    }

    #[test]
    fn what_must_be_comes_first_and_both_together_stay_within_the_limit() {
        let x = |x| Vec2::new(x, 0.0);
        let y = |y| Vec2::new(0.0, y);
        assert!(close(in_order(x(0.5), y(9.0), 2.0), Vec2::new(0.5, 1.5)));
        assert!(close(in_order(x(5.0), y(9.0), 2.0), x(2.0)));
        assert!(close(in_order(Vec2::zeros(), y(1.0), 2.0), y(1.0)));
        assert!(
            close(in_order(x(2.0), x(-9.0), 2.0), x(2.0)),
            "nothing is left to turn back with"
        );
    }

    #[test]
    fn slow_commands_are_none_and_fast_ones_lose_as_much() {
        assert!(close(settle(Vec2::new(0.004, 0.0), 0.005), Vec2::zeros()));
        assert!(close(settle(Vec2::new(0.0, 0.015), 0.005), Vec2::new(0.0, 0.01)));
    }
}
