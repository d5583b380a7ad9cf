//! A part of an experiment's trials, for one of several processes.

use std::fmt;
use std::num::NonZeroU32;
use std::str::FromStr;

/// The trials that one of several processes runs: of `of` shards, number `number` has the trials k with k mod `of` = `number` − 1. A trial
/// has the same seed, and gives the same bytes, in whatever shard it is run.
///
/// ```
/// use desim::experiment::Shard;
///
/// let second: Shard = "2/4".parse()?;
/// assert_eq!(second.trials(11).collect::<Vec<_>>(), [1, 5, 9]);
/// assert_eq!(Shard::WHOLE.trials(3).collect::<Vec<_>>(), [0, 1, 2]);
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Shard {
    number: u32,
    of: NonZeroU32,
}

impl Shard {
    /// All trials.
    pub const WHOLE: Self = Self {
        number: 1,
        of: NonZeroU32::MIN,
    };
    /// Most shards that an experiment may be split into: as many as it may have trials.
    pub const MOST: u32 = 1_000_000;

    /// Shard `number`, from 1, of `of`.
    ///
    /// # Errors
    /// In words, if there is no such shard.
    pub fn new(number: u32, of: u32) -> Result<Self, String> {
        let of = NonZeroU32::new(of).filter(|of| of.get() <= Self::MOST);
        let of = of.ok_or_else(|| format!("the number of shards is from 1 to {}", Self::MOST))?;
        if (1..=of.get()).contains(&number) {
            Ok(Self { number, of })
        } else {
            Err(format!(
                "of {of} shards there is no number {number}: they are 1 to {of}"
            ))
        }
    }

    /// Its number, from 1.
    #[must_use]
    pub const fn number(self) -> u32 {
        self.number
    }

    /// How many shards there are.
    #[must_use]
    pub const fn of(self) -> u32 {
        self.of.get()
    }

    /// The number of the one shard, of `of`, that has this trial.
    #[must_use]
    pub const fn having(trial: u32, of: NonZeroU32) -> u32 {
        trial % of.get() + 1
    }

    /// Its trials, of so many.
    #[must_use]
    pub fn trials(self, trials: u32) -> impl ExactSizeIterator<Item = u32> {
        (self.number - 1..trials).step_by(self.of.get() as usize)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/');
        let numbers = numbers.and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        let (number, of) = numbers
            .ok_or("expected I/N, such as 2/4 for the second of four, or auto/N where a scheduler says which")?;
        Self::new(number, of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_trial_is_in_one_shard(trials in 0_u32..200, of in 1_u32..50) {
            let shards = (1..=of).map(|number| Shard::new(number, of).unwrap());
            let mut all: Vec<(u32, u32)> = shards
                .flat_map(|shard| shard.trials(trials).map(move |trial| (trial, shard.number())))
                .collect();
            all.sort_unstable();
            let of = NonZeroU32::new(of).unwrap();
            let expected: Vec<_> = (0..trials).map(|trial| (trial, Shard::having(trial, of))).collect();
            prop_assert_eq!(all, expected);
        }

        #[test]
        fn a_shard_reads_back_as_it_is_shown(number in 1_u32..1000, more in 0_u32..1000) {
            let shard = Shard::new(number, number + more).unwrap();
            prop_assert_eq!(shard.to_string().parse::<Shard>(), Ok(shard));
        }
    }

    #[test]
    fn what_is_no_shard_is_refused() {
        for text in [
            "0/4",
            "5/4",
            "1/0",
            "1",
            "/",
            "a/4",
            "1/4/2",
            "-1/4",
            "1/1000001",
            "1/4294967296",
            "",
        ] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }
}
