//! What all trials tell of the figures of a protocol, in a few bytes of memory a trial: figures are kept one by one, each as columns.

use super::exemplars::Told;
use super::figure::{Figure, Sample, longest_cut_off};
use crate::spool::{Columns, Scratch};
use crate::statistics::{Estimate, Lasting, Part, Times, pseudo_values_in_a_row};

/// What trials tell of a number of figures.
#[derive(Clone, Debug)]
pub struct Samples {
    /// Of each figure the numerators, then the denominators: a row a trial.
    parts: Columns,
    more: Vec<More>,
}

/// What few trials tell of a figure, or few figures ask for.
#[derive(Clone, Debug, Default)]
struct More {
    /// The places of the trials whose value was cut off.
    cut_off: Vec<u32>,
    /// The times that trials tell of, one trial after another.
    times: Times,
    /// How many each tells of, up to the last that tells of any.
    counts: Vec<u32>,
}

/// What all trials tell of one figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Pooled {
    /// Numerator and denominator of each trial, in order; both 0 where it tells nothing.
    pub parts: Vec<Part>,
    /// What is known of the times, where the figure is their mean.
    pub lasting: Option<Lasting>,
    /// The longest of what trials tell of, if it was cut off.
    longest: Option<f64>,
    /// The places of the trials whose value was cut off.
    cut_off: Vec<u32>,
}

impl Samples {
    /// None yet, of so many figures.
    #[must_use]
    pub fn new(figures: usize) -> Self {
        Self {
            parts: Columns::new(2 * figures, &Scratch::default()),
            more: (0..figures).map(|_| More::default()).collect(),
        }
    }

    /// Adds what the next trial tells of each figure.
    ///
    /// # Panics
    /// If it is not a sample for each.
    pub fn push(&mut self, trial: &[Sample]) {
        let place = self.parts.len();
        self.parts.push(trial.iter().flat_map(|sample| sample.part));
        for (more, sample) in self.more.iter_mut().zip(trial) {
            if sample.is_censored {
                more.cut_off.push(place as u32);
            }
            if !sample.times.is_empty() {
                more.counts.resize(place, 0);
                more.counts.push(sample.times.len() as u32);
                more.times.extend(sample.times.iter());
            }
        }
    }

    /// How many trials there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.parts.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// The times that trials tell of figure number `place`, from 0, one trial after another; none where it is no mean of times.
    ///
    /// # Panics
    /// If there is no such figure.
    #[must_use]
    pub fn times(&self, place: usize) -> &Times {
        &self.more[place].times
    }

    /// What all trials tell of figure number `place`, from 0.
    ///
    /// # Panics
    /// If there is no such figure.
    #[must_use]
    pub fn of(&self, place: usize) -> Pooled {
        let More { cut_off, times, counts } = &self.more[place];
        let cut_off = cut_off.clone();
        if !times.is_empty() {
            let silent = self.parts.len() - counts.len();
            let counts = counts.iter().map(|count| *count as usize);
            let (parts, lasting) = pseudo_values_in_a_row(times, counts.chain(std::iter::repeat_n(0, silent)));
            return Pooled {
                parts,
                lasting: Some(lasting),
                longest: longest_cut_off(times.iter().map(|seen| (seen.time, !seen.happened))),
                cut_off,
            };
        }
        let [above, below] = [0, 1].map(|part| self.parts.column(2 * place + part));
        let parts: Vec<Part> = above.into_iter().zip(below).map(Part::from).collect();
        let mut pooled = Pooled {
            parts,
            lasting: None,
            longest: None,
            cut_off,
        };
        if !pooled.cut_off.is_empty() {
            pooled.longest = longest_cut_off(pooled.values().map(|(_, value, is_cut_off)| (value, is_cut_off)));
        }
        pooled
    }
}

impl From<Vec<Vec<Sample>>> for Samples {
    /// Of `samples[figure][trial]`: as many trials of each figure as the first has.
    ///
    /// # Panics
    /// If a figure has fewer.
    fn from(samples: Vec<Vec<Sample>>) -> Self {
        let mut kept = Self::new(samples.len());
        let trials = samples.first().map_or(0, Vec::len);
        let mut figures: Vec<_> = samples.into_iter().map(Vec::into_iter).collect();
        for _ in 0..trials {
            kept.push(&figures.iter_mut().filter_map(Iterator::next).collect::<Vec<_>>());
        }
        kept
    }
}

impl Pooled {
    /// The least value that was cut off; infinite where none was, and where the figure is a mean of times, which is restricted as a whole.
    #[must_use]
    pub fn least_cut_off(&self) -> f64 {
        let cut_off = self.cut_off.iter().filter(|_| self.lasting.is_none());
        cut_off
            .map(|place| self.parts[*place as usize][0])
            .fold(f64::INFINITY, f64::min)
    }

    /// Restricts every trial's value to `limit`: what is more is cut off there.
    pub fn restrict(&mut self, limit: f64) {
        if self.lasting.is_some() || limit.is_infinite() {
            return;
        }
        let mut cut_off = Vec::new();
        for (place, part) in (0..).zip(&mut self.parts) {
            let was_cut_off = self.cut_off.binary_search(&place).is_ok();
            if was_cut_off || (part[1] > 0.0 && part[0] > limit) {
                cut_off.push(place);
            }
            if part[1] > 0.0 {
                part[0] = part[0].min(limit);
            }
        }
        self.cut_off = cut_off;
        self.longest = longest_cut_off(self.values().map(|(_, value, is_cut_off)| (value, is_cut_off)));
    }

    /// What each trial tells, without the times.
    #[must_use]
    pub fn samples(&self) -> Vec<Sample> {
        let mut samples: Vec<Sample> = self.parts.iter().map(|part| Sample::ratio(*part)).collect();
        for place in &self.cut_off {
            samples[*place as usize].is_censored = true;
        }
        samples
    }

    /// `figure`, which these are of, over all trials.
    #[must_use]
    pub fn estimate(&self, figure: &Figure) -> Estimate {
        figure.estimator.estimate(&self.parts).at_most(self.longest)
    }

    /// How many trials have a value that was cut off.
    #[must_use]
    pub fn cut_off(&self) -> u64 {
        self.cut_off.len() as u64
    }

    /// What trials tell that have a value of their own; `numbers` are those of all of them.
    pub fn told<'a>(&'a self, numbers: &'a [u32]) -> impl Iterator<Item = Told> + 'a {
        self.values().map(|(place, value, is_censored)| Told {
            trial: numbers[place],
            value,
            is_censored,
        })
    }

    /// The places of the trials that have a value of their own, the value, and whether it was cut off.
    pub(in crate::metrics) fn values(&self) -> impl Iterator<Item = (usize, f64, bool)> + '_ {
        let with_value = self.parts.iter().enumerate().filter(|(_, part)| part[1] > 0.0);
        with_value.map(|(place, part)| {
            let is_cut_off = self.cut_off.binary_search(&(place as u32)).is_ok();
            (place, part[0] / part[1], is_cut_off)
        })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::figure::{Better, parts, pool};
    use super::*;
    use crate::statistics::{Estimator, Observation};

    fn figure(estimator: Estimator) -> Figure {
        Figure {
            key: "a".into(),
            name: "a".into(),
            unit: "s".into(),
            better: Better::Lower,
            is_ratio: false,
            estimator,
        }
    }

    /// What a trial may tell: a value that may be cut off, or nothing; or a few times.
    fn sample(of_times: bool) -> impl Strategy<Value = Sample> {
        let time = (0_u32..20, any::<bool>()).prop_map(|(time, happened)| Observation {
            time: f64::from(time) / 7.0,
            happened,
        });
        let times = prop::collection::vec(time, 0..4).prop_map(|times| Sample::times(times.into_iter().collect()));
        let plain = (0_u32..20, 0_u32..3, any::<bool>()).prop_map(|(value, below, is_censored)| Sample {
            is_censored: is_censored && below > 0,
            ..Sample::ratio([f64::from(value.min(20 * below)) / 7.0, f64::from(below)])
        });
        if of_times { times.boxed() } else { plain.boxed() }
    }

    proptest! {
        #[test]
        fn what_is_kept_as_columns_estimates_and_tells_what_samples_do_to_the_last_bit(
            plain in prop::collection::vec(sample(false), 1..40), lasting in prop::collection::vec(sample(true), 1..40),
        ) {
            let mut kept = Samples::new(2);
            let (plain, mut lasting): (Vec<Sample>, Vec<Sample>) = plain.into_iter().zip(lasting).unzip();
            for (plain, lasting) in plain.iter().zip(&lasting) {
                kept.push(&[plain.clone(), lasting.clone()]);
            }
            let seen = pool(&mut lasting);
            let numbers: Vec<u32> = (0..plain.len() as u32).map(|number| number * 3).collect();
            for (place, samples) in [plain, lasting].iter().enumerate() {
                let pooled = kept.of(place);
                prop_assert_eq!(&pooled.parts, &parts(samples));
                prop_assert_eq!(pooled.lasting, seen.filter(|_| place == 1));
                prop_assert_eq!(pooled.cut_off(), samples.iter().filter(|sample| sample.is_censored).count() as u64);
                for estimator in [Estimator::Mean, Estimator::Median, Estimator::Times, Estimator::Rate] {
                    let figure = figure(estimator);
                    prop_assert_eq!(pooled.estimate(&figure), figure.estimate(samples));
                }
                let told: Vec<Told> = numbers.iter().zip(samples).filter_map(|(number, sample)| Told::of(*number, sample)).collect();
                prop_assert_eq!(pooled.told(&numbers).collect::<Vec<_>>(), told);
            }
        }
    }
}
