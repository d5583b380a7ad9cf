//! The algebraic connectivity of a graph.

use super::graph::Graph;
use super::lanczos::least_positive_eigenvalue;

impl Graph {
    /// Algebraic connectivity λ₂, the second least eigenvalue of the Laplacian; 0 if the graph is not connected, and
    /// by convention 0 for fewer than two vertices.
    #[must_use]
    pub fn algebraic_connectivity(&self) -> f64 {
        if self.vertices < 2 || self.components() > 1 {
            return 0.0;
        }
        least_positive_eigenvalue(self)
    }
}
