//! How far a robot may go, or is pulled, so that its links last. Pure functions of places, metres, in the arena's axes.

use crate::geometry::Vec2;

/// A disk: its middle and its radius, metres.
pub type Disk = (Vec2, f64);

/// The disk around the middle of the link between `me` and `other` that both stay in (Aragues et al. 2014).
#[must_use]
pub fn midpoint(me: Vec2, other: Vec2, range: f64, margin: f64) -> Disk {
    ((me + other) / 2.0, range / 2.0 - margin)
}

/// Rounds of projecting on each disk in turn.
const ROUNDS: usize = 8;

/// Where a robot at `from` that wants to be at `to` may go, and whether that is elsewhere than it wants. It stays within all `disks` that
/// it is in; from outside of some, as after news that came late, it makes for them.
#[must_use]
pub fn within(from: Vec2, to: Vec2, disks: &[Disk]) -> (Vec2, bool) {
    if disks.iter().all(|disk| holds(disk, to)) {
        return (to, false);
    }
    if !disks.iter().all(|disk| holds(disk, from)) {
        return (nearest(from, disks), true);
    }
    // What is in all disks is convex: a point near to the wanted one, and from there back along the straight way until all is well.
    let aim = nearest(to, disks);
    let share = disks
        .iter()
        .map(|disk| share_inside(disk, from, aim))
        .fold(1.0, f64::min);
    (from + (aim - from) * share, true)
}

fn holds((middle, radius): &Disk, place: Vec2) -> bool {
    (place - middle).norm_squared() <= radius * radius
}

/// `place`, or a place near to it that is within the disks or nearly so.
fn nearest(mut place: Vec2, disks: &[Disk]) -> Vec2 {
    for _ in 0..ROUNDS {
        for (middle, radius) in disks {
            let off = place - middle;
            let distance = off.norm();
            if distance > *radius {
                place = middle + off * (radius / distance);
            }
        }
    }
    place
}

/// Which share of the straight way from `from`, inside the disk, to `to` is inside of it.
fn share_inside((middle, radius): &Disk, from: Vec2, to: Vec2) -> f64 {
    let (way, off) = (to - from, from - middle);
    let (a, b, c) = (way.norm_squared(), off.dot(&way), off.norm_squared() - radius * radius);
    if a == 0.0 {
        return 1.0;
    }
    // The greater root of a s² + 2 b s + c, where c is not positive.
    ((-b + (b * b - a * c).max(0.0).sqrt()) / a).clamp(0.0, 1.0)
}

/// As near to the range as an edge's tension is told apart, in shares of the range: beyond, it would be infinite.
const STRETCHED: f64 = 0.99;

/// The pull of a link to a robot that is `way` off, whose tension d²/(R − d) is to become less (Ji and Egerstedt 2007): metres of way times
/// (2R − d)/(R − d)².
#[must_use]
pub fn tension(way: Vec2, range: f64) -> Vec2 {
    let distance = way.norm().min(STRETCHED * range);
    way * ((2.0 * range - distance) / (range - distance).powi(2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::unit;
    use proptest::prelude::*;

    #[test]
    fn one_that_is_free_goes_where_it_wants_and_one_that_is_held_to_the_edge_of_its_disk() {
        let disks = [midpoint(Vec2::zeros(), Vec2::new(1.0, 0.0), 2.0, 0.1)];
        let x = |x| Vec2::new(x, 0.0);
        assert_eq!(within(x(0.0), x(-0.2), &disks), (x(-0.2), false));
        let (place, held) = within(x(0.0), x(-3.0), &disks);
        assert!(held && (place - x(-0.4)).norm() < 1e-12);
        assert_eq!(within(x(0.0), x(-9.0), &[]), (x(-9.0), false));
        // One that stands outside comes in.
        let (place, held) = within(x(-2.0), x(-3.0), &disks);
        assert!(held && (place - x(-0.4)).norm() < 1e-9);
    }

    #[test]
    fn the_tension_is_the_gradient_of_its_energy() {
        let energy = |d: f64| d * d / (2.0 - d);
        for d in [0.3, 1.0, 1.7] {
            let h = 1e-6;
            let slope = (energy(d + h) - energy(d - h)) / (2.0 * h);
            let pull = tension(Vec2::new(d, 0.0), 2.0).x;
            assert!((pull - slope).abs() < 1e-6 * slope, "{d}: {pull} against {slope}");
        }
        assert!(tension(Vec2::new(5.0, 0.0), 2.0).x.is_finite());
    }

    proptest! {
        #[test]
        fn two_robots_that_both_stay_in_their_disks_are_never_further_apart_than_the_range(
            apart in 0.05..1.8_f64,
            angle in 0.0..6.3_f64,
            wishes in prop::array::uniform2((-3.0..3.0_f64, -3.0..3.0_f64)),
            others in prop::collection::vec((-1.2..1.2_f64, -1.2..1.2_f64), 0..4),
        ) {
            let places = [Vec2::zeros(), unit(angle) * apart];
            let [one, two] = [0, 1].map(|me| {
                let mut disks = vec![midpoint(places[me], places[1 - me], 2.0, 0.1)];
                disks.extend(others.iter().map(|(x, y)| midpoint(places[me], places[me] + Vec2::new(*x, *y), 2.0, 0.1)));
                let wish = Vec2::new(wishes[me].0, wishes[me].1);
                within(places[me], wish, &disks).0
            });
            prop_assert!((one - two).norm() <= 1.8 + 1e-9);
        }
    }
}
