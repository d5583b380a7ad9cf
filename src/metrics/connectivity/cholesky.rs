//! Solving with the Laplacian of a connected graph by an envelope Cholesky factor.

use super::graph::Graph;

/// The Cholesky factor of a connected graph's Laplacian without its last row and column, which is positive definite.
/// A row is stored from its first non-zero to its diagonal: factoring fills nothing in before it.
#[derive(Debug)]
pub(super) struct Factor {
    rows: Vec<Row>,
    values: Vec<f64>,
}

/// Where a row lies: its column `first` to its diagonal in `values[start..end]`.
#[derive(Clone, Copy, Debug)]
struct Row {
    first: usize,
    start: usize,
    end: usize,
}

impl Factor {
    /// Factors the Laplacian of `graph`, which must be connected and have at least two vertices.
    pub(super) fn of(graph: &Graph) -> Self {
        let mut factor = Self::laplacian(graph);
        for i in 0..factor.rows.len() {
            factor.eliminate(i);
        }
        factor
    }

    /// The lower triangle of the Laplacian, last row and column left out.
    fn laplacian(graph: &Graph) -> Self {
        let size = graph.vertices() - 1;
        let mut first: Vec<usize> = (0..size).collect();
        for &[a, b] in graph.edges().iter().filter(|&&[_, b]| (b as usize) < size) {
            first[b as usize] = first[b as usize].min(a as usize);
        }
        let mut end = 0;
        let place = |(i, &first): (usize, &usize)| {
            let start = end;
            end += i - first + 1;
            Row { first, start, end }
        };
        let rows: Vec<Row> = first.iter().enumerate().map(place).collect();
        let mut values = vec![0.0; end];
        for &[a, b] in graph.edges() {
            let (a, b) = (a as usize, b as usize);
            values[rows[a].end - 1] += 1.0;
            if b < size {
                values[rows[b].end - 1] += 1.0;
                values[rows[b].start + a - rows[b].first] = -1.0;
            }
        }
        Self { rows, values }
    }

    /// Turns row `i` of the matrix into that of the factor; the rows before it are done.
    fn eliminate(&mut self, i: usize) {
        let row = self.rows[i];
        let (done, rest) = self.values.split_at_mut(row.start);
        let mine = &mut rest[..row.end - row.start];
        let diagonal = mine.len() - 1;
        for (column, above) in self.rows[row.first..i].iter().enumerate() {
            let shared = (row.first + column) - above.first.max(row.first);
            let theirs = &done[above.end - 1 - shared..above.end];
            let product = dot(&mine[column - shared..column], &theirs[..shared]);
            mine[column] = (mine[column] - product) / theirs[shared];
        }
        let squares = dot(&mine[..diagonal], &mine[..diagonal]);
        mine[diagonal] = (mine[diagonal] - squares).sqrt();
    }

    /// Replaces `b`, whose entries sum to zero, by the solution x of Laplacian · x = b whose last entry is zero.
    pub(super) fn solve(&self, b: &mut [f64]) {
        for (i, row) in self.rows.iter().enumerate() {
            let (known, pivot) = self.row(*row);
            b[i] = (b[i] - dot(known, &b[row.first..i])) / pivot;
        }
        for (i, row) in self.rows.iter().enumerate().rev() {
            let (known, pivot) = self.row(*row);
            b[i] /= pivot;
            let x = b[i];
            for (entry, value) in b[row.first..i].iter_mut().zip(known) {
                *entry -= x * value;
            }
        }
        b[self.rows.len()] = 0.0;
    }

    /// A row's entries before the diagonal, and the diagonal.
    fn row(&self, row: Row) -> (&[f64], f64) {
        (&self.values[row.start..row.end - 1], self.values[row.end - 1])
    }
}

/// The dot product, summed in eight interleaved parts so that the compiler may use vector instructions; the order of
/// additions is fixed, hence the result is the same on every machine.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a_parts, a_rest) = a.as_chunks::<8>();
    let (b_parts, b_rest) = b.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (x, y) in a_parts.iter().zip(b_parts) {
        for lane in 0..8 {
            sums[lane] += x[lane] * y[lane];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f64>() + rest
}
