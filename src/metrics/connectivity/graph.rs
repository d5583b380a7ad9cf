//! Undirected graphs: who is within range of whom, and in how many pieces the swarm is.

use petgraph::unionfind::UnionFind;

use crate::geometry::{Vec2, at_most};

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

    /// The unit-disk graph of the paper's section 3.1: an edge where two positions are [at most](at_most) `range` metres apart.
    /// Vertices are numbered along the longer side of the swarm, not by robot: neighbours then have near numbers, which
    /// makes the search a sweep and the Laplacian's factor narrow.
    #[must_use]
    pub fn within_range(positions: &[Vec2], range: f64) -> Self {
        let range = at_most(range);
        let axis = longer_axis(positions);
        let mut along = positions.to_vec();
        along.sort_by(|a, b| a[axis].total_cmp(&b[axis]));
        let mut edges = Vec::with_capacity(4 * positions.len());
        for (i, a) in along.iter().enumerate() {
            let ahead = along[i + 1..].iter().take_while(|b| b[axis] - a[axis] <= range);
            let near = ahead
                .zip(i + 1..)
                .filter(|(b, _)| (*b - a).norm_squared() <= range * range);
            edges.extend(near.map(|(_, j)| [i as u32, j as u32]));
        }
        Self {
            vertices: positions.len(),
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

/// The axis on which `positions` extend further.
fn longer_axis(positions: &[Vec2]) -> usize {
    let extent = |axis: usize| {
        let coordinates = || positions.iter().map(|p| p[axis]);
        coordinates().fold(f64::NEG_INFINITY, f64::max) - coordinates().fold(f64::INFINITY, f64::min)
    };
    usize::from(extent(1) > extent(0))
}
