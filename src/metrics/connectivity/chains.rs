//! Vertex-disjoint chains: how many ways lead from a robot to the root that share no relay (paper eq. 5, by Menger's
//! theorem a maximum flow).

use petgraph::algo::ford_fulkerson;
use petgraph::graph::{DiGraph, NodeIndex};

use crate::engine::ActorId;

/// The parent relation of a swarm as a flow network. Every robot is split in two vertices, in and out, joined by an edge
/// of capacity 1, so that one chain at most runs through it.
#[derive(Debug)]
pub struct Chains {
    network: DiGraph<(), u32>,
    root: ActorId,
}

impl Chains {
    /// The network of `parents` (each robot's, in order of ids) towards `root`; a hop counts only where `reaches`
    /// says that the first robot reaches the second. A parent named twice is one parent.
    #[must_use]
    pub fn new(parents: &[Vec<ActorId>], root: ActorId, reaches: impl Fn(ActorId, ActorId) -> bool) -> Self {
        let robots = parents.len();
        let mut network = DiGraph::with_capacity(2 * robots, 2 * robots);
        for _ in 0..2 * robots {
            network.add_node(());
        }
        for (child, named) in (0..).map(ActorId).zip(parents) {
            network.add_edge(way_in(child), way_out(child), 1);
            for (i, &parent) in named.iter().enumerate() {
                if parent != child && !named[..i].contains(&parent) && reaches(child, parent) {
                    network.add_edge(way_out(child), way_in(parent), 1);
                }
            }
        }
        Self { network, root }
    }

    /// The greatest number of chains from `robot` to the root that share no robot but these two; 0 for the root itself.
    #[must_use]
    pub fn count(&self, robot: ActorId) -> u32 {
        if robot == self.root {
            return 0;
        }
        ford_fulkerson(&self.network, way_out(robot), way_in(self.root)).0
    }
}

fn way_in(robot: ActorId) -> NodeIndex {
    NodeIndex::new(2 * robot.index())
}

fn way_out(robot: ActorId) -> NodeIndex {
    NodeIndex::new(2 * robot.index() + 1)
}
