//! λ₂ by Lanczos iteration on the pseudo-inverse of the Laplacian, where it is the greatest eigenvalue's inverse.
//!
//! On the Laplacian itself λ₂ lies at the crowded end of the spectrum and Lanczos needs hundreds of steps; on the
//! pseudo-inverse it stands apart, and one or two dozen steps do. Each step is two triangular solves.

use crate::engine::{Purpose, Streams};

use super::cholesky::{Factor, dot};
use super::graph::Graph;

/// Iteration ends when the residual, which bounds the error, is this share of the eigenvalue.
const RELATIVE_RESIDUAL: f64 = 1e-8;
/// Steps between looks at the residual.
const STEPS_BETWEEN_LOOKS: usize = 4;
/// The start vector: fixed, and without the symmetries that a graph may have.
const START: Purpose = Purpose::new("metrics.lanczos");

/// The least positive Laplacian eigenvalue of a connected graph of at least two vertices.
pub(super) fn least_positive_eigenvalue(graph: &Graph) -> f64 {
    let factor = Factor::of(graph);
    let mut basis = vec![start_vector(graph.vertices())];
    let mut ritz = Tridiagonal::default();
    loop {
        let mut next = basis[basis.len() - 1].clone();
        factor.solve(&mut next);
        let diagonal = dot(&next, &basis[basis.len() - 1]);
        let length = orthogonalise(&mut next, &basis);
        ritz.diagonal.push(diagonal);
        // Nothing new is left to see: the residual is then within its bound whatever the eigenvector.
        let exhausted = length <= RELATIVE_RESIDUAL * ritz.diagonal[0] || basis.len() + 1 == graph.vertices();
        if exhausted || basis.len().is_multiple_of(STEPS_BETWEEN_LOOKS) {
            let greatest = ritz.greatest_eigenvalue();
            if exhausted || length * ritz.last_component(greatest) <= RELATIVE_RESIDUAL * greatest {
                return greatest.recip();
            }
        }
        ritz.beside.push(length);
        scale(&mut next, length.recip());
        basis.push(next);
    }
}

/// A unit vector without a constant part.
fn start_vector(size: usize) -> Vec<f64> {
    let mut random = Streams::new(0, 0).keyed(START).at(0, 0, 0);
    let mut vector: Vec<f64> = (0..size)
        .map(|_| f64::from(random.next_u32()) / f64::from(u32::MAX))
        .collect();
    centre(&mut vector);
    let length = dot(&vector, &vector).sqrt();
    scale(&mut vector, length.recip());
    vector
}

fn scale(vector: &mut [f64], factor: f64) {
    for x in vector {
        *x *= factor;
    }
}

/// Takes the constant part, the Laplacian's null space, out of `vector`.
fn centre(vector: &mut [f64]) {
    let mean = vector.iter().sum::<f64>() / vector.len() as f64;
    for x in vector {
        *x -= mean;
    }
}

/// Makes `vector` orthogonal to all of `basis` and to the constant vectors, twice since once loses digits, and gives
/// the length that is left.
fn orthogonalise(vector: &mut [f64], basis: &[Vec<f64>]) -> f64 {
    for _ in 0..2 {
        centre(vector);
        for known in basis {
            let share = dot(vector, known);
            for (x, y) in vector.iter_mut().zip(known) {
                *x -= share * y;
            }
        }
    }
    dot(vector, vector).sqrt()
}

/// The operator in the basis built so far: a symmetric tridiagonal matrix, positive beside its diagonal.
#[derive(Debug, Default)]
struct Tridiagonal {
    diagonal: Vec<f64>,
    beside: Vec<f64>,
}

impl Tridiagonal {
    /// The greatest eigenvalue, by bisection to the last digit.
    fn greatest_eigenvalue(&self) -> f64 {
        let mut low = self.diagonal.iter().copied().fold(0.0, f64::max);
        let mut high = low + 2.0 * self.beside.iter().copied().fold(0.0, f64::max);
        loop {
            let middle = low + (high - low) / 2.0;
            if middle <= low || middle >= high {
                return high;
            }
            if self.lies_below(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
    }

    /// Whether every eigenvalue is less than `x`: all pivots of the matrix less `x` are negative (Sylvester).
    fn lies_below(&self, x: f64) -> bool {
        let mut pivot = f64::INFINITY;
        let off = std::iter::once(&0.0).chain(&self.beside);
        self.diagonal.iter().zip(off).all(|(diagonal, beside)| {
            pivot = diagonal - x - beside * beside / pivot;
            pivot < 0.0
        })
    }

    /// The last component of the unit eigenvector of the greatest eigenvalue. Its components all have one sign, so
    /// going back from the last to the first, towards which they grow, loses nothing.
    fn last_component(&self, eigenvalue: f64) -> f64 {
        let (mut component, mut behind, mut squares) = (1.0_f64, 0.0, 1.0_f64);
        for i in (1..self.diagonal.len()).rev() {
            let ahead = ((eigenvalue - self.diagonal[i]) * component - behind) / self.beside[i - 1];
            behind = self.beside[i - 1] * component;
            component = ahead;
            squares += component * component;
        }
        squares.sqrt().recip()
    }
}
