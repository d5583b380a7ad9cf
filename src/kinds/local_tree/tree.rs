//! The minimum spanning tree of what one robot sees (Li, Hou and Sha 2003, section 2).

use crate::engine::ActorId;
use crate::geometry::{Vec2, at_most};

/// A robot and where it is, metres.
pub type Placed = (ActorId, Vec2);

/// What an edge is worth: its length, and of two that are equally long the ids of its ends, so that no two are worth the same and everyone who
/// sees the same robots has the same tree.
type Weight = (f64, ActorId, ActorId);

fn weight(a: Placed, b: Placed) -> Weight {
    ((a.1 - b.1).norm_squared(), a.0.min(b.0), a.0.max(b.0))
}

fn lighter(a: &Weight, b: &Weight) -> bool {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)).is_lt()
}

/// Those next to `me` in the minimum spanning tree of `me` and the `others`, over edges of at most `range` metres: at most six, in order of ids. It
/// takes time with the square of their number, which is that of the robots in range.
pub fn neighbours(me: Placed, others: &[Placed], range: f64, out: &mut Vec<ActorId>) {
    out.clear();
    let range = at_most(range);
    // Of each robot outside the tree, its lightest edge into it, and whether that ends at `me`: Prim's algorithm, from `me` on.
    let mut outside: Vec<(Placed, Weight, bool)> =
        others.iter().map(|other| (*other, weight(me, *other), true)).collect();
    while !outside.is_empty() {
        let mut nearest = 0;
        for candidate in 1..outside.len() {
            if lighter(&outside[candidate].1, &outside[nearest].1) {
                nearest = candidate;
            }
        }
        let (joined, edge, at_me) = outside.swap_remove(nearest);
        if edge.0 > range * range {
            break;
        }
        if at_me {
            out.push(joined.0);
        }
        for (other, lightest, at_me) in &mut outside {
            let edge = weight(joined, *other);
            if lighter(&edge, lightest) {
                (*lightest, *at_me) = (edge, false);
            }
        }
    }
    out.sort_unstable();
}

/// The length of the minimum spanning tree of `robots`, whatever their range, metres.
pub fn length(robots: &[Placed]) -> f64 {
    let Some((first, others)) = robots.split_first() else {
        return 0.0;
    };
    let mut outside: Vec<(Placed, f64)> = others
        .iter()
        .map(|other| (*other, (other.1 - first.1).norm()))
        .collect();
    let mut length = 0.0;
    while let Some(nearest) = (0..outside.len()).min_by(|a, b| outside[*a].1.total_cmp(&outside[*b].1)) {
        let (joined, way) = outside.swap_remove(nearest);
        length += way;
        for (other, lightest) in &mut outside {
            *lightest = lightest.min((other.1 - joined.1).norm());
        }
    }
    length
}

#[cfg(test)]
mod tests {
    use super::*;
    use petgraph::unionfind::UnionFind;
    use proptest::prelude::*;

    fn placed(points: &[(f64, f64)]) -> Vec<Placed> {
        let ids = (0..).map(ActorId);
        ids.zip(points.iter().map(|(x, y)| Vec2::new(*x, *y))).collect()
    }

    fn local(robots: &[Placed], me: usize, range: f64) -> Vec<ActorId> {
        let mut out = Vec::new();
        let near = robots
            .iter()
            .filter(|other| other.0 != robots[me].0 && (other.1 - robots[me].1).norm() <= at_most(range));
        neighbours(robots[me], &near.copied().collect::<Vec<_>>(), range, &mut out);
        out
    }

    /// The edges of the minimum spanning forest by Kruskal's algorithm, another one.
    fn forest(robots: &[Placed], range: f64) -> Vec<(ActorId, ActorId)> {
        let mut edges = Vec::new();
        for (i, a) in robots.iter().enumerate() {
            edges.extend(robots[i + 1..].iter().map(|b| weight(*a, *b)));
        }
        edges.retain(|edge| edge.0 <= at_most(range).powi(2));
        edges.sort_by(|a, b| {
            if lighter(a, b) {
                std::cmp::Ordering::Less
            } else {
                std::cmp::Ordering::Greater
            }
        });
        let mut sets = UnionFind::new(robots.len());
        edges.retain(|(_, a, b)| sets.union(a.index(), b.index()));
        edges.into_iter().map(|(_, a, b)| (a, b)).collect()
    }

    #[test]
    fn a_robot_in_a_row_is_next_to_its_two_neighbours_and_one_at_its_end_to_one() {
        let row = placed(&[(0.0, 0.0), (1.0, 0.0), (1.9, 0.0)]);
        assert_eq!(local(&row, 1, 2.0), [ActorId(0), ActorId(2)]);
        assert_eq!(local(&row, 0, 2.0), [ActorId(1)]);
        assert_eq!(local(&row, 0, 0.5), []);
    }

    #[test]
    fn of_two_ways_that_are_equally_long_all_take_the_one_with_the_lower_ids() {
        let square = placed(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        let trees: Vec<_> = (0..4).map(|me| local(&square, me, 1.2)).collect();
        // Each sees its two neighbours alone, which do not hear each other: the ring stays whole.
        assert_eq!(trees[0], [ActorId(1), ActorId(3)]);
        // Where all hear all, the last edge of the ring falls away for both of its ends.
        let trees: Vec<_> = (0..4).map(|me| local(&square, me, 2.0)).collect();
        assert_eq!(trees[2], [ActorId(1)]);
        assert_eq!(trees[3], [ActorId(0)]);
    }

    proptest! {
        #[test]
        fn where_all_hear_all_local_trees_are_the_one_minimum_spanning_tree(
            points in prop::collection::vec((-0.7..0.7_f64, -0.7..0.7_f64), 2..25),
        ) {
            let robots = placed(&points);
            let tree = forest(&robots, 2.0);
            for me in 0..robots.len() {
                let mut expected: Vec<ActorId> = tree
                    .iter()
                    .filter_map(|(a, b)| [(a, b), (b, a)].into_iter().find(|(a, _)| a.index() == me).map(|(_, b)| *b))
                    .collect();
                expected.sort_unstable();
                prop_assert_eq!(local(&robots, me, 2.0), expected);
            }
        }

        #[test]
        fn the_length_is_that_of_the_forest_where_all_hear_all(points in prop::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64), 0..25)) {
            let robots = placed(&points);
            let edges = forest(&robots, 99.0).into_iter();
            let sum: f64 = edges.map(|(a, b)| (robots[a.index()].1 - robots[b.index()].1).norm()).sum();
            prop_assert!((length(&robots) - sum).abs() < 1e-9);
        }

        #[test]
        fn both_ends_agree_the_degree_is_six_at_most_and_the_forest_is_in_it(
            points in prop::collection::vec((-4.0..4.0_f64, -4.0..4.0_f64), 2..60),
        ) {
            // Theorems 1 and 2 of Li, Hou and Sha: connected where the graph is, and of degree 6 at most.
            let robots = placed(&points);
            let trees: Vec<_> = (0..robots.len()).map(|me| local(&robots, me, 2.0)).collect();
            prop_assert!(trees.iter().all(|tree| tree.len() <= 6));
            for (a, b) in forest(&robots, 2.0) {
                prop_assert!(trees[a.index()].contains(&b) && trees[b.index()].contains(&a));
            }
        }
    }
}
