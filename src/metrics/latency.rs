//! Latencies as a histogram of fixed relative width: recording one is a few integer instructions.
//!
//! Buckets are log-linear: every power of two is cut into 128 equal buckets, and spans below 256 ns have one each. A
//! bucket is thus never wider than 1/128 of its lower end, whatever the latency.

use serde::{Deserialize, Serialize};

use crate::engine::Span;

/// Binary digits of a latency that its bucket keeps, beside the leading one.
const DIGITS: u32 = 7;
/// Buckets that a power of two is cut into.
const PER_OCTAVE: u64 = 1 << DIGITS;

/// Counts of latencies, in nanoseconds; least, greatest, number and sum are exact.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LatencyHistogram {
    /// By bucket, up to the last that holds something.
    counts: Vec<u64>,
    count: u64,
    sum: u128,
    min: u64,
    max: u64,
}

impl Default for LatencyHistogram {
    fn default() -> Self {
        Self {
            counts: Vec::new(),
            count: 0,
            sum: 0,
            min: u64::MAX,
            max: 0,
        }
    }
}

impl LatencyHistogram {
    /// Counts one latency.
    #[inline]
    pub fn record(&mut self, latency: Span) {
        let nanos = latency.as_nanos();
        *self.bucket(nanos) += 1;
        self.count += 1;
        self.sum += u128::from(nanos);
        self.min = self.min.min(nanos);
        self.max = self.max.max(nanos);
    }

    /// A histogram still to be [`fill`](Self::fill)ed, of which least, greatest and sum in nanoseconds are known.
    #[must_use]
    pub fn exactly(min: u64, max: u64, sum: u128) -> Self {
        Self {
            sum,
            min,
            max,
            ..Self::default()
        }
    }

    /// Counts `count` latencies in the bucket from `low` to `high`, both in nanoseconds, as [`buckets`](Self::buckets) has it.
    pub fn fill(&mut self, (low, high, count): (u64, u64, u64)) {
        *self.bucket(low) += count;
        self.count += count;
        // No more than a bound where the extremes are not known.
        self.min = self.min.min(high);
        self.max = self.max.max(low);
    }

    /// The count of the bucket of a latency.
    #[inline]
    fn bucket(&mut self, nanos: u64) -> &mut u64 {
        let bucket = bucket_of(nanos);
        if bucket >= self.counts.len() {
            self.grow(bucket);
        }
        &mut self.counts[bucket]
    }

    // Apart: what every reception runs through stays small.
    #[cold]
    #[inline(never)]
    fn grow(&mut self, bucket: usize) {
        self.counts.resize(bucket + 1, 0);
    }

    /// Adds all latencies of `other`.
    pub fn merge(&mut self, other: &Self) {
        self.counts.resize(self.counts.len().max(other.counts.len()), 0);
        for (mine, theirs) in self.counts.iter_mut().zip(&other.counts) {
            *mine += theirs;
        }
        self.count += other.count;
        self.sum += other.sum;
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }

    /// Number of latencies.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The least latency, exactly; `None` when empty.
    #[must_use]
    pub fn min(&self) -> Option<Span> {
        (self.count > 0).then(|| Span::from_nanos(self.min))
    }

    /// The greatest latency, exactly; `None` when empty.
    #[must_use]
    pub fn max(&self) -> Option<Span> {
        (self.count > 0).then(|| Span::from_nanos(self.max))
    }

    /// Sum of all latencies in nanoseconds, exactly.
    #[must_use]
    pub fn sum_nanos(&self) -> u128 {
        self.sum
    }

    /// The mean in seconds; `None` when empty.
    #[must_use]
    pub fn mean_secs(&self) -> Option<f64> {
        (self.count > 0).then(|| self.sum as f64 / self.count as f64 / 1e9)
    }

    /// The `q`-quantile, `q` in [0, 1]: the middle of the bucket that holds the ⌈q·n⌉-th least latency, kept within
    /// [min, max], so at most 1/256 off and exact for a constant latency. `None` when empty.
    #[must_use]
    pub fn quantile(&self, q: f64) -> Option<Span> {
        let rank = ((q * self.count as f64).ceil() as u64).clamp(1, self.count.max(1));
        let mut below = 0;
        let (low, high, _) = self.buckets().find(|(_, _, count)| {
            below += count;
            below >= rank
        })?;
        let middle = low + (high - low) / 2;
        Some(Span::from_nanos(middle.clamp(self.min, self.max)))
    }

    /// The buckets that hold something, in order: their least and greatest latency in nanoseconds (both of them still
    /// in the bucket), and how many latencies they hold.
    pub fn buckets(&self) -> impl Iterator<Item = (u64, u64, u64)> {
        self.counts
            .iter()
            .enumerate()
            .filter(|&(_, &count)| count > 0)
            .map(|(index, &count)| {
                let (low, high) = bounds_of(index);
                (low, high, count)
            })
    }
}

/// The bucket of a latency: its leading digits, after those of all shorter latencies.
#[inline]
pub(super) fn bucket_of(nanos: u64) -> usize {
    let dropped = 63 - DIGITS - (nanos | PER_OCTAVE).leading_zeros();
    ((u64::from(dropped) << DIGITS) + (nanos >> dropped)) as usize
}

/// The least and the greatest latency of a bucket.
pub(super) fn bounds_of(bucket: usize) -> (u64, u64) {
    let bucket = bucket as u64;
    let dropped = (bucket >> DIGITS).saturating_sub(1);
    let low = (bucket - (dropped << DIGITS)) << dropped;
    (low, low + ((1 << dropped) - 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Buckets in all: two octaves of single nanoseconds, and one for each further octave of a `u64`.
    const BUCKETS: usize = (PER_OCTAVE as usize) * (64 - DIGITS as usize + 1);

    fn histogram_of(nanos: &[u64]) -> LatencyHistogram {
        let mut histogram = LatencyHistogram::default();
        for &n in nanos {
            histogram.record(Span::from_nanos(n));
        }
        histogram
    }

    #[test]
    fn buckets_tile_every_span_without_gap_or_overlap() {
        let mut next = 0_u64;
        for bucket in 0..BUCKETS {
            let (low, high) = bounds_of(bucket);
            assert_eq!(low, next);
            assert_eq!((bucket_of(low), bucket_of(high)), (bucket, bucket));
            next = high.wrapping_add(1);
        }
        assert_eq!(next, 0, "the last bucket ends at the greatest span");
    }

    #[test]
    fn a_constant_latency_is_every_quantile_of_itself() {
        let histogram = histogram_of(&[100_000_123; 50]);
        for q in [0.0, 0.5, 0.99, 1.0] {
            assert_eq!(histogram.quantile(q), Some(Span::from_nanos(100_000_123)));
        }
        assert_eq!(histogram.buckets().map(|(_, _, count)| count).sum::<u64>(), 50);
    }

    #[test]
    fn an_empty_histogram_has_no_quantile_and_no_extremes() {
        let empty = LatencyHistogram::default();
        assert_eq!(
            (empty.quantile(0.5), empty.min(), empty.max(), empty.mean_secs()),
            (None, None, None, None)
        );
    }

    #[test]
    fn the_mean_is_exact_to_rounding() {
        assert_eq!(histogram_of(&[1_000_000_000, 2_000_000_000]).mean_secs(), Some(1.5));
    }

    #[test]
    fn a_histogram_filled_from_its_buckets_and_exact_figures_is_the_same() {
        let histogram = histogram_of(&[3, 1_000_003, 77_000_000, 77_000_001]);
        let mut again = LatencyHistogram::exactly(3, 77_000_001, histogram.sum_nanos());
        histogram.buckets().for_each(|bucket| again.fill(bucket));
        assert_eq!(again, histogram);
    }

    proptest! {
        #[test]
        fn no_bucket_is_wider_than_a_128th_of_its_lower_end(nanos: u64) {
            let (low, high) = bounds_of(bucket_of(nanos));
            prop_assert!(low <= nanos && nanos <= high);
            prop_assert!(high - low <= low / 128);
        }

        #[test]
        fn a_quantile_is_within_a_256th_of_the_order_statistic(
            mut nanos in prop::collection::vec(0..10_000_000_000_u64, 1..200), q in 0.0..=1.0_f64,
        ) {
            let found = histogram_of(&nanos).quantile(q).unwrap().as_nanos();
            nanos.sort_unstable();
            let rank = ((q * nanos.len() as f64).ceil() as usize).max(1);
            prop_assert!(found.abs_diff(nanos[rank - 1]) <= nanos[rank - 1] / 256 + 1);
        }

        #[test]
        fn merging_equals_recording_everything_in_one(
            a in prop::collection::vec(any::<u64>(), 0..50), b in prop::collection::vec(any::<u64>(), 0..50),
        ) {
            let mut merged = histogram_of(&a);
            merged.merge(&histogram_of(&b));
            prop_assert_eq!(merged, histogram_of(&[a, b].concat()));
        }
    }
}
