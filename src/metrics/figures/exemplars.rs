//! Trials that stand for the others: the one in the middle, and the worst.

use super::figure::{Better, Sample};

/// What a trial tells of a figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Told {
    /// Its number.
    pub trial: u32,
    /// Its own value.
    pub value: f64,
    /// Whether that was cut off: it would have grown larger.
    pub is_censored: bool,
}

impl Told {
    /// What a trial tells by its sample, if it has a value of its own.
    #[must_use]
    pub fn of(trial: u32, sample: &Sample) -> Option<Self> {
        Some(Self {
            trial,
            value: sample.value()?,
            is_censored: sample.is_censored,
        })
    }

    fn reads_as(&self, other: &Self) -> bool {
        self.value.total_cmp(&other.value).is_eq() && self.is_censored == other.is_censored
    }
}

/// The trials that stand for the others in a figure. Of those that read the same it is the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exemplars {
    /// Number of trials with a value.
    pub trials: usize,
    /// The one in the middle; of two the better.
    pub median: Told,
    /// The worst.
    pub worst: Told,
    /// Whether any two trials differ.
    pub differ: bool,
}

impl Exemplars {
    /// Among what trials tell of a figure that is `better` one way; `None` if none has a value.
    #[must_use]
    pub fn of(better: Better, told: &[Told]) -> Option<Self> {
        let mut ordered = told.to_vec();
        ordered.sort_by(|a, b| {
            let values = a.value.total_cmp(&b.value);
            // What was cut off is more than it reads.
            let from_least = values.then(a.is_censored.cmp(&b.is_censored));
            let from_best = match better {
                Better::Lower => from_least,
                Better::Higher => from_least.reverse(),
            };
            from_best.then(a.trial.cmp(&b.trial))
        });
        let first_like = |one: &Told| ordered.iter().find(|other| other.reads_as(one)).copied();
        let (first, last) = (ordered.first()?, ordered.last()?);
        Some(Self {
            trials: ordered.len(),
            median: first_like(&ordered[(ordered.len() - 1) / 2])?,
            worst: first_like(last)?,
            differ: !first.reads_as(last),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(values: &[(f64, bool)]) -> Vec<Told> {
        (0..)
            .zip(values)
            .map(|(trial, &(value, is_censored))| Told {
                trial,
                value,
                is_censored,
            })
            .collect()
    }

    fn chosen(better: Better, values: &[(f64, bool)]) -> (u32, u32) {
        let exemplars = Exemplars::of(better, &told(values)).expect("there are trials");
        (exemplars.median.trial, exemplars.worst.trial)
    }

    #[test]
    fn the_middle_and_the_worst_are_told_by_which_way_is_better() {
        let values = [7.0, 1.0, 9.0, 5.0, 3.0].map(|value| (value, false));
        assert_eq!(chosen(Better::Lower, &values), (3, 2));
        assert_eq!(chosen(Better::Higher, &values), (3, 1));
        // Of two in the middle the better: 5 of 5 and 7, or 7.
        assert_eq!(chosen(Better::Lower, &values[..4]), (3, 2));
        assert_eq!(chosen(Better::Higher, &values[..4]), (0, 1));
    }

    #[test]
    fn what_was_cut_off_is_worse_than_what_took_as_long_and_of_equal_ones_the_first_stands_for_all() {
        let values = [(4.0, false), (9.0, false), (9.0, true), (9.0, true), (4.0, false)];
        assert_eq!(chosen(Better::Lower, &values), (1, 2));
        let alike = Exemplars::of(Better::Lower, &told(&[(2.0, false); 3])).unwrap();
        assert_eq!((alike.differ, alike.median.trial, alike.worst.trial), (false, 0, 0));
        assert_eq!(Exemplars::of(Better::Lower, &[]), None);
    }
}
