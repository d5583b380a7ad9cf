//! Gains of one gamma law laid onto another, one by one: the same chance of less.

use libm::{exp2, log2};

use crate::radio::propagation::gamma::{below_and_above, density_of_log};

/// Cells of each octave of the gain, as a power of two: the first bits of a float's mantissa.
const CELL_BITS: u32 = 4;
const PLACE_BITS: u32 = 52 - CELL_BITS;
/// The table's range, 2^−40 to 2^7; beyond it the first and the last cell go on.
const LEAST: f64 = 1.0 / (1_u64 << 40) as f64;
const MOST: f64 = 128.0;

/// log₂ of the gain of one law by the gain of the other, and straight between.
#[derive(Debug)]
pub(super) struct Reshaping {
    cells: Vec<f64>,
}

impl Reshaping {
    /// Gains of a gamma law of shape `from` and mean 1, laid onto that of shape `to`.
    pub fn new(from: f64, to: f64) -> Self {
        let mut target = Target { shape: to, log: 0.0 };
        // From the middle outwards, so that each search begins near its end.
        let middle = edges().position(|gain| gain >= 1.0).unwrap_or(0);
        let gains: Vec<f64> = edges().collect();
        let mut cells = vec![0.0; gains.len()];
        for index in (middle..gains.len()).chain((0..middle).rev()) {
            if index + 1 == middle {
                target.log = cells[middle];
            }
            cells[index] = target.gain_at(below_and_above(from, from * gains[index]));
        }
        Self { cells }
    }

    /// The gain that has the same chance of less as `gain` has.
    #[inline]
    pub fn gain(&self, gain: f64) -> f64 {
        let bounded = gain.clamp(LEAST, MOST * 0.999);
        let cell = ((bounded.to_bits() - LEAST.to_bits()) >> PLACE_BITS) as usize;
        let [low, high] = [self.cells[cell], self.cells[cell + 1]];
        let [from, to] = [cell, cell + 1].map(edge);
        exp2(low + (high - low) * (gain - from) / (to - from))
    }
}

/// The gain at which cell number `cell` begins.
fn edge(cell: usize) -> f64 {
    f64::from_bits(LEAST.to_bits() + ((cell as u64) << PLACE_BITS))
}

fn edges() -> impl Iterator<Item = f64> {
    (0..).map(edge).take_while(|&gain| gain <= MOST)
}

/// A law whose gains are looked for, and where the last one was found, as log₂.
struct Target {
    shape: f64,
    log: f64,
}

impl Target {
    /// log₂ of the gain with such chances of less and of more: Newton's method on the logarithm of the lesser chance, which is nearly straight.
    fn gain_at(&mut self, [below, above]: [f64; 2]) -> f64 {
        let upper = below > 0.5;
        let wanted = log2(if upper { above } else { below });
        for _ in 0..100 {
            let x = self.shape * exp2(self.log);
            let [below, above] = below_and_above(self.shape, x);
            let (chance, sign) = if upper { (above, -1.0) } else { (below, 1.0) };
            let slope = sign * density_of_log(self.shape, x) / chance;
            let step = (wanted - log2(chance)) / slope;
            self.log += step.clamp(-1.0, 1.0);
            if step.abs() < 1e-12 {
                break;
            }
        }
        self.log
    }
}
