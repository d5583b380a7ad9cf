//! Which trials are missing, and which shards would run them.

use std::collections::BTreeSet;
use std::fmt;
use std::num::NonZeroU32;

use crate::experiment::{PartsError, Shard};

/// Trials that are missing, of a scenario or of several settings.
#[derive(Debug, Default)]
pub struct Lack {
    /// Those of each scenario that lacks any.
    pub of: Vec<MissingTrials>,
    /// The files that are called like trials and are none.
    pub damaged: Vec<PartsError>,
    /// Into how many shards the folders say that the experiment was split; more than one number where they say different things.
    pub splits: BTreeSet<NonZeroU32>,
}

/// Trials that are missing of a scenario.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingTrials {
    /// The setting, in a study.
    pub setting: Option<String>,
    /// Their numbers, in order.
    pub trials: Vec<u32>,
    /// How many there should be.
    pub of: u32,
}

impl Lack {
    /// The numbers of the shards that have missing trials, of so many shards, in order.
    #[must_use]
    pub fn shards(&self, of: NonZeroU32) -> BTreeSet<u32> {
        let trials = self.of.iter().flat_map(|missing| &missing.trials);
        trials.map(|trial| Shard::having(*trial, of)).collect()
    }
}

impl fmt::Display for Lack {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        for (line, missing) in self.of.iter().enumerate() {
            let setting = missing.setting.as_ref().map(|name| format!(" of {name}"));
            writeln!(
                f,
                "{}{} of {} trials{} are missing: {}",
                if line == 0 { "" } else { "  " },
                missing.trials.len(),
                missing.of,
                setting.unwrap_or_default(),
                ranges(missing.trials.iter().copied())
            )?;
        }
        for wrong in self.damaged.iter().take(DAMAGED) {
            writeln!(f, "  {wrong}")?;
        }
        if self.damaged.len() > DAMAGED {
            writeln!(
                f,
                "  and {} files more that are no finished trials",
                self.damaged.len() - DAMAGED
            )?;
        }
        for of in self.splits.iter().filter(|of| of.get() > 1) {
            let numbers = ranges(self.shards(*of));
            writeln!(
                f,
                "Run what is missing of {of} shards: --array={numbers} with --shard auto/{of}."
            )?;
        }
        write!(f, "Then put them together again; finished trials are kept.")
    }
}

/// How many damaged files are named.
const DAMAGED: usize = 10;

/// Numbers as Slurm writes them, one after the other as a range: `1,5-7`.
pub fn ranges(numbers: impl IntoIterator<Item = u32>) -> String {
    let mut ranges: Vec<[u32; 2]> = Vec::new();
    for number in numbers {
        match ranges.last_mut() {
            Some([_, last]) if *last + 1 == number => *last = number,
            _ => ranges.push([number; 2]),
        }
    }
    let range = |[first, last]: &[u32; 2]| {
        if first == last {
            first.to_string()
        } else {
            format!("{first}-{last}")
        }
    };
    ranges.iter().map(range).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_a_row_are_a_range() {
        assert_eq!(ranges([]), "");
        assert_eq!(ranges([3]), "3");
        assert_eq!(ranges([0, 1, 2, 4, 7, 8]), "0-2,4,7-8");
    }

    #[test]
    fn what_is_missing_is_said_with_the_shards_that_run_it() {
        let splits = [4, 1].into_iter().filter_map(NonZeroU32::new).collect();
        let missing = |setting: Option<&str>, trials: &[u32]| MissingTrials {
            setting: setting.map(str::to_owned),
            trials: trials.to_vec(),
            of: 10,
        };
        let lack = Lack {
            of: vec![missing(Some("a"), &[1, 5, 9]), missing(Some("b"), &[2])],
            splits,
            ..Lack::default()
        };
        assert_eq!(
            lack.to_string(),
            "3 of 10 trials of a are missing: 1,5,9\n  1 of 10 trials of b are missing: 2\n\
             Run what is missing of 4 shards: --array=2-3 with --shard auto/4.\n\
             Then put them together again; finished trials are kept."
        );
    }
}
