//! What robots count and measure under names of their own, for figures of their protocol.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::engine::ActorId;

/// The greatest count that tables can hold.
const MOST: u64 = i64::MAX as u64;

/// What one robot noted under one name in a trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Noted {
    /// The name.
    pub name: String,
    /// The robot.
    pub robot: ActorId,
    /// What it noted.
    pub amount: Amount,
}

impl Noted {
    /// What `robot` counted under `name`.
    #[must_use]
    pub fn counted(name: &str, robot: ActorId, count: u64) -> Self {
        Self {
            name: name.to_owned(),
            robot,
            amount: Amount::Count(count.min(MOST)),
        }
    }

    /// What `robot` measured under `name`.
    ///
    /// # Panics
    /// If there is no value, or one is not finite.
    #[must_use]
    pub fn measured(name: &str, robot: ActorId, values: impl IntoIterator<Item = f64>) -> Self {
        let values = values.into_iter().map(|value| {
            assert!(value.is_finite(), "{value} is no measured value");
            Values::one(value)
        });
        let all = values.reduce(Values::and);
        Self {
            name: name.to_owned(),
            robot,
            amount: Amount::Values(all.expect("a value at least")),
        }
    }

    /// Its place among others: by name, then by robot, a count before values.
    pub(super) fn place(&self) -> (&str, ActorId, bool) {
        (&self.name, self.robot, matches!(self.amount, Amount::Values(_)))
    }
}

/// A count or measured values. Who counts and measures under one name has an entry for each.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Amount {
    /// The sum of what it [counted](crate::protocol::Output::count): at most 2⁶³ − 1, beyond which it stays there.
    Count(u64),
    /// What it [measured](crate::protocol::Output::measure).
    Values(Values),
}

/// Binary digits of a value that its bucket keeps, beside the leading one.
const DIGITS: u32 = 7;
/// Binary digits of a value that its bucket forgets.
const FORGOTTEN: u32 = f64::MANTISSA_DIGITS - 1 - DIGITS;

/// Measured values: their number, sum and extremes, and how they spread, in room that does not grow with their number.
///
/// Every power of two is cut into 128 buckets of equal width, so a value's bucket tells it to less than 1/128. It is named by the
/// end that is nearer to zero: whole numbers up to 256 are exact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Values {
    /// How many there are, one at least.
    pub count: u64,
    /// Their sum; one that a 64-bit number cannot hold stays at the greatest that it can.
    pub sum: f64,
    /// The least, exactly.
    pub min: f64,
    /// The greatest, exactly.
    pub max: f64,
    /// How many there are in each bucket that has some, by the bucket's number: from the least values to the greatest.
    buckets: BTreeMap<i32, u64>,
}

impl Values {
    /// A single value, which is finite.
    pub(super) fn one(value: f64) -> Self {
        Self {
            count: 1,
            sum: value,
            min: value,
            max: value,
            buckets: BTreeMap::from([(bucket_of(value), 1)]),
        }
    }

    /// Values of which number, sum and extremes are known, with the `buckets` that [`buckets`](Self::buckets) tells of them.
    #[must_use]
    pub fn restored(sum: f64, min: f64, max: f64, buckets: impl IntoIterator<Item = (f64, u64)>) -> Self {
        let buckets: BTreeMap<i32, u64> = buckets
            .into_iter()
            .map(|(value, count)| (bucket_of(value), count))
            .collect();
        Self {
            count: buckets.values().sum(),
            sum,
            min,
            max,
            buckets,
        }
    }

    /// These and `other` values together.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.count += other.count;
        self.sum = (self.sum + other.sum).clamp(f64::MIN, f64::MAX);
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
        for (bucket, count) in other.buckets {
            *self.buckets.entry(bucket).or_default() += count;
        }
        self
    }

    pub(super) fn add(&mut self, value: f64) {
        self.count += 1;
        self.sum = (self.sum + value).clamp(f64::MIN, f64::MAX);
        self.min = self.min.min(value);
        self.max = self.max.max(value);
        *self.buckets.entry(bucket_of(value)).or_default() += 1;
    }

    /// The mean.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.sum / self.count as f64
    }

    /// The buckets that hold something, from the least to the greatest: the end of each that is nearer to zero, and how many
    /// values are in it.
    pub fn buckets(&self) -> impl Iterator<Item = (f64, u64)> {
        self.buckets.iter().map(|(&bucket, &count)| (end_of(bucket), count))
    }

    /// The `q`-quantile, `q` in [0, 1]: the ⌈q·n⌉-th least value, the least and the greatest exactly, the others as their
    /// buckets tell them: less than 1/128 nearer to zero, and exact of whole numbers up to 256.
    #[must_use]
    pub fn quantile(&self, q: f64) -> f64 {
        let rank = ((q * self.count as f64).ceil() as u64).clamp(1, self.count);
        if rank == self.count {
            return self.max;
        }
        if rank == 1 {
            return self.min;
        }
        let mut below = 0;
        let bucket = self.buckets().find(|(_, count)| {
            below += count;
            below >= rank
        });
        bucket.map_or(self.max, |(value, _)| value.clamp(self.min, self.max))
    }
}

/// The number of the bucket that holds `value`: 0 holds zero alone, and negative values mirror positive ones.
fn bucket_of(value: f64) -> i32 {
    let magnitude = (value.abs().to_bits() >> FORGOTTEN) as i32 + 1;
    match value {
        0.0 => 0,
        _ if value < 0.0 => -magnitude,
        _ => magnitude,
    }
}

/// The end of a bucket that is nearer to zero.
fn end_of(bucket: i32) -> f64 {
    let magnitude = u64::from(bucket.unsigned_abs().saturating_sub(1));
    let end = f64::from_bits(magnitude << FORGOTTEN);
    if bucket < 0 { -end } else { end }
}

/// The notes of a run.
#[derive(Debug, Default)]
pub(super) struct Notes {
    counts: BTreeMap<(&'static str, ActorId), u64>,
    values: BTreeMap<(&'static str, ActorId), Values>,
}

impl Notes {
    /// `robot` counts `n` more under `name`.
    pub(super) fn count(&mut self, robot: ActorId, name: &'static str, n: u64) {
        let count = self.counts.entry((name, robot)).or_default();
        *count = count.saturating_add(n).min(MOST);
    }

    /// `robot` measured a finite `value` under `name`.
    pub(super) fn value(&mut self, robot: ActorId, name: &'static str, value: f64) {
        self.values
            .entry((name, robot))
            .and_modify(|values| values.add(value))
            .or_insert_with(|| Values::one(value));
    }

    /// What was noted, in order of names, then of robots; a count before values.
    pub(super) fn into_records(self) -> Vec<Noted> {
        let counts = self.counts.into_iter().map(|(key, count)| (key, Amount::Count(count)));
        let values = self
            .values
            .into_iter()
            .map(|(key, values)| (key, Amount::Values(values)));
        let mut noted: Vec<_> = counts.chain(values).collect();
        noted.sort_by_key(|(key, _)| *key);
        let record = |((name, robot), amount): ((&str, ActorId), Amount)| Noted {
            name: name.to_owned(),
            robot,
            amount,
        };
        noted.into_iter().map(record).collect()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn values(measured: &[f64]) -> Values {
        let mut notes = Notes::default();
        for &value in measured {
            notes.value(ActorId(0), "way", value);
        }
        let [
            Noted {
                amount: Amount::Values(values),
                ..
            },
        ] = &notes.into_records()[..]
        else {
            panic!("one robot measured one thing")
        };
        values.clone()
    }

    #[test]
    fn whole_numbers_are_told_exactly_with_their_quantiles() {
        let hops: Vec<f64> = (-256..=256).map(f64::from).collect();
        let told = values(&hops);
        assert_eq!(told.buckets().map(|(value, _)| value).collect::<Vec<_>>(), hops);
        assert!(told.buckets().all(|(_, count)| count == 1));
        assert_eq!((told.count, told.sum, told.min, told.max), (513, 0.0, -256.0, 256.0));
        let quantiles = [0.0, 0.5, 1.0].map(|q| told.quantile(q));
        assert_eq!(quantiles.to_vec(), [-256.0, 0.0, 256.0].to_vec());
    }

    #[test]
    fn entries_stand_in_order_of_names_and_robots_and_a_count_stays_where_tables_end() {
        let mut notes = Notes::default();
        notes.value(ActorId(1), "hops", 2.0);
        notes.count(ActorId(1), "hops", 5);
        notes.count(ActorId(0), "hops", 3);
        notes.count(ActorId(0), "hops", 4);
        notes.count(ActorId(9), "drops", u64::MAX);
        let found: Vec<_> = notes
            .into_records()
            .into_iter()
            .map(|noted| {
                let count = match noted.amount {
                    Amount::Count(count) => Some(count),
                    Amount::Values(_) => None,
                };
                (noted.name, noted.robot.0, count)
            })
            .collect();
        let entry = |name: &str, robot, count| (name.to_owned(), robot, count);
        let expected = [
            entry("drops", 9, Some(MOST)),
            entry("hops", 0, Some(7)),
            entry("hops", 1, Some(5)),
            entry("hops", 1, None),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn a_sum_that_is_too_great_stays_finite() {
        let sum = |value| Some(values(&[value, value]).sum);
        assert_eq!([sum(f64::MAX), sum(f64::MIN)], [Some(f64::MAX), Some(f64::MIN)]);
    }

    proptest! {
        #[test]
        fn quantiles_are_within_a_128th_of_those_of_the_values_themselves(
            mut measured in prop::collection::vec(
                prop_oneof![-1e6_f64..1e6, Just(0.0), 1e-12_f64..1e-9, Just(-0.0)], 1..80),
            q in 0.0_f64..=1.0,
        ) {
            let told = values(&measured);
            measured.sort_by(f64::total_cmp);
            let rank = ((q * measured.len() as f64).ceil() as usize).max(1);
            let exact = measured[rank - 1];
            prop_assert!((told.quantile(q) - exact).abs() <= exact.abs() / 128.0, "{} {}", told.quantile(q), exact);
            let sum: f64 = measured.iter().sum();
            prop_assert!((told.sum - sum).abs() <= 1e-9 * measured.iter().map(|value| value.abs()).sum::<f64>());
            prop_assert_eq!(told.count, measured.len() as u64);
        }

        #[test]
        fn values_are_restored_from_what_they_tell(measured in prop::collection::vec(-1e300_f64..1e300, 1..40)) {
            let told = values(&measured);
            let again = Values::restored(told.sum, told.min, told.max, told.buckets().collect::<Vec<_>>());
            prop_assert_eq!(again, told);
        }
    }
}
