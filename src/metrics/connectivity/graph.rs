//! Undirected graphs: who is within range of whom, and in how many pieces the swarm is.

use petgraph::unionfind::UnionFind;

use crate::engine::ActorId;
use crate::geometry::{Vec2, at_most};
use crate::radio::{Placed, Reach};

/// An undirected simple graph.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Graph {
    pub(super) vertices: usize,
    /// Each edge once, its lower end first, sorted.
    edges: Vec<[u32; 2]>,
}

impl Graph {
    /// The graph of `vertices` vertices and `edges`; loops are left out, repeated edges count once.
    ///
    /// # Panics
    /// If an edge names a vertex that is not there.
    #[must_use]
    pub fn new(vertices: usize, edges: impl IntoIterator<Item = [u32; 2]>) -> Self {
        let ascending = edges
            .into_iter()
            .filter(|[a, b]| a != b)
            .map(|[a, b]| [a.min(b), a.max(b)]);
        let mut edges: Vec<_> = ascending.collect();
        assert!(
            edges.iter().all(|&[_, b]| (b as usize) < vertices),
            "an edge leads out of the graph"
        );
        edges.sort_unstable();
        edges.dedup();
        Self { vertices, edges }
    }

    /// The graph of robots, each with its place: an edge where two hear each other. Vertices are numbered along the longer side of the swarm, not by
    /// robot: neighbours then have near numbers, which makes the search a sweep and the Laplacian's factor narrow.
    #[must_use]
    pub fn of_reach(robots: impl Iterator<Item = Placed>, reach: &Reach) -> Self {
        match reach {
            Reach::Disk(range) => Self::within_range(&robots.map(|(_, place)| place).collect::<Vec<_>>(), *range),
            Reach::Links(_) => {
                let linked = |a: &Placed, b: &Placed| reach.linked(*a, *b);
                Self::swept(
                    &mut robots.collect::<Vec<_>>(),
                    |robot| robot.1,
                    reach.farthest(),
                    linked,
                )
            }
        }
    }

    /// The graph as [`of_reach`](Self::of_reach) has it, and which robot each vertex is.
    #[must_use]
    pub fn with_robots(robots: impl Iterator<Item = Placed>, reach: &Reach) -> (Self, Vec<ActorId>) {
        let mut robots: Vec<Placed> = robots.collect();
        let linked = |a: &Placed, b: &Placed| matches!(reach, Reach::Disk(_)) || reach.linked(*a, *b);
        let graph = Self::swept(&mut robots, |robot| robot.1, reach.farthest(), linked);
        (graph, robots.into_iter().map(|robot| robot.0).collect())
    }

    /// The unit-disk graph of the paper's section 3.1: an edge where two positions are [at most](at_most) `range` metres apart. Vertices are
    /// numbered as in [`of_reach`](Self::of_reach).
    #[must_use]
    pub fn within_range(positions: &[Vec2], range: f64) -> Self {
        Self::swept(&mut positions.to_vec(), |place| *place, range, |_, _| true)
    }

    /// An edge where two of `points` are at most `range` metres apart and `linked`. They are put in the order of the vertices.
    fn swept<T>(points: &mut [T], place: impl Fn(&T) -> Vec2, range: f64, linked: impl Fn(&T, &T) -> bool) -> Self {
        let range = at_most(range);
        let axis = longer_axis(points, &place);
        points.sort_by(|a, b| place(a)[axis].total_cmp(&place(b)[axis]));
        let mut edges = Vec::with_capacity(4 * points.len());
        for (i, a) in points.iter().enumerate() {
            let here = place(a);
            let ahead = points[i + 1..].iter();
            let ahead = ahead.take_while(|b| place(b)[axis] - here[axis] <= range);
            let near = ahead
                .zip(i + 1..)
                .filter(|(b, _)| (place(b) - here).norm_squared() <= range * range && linked(a, b));
            edges.extend(near.map(|(_, j)| [i as u32, j as u32]));
        }
        Self {
            vertices: points.len(),
            edges,
        }
    }

    /// Number of vertices.
    #[must_use]
    pub fn vertices(&self) -> usize {
        self.vertices
    }

    /// Each edge once, its lower end first, sorted.
    #[must_use]
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// Edges at each vertex.
    #[must_use]
    pub fn degrees(&self) -> Vec<u32> {
        let mut degrees = vec![0; self.vertices];
        for &[a, b] in &self.edges {
            degrees[a as usize] += 1;
            degrees[b as usize] += 1;
        }
        degrees
    }

    /// Edges at a vertex, mean over vertices; 0 without vertices.
    #[must_use]
    pub fn mean_degree(&self) -> f64 {
        if self.vertices == 0 {
            return 0.0;
        }
        2.0 * self.edges.len() as f64 / self.vertices as f64
    }

    /// Number of connected components.
    #[must_use]
    pub fn components(&self) -> usize {
        let mut sets = UnionFind::new(self.vertices);
        let joins = self
            .edges
            .iter()
            .filter(|&&[a, b]| sets.union(a as usize, b as usize))
            .count();
        self.vertices - joins
    }
}

/// The axis on which `points` extend further.
fn longer_axis<T>(points: &[T], place: &impl Fn(&T) -> Vec2) -> usize {
    let extent = |axis: usize| {
        let coordinates = || points.iter().map(|point| place(point)[axis]);
        coordinates().fold(f64::NEG_INFINITY, f64::max) - coordinates().fold(f64::INFINITY, f64::min)
    };
    usize::from(extent(1) > extent(0))
}
