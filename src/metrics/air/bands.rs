//! Bands of distance: the same in all runs, whatever their radio, so that trials and scenarios can be put together.

/// Bands from one distance to twice that.
const PER_DOUBLING: i32 = 4;
/// The first band ends at 2⁻⁷ m, 8 mm, and begins with no distance at all; the last one ends at 2²⁰ m, and takes what is farther.
const FIRST: i32 = -7 * PER_DOUBLING;
const LAST: i32 = 20 * PER_DOUBLING;

/// The last mantissas before 2^¼, 2^½ and 2^¾, as floats have them.
const BETWEEN: [u32; PER_DOUBLING as usize - 1] = [0x18_37f0, 0x35_04f3, 0x57_44fc];

/// Bands of distance, four from one distance to twice that.
#[derive(Debug)]
pub struct Bands {
    /// Where they end, metres.
    ends: Vec<f64>,
}

impl Bands {
    pub fn new() -> Self {
        let ends = FIRST..=LAST;
        Self {
            ends: ends
                .map(|step| libm::exp2(f64::from(step) / f64::from(PER_DOUBLING)))
                .collect(),
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// The band of a distance, metres.
    pub fn of(distance: f32) -> usize {
        // What is at least 2^e is beyond the end at 2^e and those before, and below the end at twice that: which of the ends between it is beyond the mantissa says.
        let bits = distance.to_bits();
        let e = (bits >> (f32::MANTISSA_DIGITS - 1)).cast_signed() - (f32::MAX_EXP - 1);
        let mantissa = bits & ((1 << (f32::MANTISSA_DIGITS - 1)) - 1);
        let passed: i32 = BETWEEN.iter().map(|between| i32::from(mantissa > *between)).sum();
        let before = (e * PER_DOUBLING - FIRST + 1 + passed).clamp(0, LAST - FIRST);
        before as usize
    }

    /// From where to where a band goes, metres.
    pub fn bounds(&self, band: usize) -> [f64; 2] {
        let from = band.checked_sub(1).map_or(0.0, |before| self.ends[before]);
        [from, self.ends[band]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn bands_go_on_where_others_end_from_no_distance_to_any() {
        let bands = Bands::new();
        assert_eq!((Bands::of(0.0), Bands::of(f32::MAX)), (0, bands.len() - 1));
        for band in 1..bands.len() {
            assert_eq!(bands.bounds(band)[0].to_bits(), bands.bounds(band - 1)[1].to_bits());
        }
        let of_one = bands.bounds(Bands::of(1.0)).map(f64::to_bits);
        assert_eq!(
            of_one,
            [1.0, 2.0_f64.powf(0.25)].map(f64::to_bits),
            "an end belongs to the next"
        );
        assert_eq!(bands.bounds(Bands::of(0.999_999))[1].to_bits(), 1.0_f64.to_bits());
    }

    proptest! {
        #[test]
        fn a_distance_is_within_its_band(distance in 0.0..1e6_f32) {
            let bands = Bands::new();
            let [from, to] = bands.bounds(Bands::of(distance));
            prop_assert!((from..to).contains(&f64::from(distance)));
        }

        #[test]
        fn an_end_parts_neighbouring_floats(band in 1..(LAST - FIRST) as usize, off in -3..=3_i32) {
            let bands = Bands::new();
            let near = (bands.bounds(band)[0] as f32).to_bits();
            let distance = f32::from_bits(near.wrapping_add_signed(off));
            let [from, to] = bands.bounds(Bands::of(distance));
            prop_assert!((from..to).contains(&f64::from(distance)));
        }
    }
}
