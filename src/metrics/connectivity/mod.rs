//! The swarm as a graph: algebraic connectivity, components, vertex-disjoint chains.

mod chains;
mod cholesky;
mod graph;
mod lambda2;
mod lanczos;

pub use chains::Chains;
pub use graph::Graph;
