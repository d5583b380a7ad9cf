//! Survival of bits by table, for what is asked at every reception.

use libm::log2;

use super::{Modulation, from_db};

/// Cells of each octave of the ratio, as a power of two: the first bits of a float's mantissa.
const CELL_BITS: u32 = 6;
/// Bits of a float's mantissa, and those that say where in its cell it is.
const MANTISSA_BITS: u32 = 23;
const PLACE_BITS: u32 = MANTISSA_BITS - CELL_BITS;
/// The first cell goes from 0 to here, −24 dB: all rates are almost those of guessing there.
const FIRST: f32 = 1.0 / 256.0;
/// No table goes beyond this ratio, 60 dB.
const LARGEST: f32 = 1e6;
/// Where the logarithm of survival is above −2^−60, nothing goes wrong: one in 10¹⁸ bits.
const NEVER: f32 = -60.0;
/// By which share a ratio may fall short of a threshold and still be at it: single precision, twice over, is no reason for a loss.
const ROUNDING: f32 = 1e-6;

/// The logarithm of the chance that one bit comes through, by the ratio of signal to noise and interference.
///
/// It holds log₂(−ln(1 − BER)) at 64 ratios an octave, and goes straight between them. From 2 to 2400 bytes, and where between one frame in a million and
/// all but one in a million are lost, the share of frames lost that follows from it is within a share of 1e-3 of that of [`Modulation::log_survival`]. It
/// never falls as the ratio rises, but for a share of 1e-6 by rounding.
#[derive(Clone, Debug)]
pub struct ErrorTable {
    /// By cell: at its lower end; one more is the last one's upper end.
    cells: Vec<f32>,
    /// The ratio below which no bit comes through.
    least: f32,
}

impl ErrorTable {
    /// The table of `modulation`. It takes some hundred of its bit error rates, a few milliseconds at most.
    #[must_use]
    pub fn new(modulation: Modulation) -> Self {
        if let Modulation::Threshold(least) = modulation {
            return Self {
                cells: Vec::new(),
                least: from_db(least.get()) as f32 * (1.0 - ROUNDING),
            };
        }
        let cells = edges().map(|ratio| log2(-modulation.log_survival(f64::from(ratio))) as f32);
        let mut cells: Vec<f32> = cells.take_while(|&rate| rate > NEVER).collect();
        // No form rises with the ratio, but the last digit of a sum may.
        for cell in 1..cells.len() {
            cells[cell] = cells[cell].min(cells[cell - 1]);
        }
        Self {
            cells,
            least: f32::NEG_INFINITY,
        }
    }

    /// The ratio from which on no bit goes wrong.
    pub(in crate::radio) fn certain(&self) -> f32 {
        let beyond = self.cells.len().checked_sub(1).and_then(|last| edges().nth(last));
        beyond.unwrap_or(self.least)
    }

    /// The logarithm of the chance that one bit comes through at ratio `snr` (plain, not dB), at most 0; −∞ where none does. Times the number of bits, and added up over the
    /// parts of a frame, it is the logarithm of the chance that the frame arrives.
    #[inline]
    #[must_use]
    pub fn log_survival(&self, snr: f32) -> f32 {
        if snr < self.least {
            return f32::NEG_INFINITY;
        }
        let snr = snr.max(0.0);
        let (cell, place) = if snr < FIRST {
            (0, snr / FIRST)
        } else {
            let bits = snr.to_bits();
            let place = bits & ((1 << PLACE_BITS) - 1);
            let cell = 1 + ((bits - FIRST.to_bits()) >> PLACE_BITS);
            (cell as usize, place as f32 / (1 << PLACE_BITS) as f32)
        };
        match self.cells.get(cell..cell + 2) {
            Some(&[low, high]) => -exp2(low + (high - low) * place),
            _ => 0.0,
        }
    }
}

/// The lower ends of all cells: 0, then 64 an octave.
fn edges() -> impl Iterator<Item = f32> {
    let later = (FIRST.to_bits()..).step_by(1 << PLACE_BITS).map(f32::from_bits);
    std::iter::once(0.0).chain(later.take_while(|&ratio| ratio <= LARGEST))
}

/// 2^`x` for `x` between −60 and 0, with a relative error below 3e-7: its whole part as exponent, a polynomial for what is left. Single precision, and the same bits on
/// every machine.
fn exp2(x: f32) -> f32 {
    /// Adding it rounds to a whole number, which is then in the last bits.
    const ROUNDS: f32 = 1.5 * (1 << MANTISSA_BITS) as f32;
    const POLYNOMIAL: [f32; 6] = [
        1.000_000_1,
        0.693_146_97,
        0.240_221_2,
        0.055_507_13,
        0.009_675_541,
        0.001_327_647_2,
    ];
    let rounded = x + ROUNDS;
    let fraction = x - (rounded - ROUNDS);
    let value = POLYNOMIAL.iter().rev().fold(0.0, |sum, term| sum * fraction + term);
    let exponent = rounded.to_bits() << MANTISSA_BITS;
    f32::from_bits(value.to_bits().wrapping_add(exponent))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::tests::ALL;
    use super::*;

    /// Chance that a frame of so many bits is lost, by the logarithm of a bit's survival.
    fn loss(log_survival: f64, bits: f64) -> f64 {
        -libm::expm1(bits * log_survival)
    }

    #[test]
    fn from_2_to_2400_bytes_the_share_of_frames_lost_is_within_a_thousandth() {
        for modulation in ALL {
            let table = ErrorTable::new(modulation);
            let mut compared = 0;
            for step in 0..6000 {
                // −45 to 45 dB, not in step with the cells.
                let ratio = from_db(f64::from(step) * 0.015 - 45.0) as f32;
                let exact = modulation.log_survival(f64::from(ratio));
                let read = f64::from(table.log_survival(ratio));
                for bytes in [2.0, 20.0, 133.0, 1000.0, 2400.0] {
                    let [expected, found] = [exact, read].map(|log| loss(log, 8.0 * bytes));
                    if (1e-6..=1.0 - 1e-6).contains(&expected) {
                        compared += 1;
                        let error = (found / expected - 1.0).abs();
                        assert!(error < 1e-3, "{modulation:?} {ratio} {bytes}: {found}, not {expected}");
                    }
                }
            }
            assert!(compared > 1000, "{modulation:?}: {compared}");
        }
    }

    #[test]
    fn what_is_sharp_stays_sharp_and_what_never_goes_wrong_never_does() {
        let none = ErrorTable::new(Modulation::None);
        let lora = ErrorTable::new(Modulation::lora(7));
        for ratio in [0.0, 1e-6, 1.0, 1e6, f32::INFINITY] {
            assert!(none.log_survival(ratio) == 0.0);
            let expected = if ratio < 0.17 { f32::NEG_INFINITY } else { 0.0 };
            assert_eq!(lora.log_survival(ratio).to_bits(), expected.to_bits());
        }
        let at = from_db(-7.5) as f32;
        assert!(lora.log_survival(at) == 0.0, "at its limit a frame is heard");
        assert!(lora.log_survival(at * 0.9999) == f32::NEG_INFINITY);
    }

    #[test]
    fn without_noise_nothing_goes_wrong_and_without_signal_all_bits_are_guessed() {
        for modulation in ALL {
            let table = ErrorTable::new(modulation);
            assert!(table.log_survival(f32::INFINITY) == 0.0);
            let [silent, below] = [0.0, -1.0].map(|ratio| table.log_survival(ratio));
            assert_eq!(silent.to_bits(), below.to_bits());
            let expected = modulation.log_survival(0.0);
            assert!((f64::from(silent) - expected).abs() < 1e-6, "{modulation:?}: {silent}");
        }
    }

    #[test]
    fn the_power_of_two_is_as_near_as_it_says() {
        for step in 0..=60_000_u16 {
            let x = f32::from(step) * -1e-3;
            let error = f64::from(exp2(x)) / libm::exp2(f64::from(x)) - 1.0;
            assert!(error.abs() < 3e-7, "2^{x}: {error}");
        }
    }

    proptest! {
        #[test]
        fn survival_never_falls_as_the_ratio_rises(
            modulation in prop::sample::select(ALL.to_vec()), db in -40.0..40.0_f64, more in 0.0..1.0_f64,
        ) {
            let table = ErrorTable::new(modulation);
            let [low, high] = [db, db + more * more * more].map(|db| table.log_survival(from_db(db) as f32));
            prop_assert!(high >= low * (1.0 + 1e-6));
        }
    }
}
