//! Random fields as sums of plane waves: what shadowing and fading are made of.
//!
//! A field is a function of where both ends of a link are, keyed by the trial and without state: at the same places it has the same value, nearby nearly the same.

use crate::engine::KeyedStreams;
use crate::geometry::Vec2;

/// Waves of a field. More of them are nearer to a normal law, and take longer.
pub(super) const WAVES: usize = 32;
/// Coordinates of the two ends of a link.
const COORDINATES: usize = 4;
/// Waves that are computed side by side: a compiler makes vectors of them.
const LANES: usize = 8;
/// A field repeats itself after so many of its units of length in each coordinate, because each wave has a whole number of turns in them. So whole periods are taken off a place in
/// double precision, and what is left is small enough for single, however large the arena.
const PERIOD: f64 = 4096.0;
/// Turns in a unit of length that a wave has at most, so that its phase stays small enough to be told from whole turns.
pub(super) const FASTEST: f64 = 512.0;

/// One value for each wave.
pub(super) type EachWave<T> = [T; WAVES];

/// Plane waves over the places of two ends.
#[derive(Debug)]
pub(super) struct Waves {
    /// Units of length in a metre.
    per_metre: f64,
    /// By coordinate, then by wave: turns of phase in a unit of length.
    numbers: [EachWave<f32>; COORDINATES],
    /// Phase at the origin, turns from 0 to 1.
    phases: EachWave<f32>,
}

impl Waves {
    /// Waves of random phases in a field whose unit of length is `unit` metres. `draw` makes the wave vector of each, turns in a unit of length for each coordinate, of the uniform variates from 0 to 1 that it
    /// asks for; each wave has a stream of its own.
    pub fn new(
        streams: KeyedStreams,
        field: u32,
        unit: f64,
        mut draw: impl FnMut(&mut dyn FnMut() -> f64) -> [f64; COORDINATES],
    ) -> Self {
        let mut waves = Self {
            per_metre: 1.0 / unit,
            numbers: [[0.0; WAVES]; COORDINATES],
            phases: [0.0; WAVES],
        };
        for wave in 0..WAVES {
            let mut stream = streams.at(field, wave as u32, 0);
            let mut uniform = || (stream.next_u64() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0);
            waves.phases[wave] = uniform() as f32;
            for (coordinate, number) in draw(&mut uniform).into_iter().enumerate() {
                waves.numbers[coordinate][wave] = (nearest(number * PERIOD) / PERIOD) as f32;
            }
        }
        waves
    }

    /// Phases at the origin, turns.
    pub const fn phases(&self) -> &EachWave<f32> {
        &self.phases
    }

    /// Σ cos of all phases between the places `a` and `b`.
    #[inline]
    pub fn cosines(&self, a: Vec2, b: Vec2) -> f32 {
        sum(&self.turns(&self.phases, a, b).map(cos))
    }

    /// Σ cos and Σ sin of all phases between the places `a` and `b`, where those at the origin are `phases`.
    #[inline]
    pub fn phasors(&self, phases: &EachWave<f32>, a: Vec2, b: Vec2) -> [f32; 2] {
        let turns = self.turns(phases, a, b);
        [sum(&turns.map(cos)), sum(&turns.map(sin))]
    }

    /// The phase of each wave between the places `a` and `b`, turns from −½ to ½.
    #[inline]
    fn turns(&self, phases: &EachWave<f32>, a: Vec2, b: Vec2) -> EachWave<f32> {
        /// Adding it and taking it off again rounds to a whole number.
        const ROUNDS: f32 = 1.5 * (1 << 23) as f32;
        let place = [a.x, a.y, b.x, b.y].map(|metres| {
            let units = metres * self.per_metre;
            (units - PERIOD * nearest(units / PERIOD)) as f32
        });
        let mut turns = *phases;
        for (wave, turn) in turns.iter_mut().enumerate() {
            for (numbers, along) in self.numbers.iter().zip(place) {
                *turn += numbers[wave] * along;
            }
            *turn -= (*turn + ROUNDS) - ROUNDS;
        }
        turns
    }
}

/// The whole number nearest to `x`, exact up to 2⁵¹.
#[inline]
pub(super) fn nearest(x: f64) -> f64 {
    /// Adding it and taking it off again rounds to a whole number.
    const ROUNDS: f64 = 1.5 * (1_u64 << 52) as f64;
    (x + ROUNDS) - ROUNDS
}

/// All values added up, in one order: eight sums side by side, then those.
#[inline]
fn sum(values: &EachWave<f32>) -> f32 {
    let mut lanes = [0.0; LANES];
    for values in values.chunks_exact(LANES) {
        for (lane, value) in lanes.iter_mut().zip(values) {
            *lane += value;
        }
    }
    let halves: [f32; LANES / 2] = std::array::from_fn(|lane| lanes[lane] + lanes[lane + LANES / 2]);
    (halves[0] + halves[2]) + (halves[1] + halves[3])
}

/// The cosine of `turns` turns, from −½ to ½, within 3e-7.
#[inline]
fn cos(turns: f32) -> f32 {
    quarter_sin(0.25 - turns.abs())
}

/// The sine of `turns` turns, from −½ to ½, within 3e-7.
#[inline]
fn sin(turns: f32) -> f32 {
    let folded = 0.25 - (turns.abs() - 0.25).abs();
    quarter_sin(folded).copysign(turns)
}

/// The sine of `turns` turns, from −¼ to ¼: the odd polynomial of degree 9 with the least error, 3.4e-9 but for the rounding of single precision.
#[inline]
fn quarter_sin(turns: f32) -> f32 {
    // The first one happens to be near 2π.
    #[allow(clippy::approx_constant)]
    const POLYNOMIAL: [f32; 5] = [6.283_185, -41.341_656, 81.601_006, -76.549_78, 39.536_71];
    let square = turns * turns;
    let [first, third, fifth, seventh, ninth] = POLYNOMIAL;
    ((((ninth * square + seventh) * square + fifth) * square + third) * square + first) * turns
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::engine::{Purpose, Streams};

    fn waves(unit: f64) -> Waves {
        let streams = Streams::new(5, 0).keyed(Purpose::new("test.waves"));
        Waves::new(streams, 0, unit, |uniform| {
            let [a, b] = [TAU * uniform(), TAU * uniform()];
            [a.cos(), a.sin(), b.cos(), b.sin()]
        })
    }

    /// Σ cos and Σ sin in double precision, of the same waves.
    fn exactly(waves: &Waves, a: Vec2, b: Vec2) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for wave in 0..WAVES {
            let place = [a.x, a.y, b.x, b.y].map(|metres| metres * waves.per_metre);
            let numbers = waves.numbers.map(|numbers| f64::from(numbers[wave]));
            let phases = numbers.iter().zip(place).map(|(number, along)| number * along);
            let angle = TAU * (f64::from(waves.phases[wave]) + phases.sum::<f64>());
            sums[0] += angle.cos();
            sums[1] += angle.sin();
        }
        sums
    }

    #[test]
    fn sine_and_cosine_are_within_3e_7() {
        for step in -500_000..=500_000 {
            let turns = step as f32 / 1e6;
            let angle = TAU * f64::from(turns);
            for (found, expected) in [(cos(turns), angle.cos()), (sin(turns), angle.sin())] {
                let error = (f64::from(found) - expected).abs();
                assert!(error < 3e-7, "{turns} turns: {found}, not {expected}");
            }
        }
    }

    /// A phase of thousands of turns is rounded by up to 2⁻¹³ of one in each of four additions: by 1e-3 rad or so for each wave, and by 0.6 % of a radian for 32 of them, of which the sum is 5.7 itself.
    #[test]
    fn sums_are_those_of_double_precision_however_far_away() {
        let waves = waves(0.125);
        for (reach, tolerance) in [(1.0, 5e-5), (10.0, 5e-4), (250.0, 2e-2), (1e4, 2e-2), (1e6, 2e-2)] {
            for step in 0..200 {
                let [x, y] = [f64::from(step) * 0.618, f64::from(step) * 0.414].map(|share| share.fract() * 2.0 - 1.0);
                let [a, b] = [Vec2::new(x, y), Vec2::new(y, -x)].map(|place| place * reach);
                let expected = exactly(&waves, a, b);
                let [cosines, sines] = waves.phasors(waves.phases(), a, b);
                assert_eq!(waves.cosines(a, b).to_bits(), cosines.to_bits());
                for (found, expected) in [cosines, sines].into_iter().zip(expected) {
                    let error = (f64::from(found) - expected).abs();
                    assert!(error < tolerance, "{reach} m: {found}, not {expected}");
                }
            }
        }
    }

    #[test]
    fn whole_numbers_are_found_as_rounding_finds_them() {
        for x in [
            0.0,
            0.4,
            0.6,
            -0.4,
            -0.6,
            1e6 + 0.3,
            -1e12 - 0.7,
            4503599627370495.0 / 4.0,
        ] {
            assert!((nearest(x) - x.round()).abs() < 1e-12, "{x}");
        }
    }

    /// Phases are uniform, at the origin too: over n fields the mean of a sum of 32 cosines has a standard error of √(16/n).
    #[test]
    fn no_place_is_special() {
        const FIELDS: u32 = 4000;
        let mut sums = [0.0; 2];
        for field in 0..FIELDS {
            let streams = Streams::new(6, field).keyed(Purpose::new("test.waves"));
            let waves = Waves::new(streams, 0, 1.0, |uniform| [uniform(), uniform(), uniform(), uniform()]);
            let found = waves.phasors(waves.phases(), Vec2::zeros(), Vec2::zeros());
            for (sum, found) in sums.iter_mut().zip(found) {
                *sum += f64::from(found) / f64::from(FIELDS);
            }
        }
        let four_errors = 4.0 * (16.0 / f64::from(FIELDS)).sqrt();
        assert!(sums.iter().all(|mean| mean.abs() < four_errors), "{sums:?}");
    }

    #[test]
    fn a_field_is_keyed_by_its_number_and_its_streams() {
        let (a, b) = (Vec2::new(1.0, 2.0), Vec2::new(3.0, 4.0));
        let value = |seed, field| {
            let streams = Streams::new(seed, 0).keyed(Purpose::new("test.waves"));
            let along = |uniform: &mut dyn FnMut() -> f64| [uniform(), uniform(), uniform(), uniform()];
            Waves::new(streams, field, 1.0, along).cosines(a, b).to_bits()
        };
        assert_eq!(value(1, 0), value(1, 0));
        assert_ne!(value(1, 0), value(1, 1));
        assert_ne!(value(1, 0), value(2, 0));
    }
}
