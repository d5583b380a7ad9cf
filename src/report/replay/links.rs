//! Links of a film where they do not follow from distances alone: at some of its instants, as pairs that appear or vanish since the one
//! before.

use super::film::{Film, QUANTUM_M};
use crate::engine::ActorId;
use crate::geometry::Vec2;
use crate::radio::{Placed, Reach};

/// Pairs near each other that are looked at, all instants together.
const MOST_PAIRS: u64 = 20_000_000;
/// Changes that a page has room for.
const MOST_TOGGLES: usize = 2_000_000;

/// Links as they come and go.
#[derive(Debug, Default)]
pub struct Toggles {
    /// Instants of the film from one look to the next.
    pub every: usize,
    /// Where the changes of each look begin, and where the last ones end.
    pub first: Vec<u32>,
    /// Pairs, the lower number first.
    pub pairs: Vec<[u32; 2]>,
}

impl Toggles {
    /// Of robots that hear each other as `reach` says.
    pub fn of(film: &Film, reach: &Reach) -> Self {
        let robots = film.robots();
        let instants = film.instants();
        let mut toggles = Self {
            every: 1,
            first: vec![0],
            pairs: Vec::new(),
        };
        if robots == 0 {
            return toggles;
        }
        let mut before: Vec<[u32; 2]> = Vec::new();
        let mut looks = 0;
        let mut instant = 0;
        while instant < instants {
            let (now, asked) = links(&film.places[instant * robots..][..robots], reach);
            if looks == 0 {
                let looks = (MOST_PAIRS / asked.max(1)).max(1) as usize;
                toggles.every = instants.div_ceil(looks).max(1);
            }
            differences(&before, &now, &mut toggles.pairs);
            toggles.first.push(toggles.pairs.len() as u32);
            before = now;
            looks += 1;
            instant += toggles.every;
            if toggles.pairs.len() > MOST_TOGGLES {
                break;
            }
        }
        toggles
    }

    /// How often links were looked at.
    pub fn looks(&self) -> usize {
        self.first.len() - 1
    }
}

/// The pairs that hear each other, sorted, and how many were near enough to be asked about.
fn links(places: &[[i32; 2]], reach: &Reach) -> (Vec<[u32; 2]>, u64) {
    let place = |quanta: [i32; 2]| Vec2::new(f64::from(quanta[0]) * QUANTUM_M, f64::from(quanta[1]) * QUANTUM_M);
    let mut robots: Vec<Placed> = (0..).map(ActorId).zip(places.iter().copied().map(place)).collect();
    robots.sort_by(|a, b| a.1.x.total_cmp(&b.1.x).then(a.0.cmp(&b.0)));
    let farthest = reach.farthest();
    let (mut found, mut asked) = (Vec::new(), 0);
    for (index, &robot) in robots.iter().enumerate() {
        let ahead = robots[index + 1..].iter();
        for &other in ahead.take_while(|other| other.1.x - robot.1.x <= farthest) {
            asked += 1;
            if reach.linked(robot, other) {
                found.push([robot.0.0.min(other.0.0), robot.0.0.max(other.0.0)]);
            }
        }
    }
    found.sort_unstable();
    (found, asked)
}

/// What is in one of two sorted lists alone.
fn differences(before: &[[u32; 2]], now: &[[u32; 2]], into: &mut Vec<[u32; 2]>) {
    let (mut old, mut new) = (before.iter().peekable(), now.iter().peekable());
    loop {
        match (old.peek(), new.peek()) {
            (Some(a), Some(b)) if a == b => {
                old.next();
                new.next();
            }
            (Some(a), Some(b)) if a < b => into.extend(old.next()),
            (Some(_), None) => into.extend(old.next()),
            (_, Some(_)) => into.extend(new.next()),
            (None, None) => return,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_appears_and_what_vanishes_is_toggled_and_what_stays_is_not() {
        let mut changed = Vec::new();
        differences(
            &[[0, 1], [0, 2], [3, 4]],
            &[[0, 2], [0, 5], [3, 4], [7, 8]],
            &mut changed,
        );
        assert_eq!(changed, [[0, 1], [0, 5], [7, 8]]);
    }

    #[test]
    fn pairs_within_the_range_are_linked_each_once() {
        let places = [[0, 0], [900, 0], [0, 1000], [5000, 0], [5000, 999]];
        let (found, _) = links(&places, &Reach::Disk(1.0));
        assert_eq!(found, [[0, 1], [0, 2], [3, 4]]);
    }
}
