//! What is held against what: settings against each other, or, where every level of each factor stands with every one of the others,
//! levels against each other over all of those.

use super::Factor;
use crate::statistics::{fewest_trials, least_of_groups, least_of_pairs};

/// What a study holds against what, in each figure that it compares.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Contrasts {
    /// Places of settings: the one held against, and the setting.
    pub pairs: Vec<[usize; 2]>,
    /// Levels of one factor against each other.
    pub effects: Vec<Levels>,
    /// Places of two factors of which each may change what the other does.
    pub interactions: Vec<[usize; 2]>,
    /// The settings as a full design, if they are one.
    pub grid: Option<Grid>,
}

/// Two levels of a factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Levels {
    /// Place of the factor.
    pub factor: usize,
    /// Place of the level held against.
    pub against: usize,
    /// Place of the level.
    pub level: usize,
}

/// Settings that are every combination of the levels of two factors or more.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Grid {
    /// For each factor how many levels it has.
    sizes: Vec<usize>,
    /// For each combination, the levels of the last factor next to each other: the place of its setting.
    cells: Vec<usize>,
}

impl Contrasts {
    /// Contrasts of settings with these labels of levels, a label for each factor.
    ///
    /// Against a reference stand all other settings and, in a full design, all other levels; without one, levels stand against each other,
    /// pair by pair, and only where the design is not full the settings themselves. A full design counts only where trials are `paired`.
    #[must_use]
    pub fn of(factors: &[Factor], settings: &[&[String]], reference: Option<usize>, paired: bool) -> Self {
        let grid = paired.then(|| Grid::of(factors, settings)).flatten();
        let all = 0..settings.len();
        let pairs = match (reference, &grid) {
            (Some(reference), _) => all.filter(|&it| it != reference).map(|it| [reference, it]).collect(),
            (None, Some(_)) => Vec::new(),
            (None, None) => two_of(settings.len()).collect(),
        };
        let varied = || (0..factors.len()).filter(|&factor| factors[factor].levels.len() > 1);
        let mut contrasts = Self {
            pairs,
            ..Self::default()
        };
        let Some(grid) = grid else { return contrasts };
        for factor in varied() {
            let levels = factors[factor].levels.len();
            let base = reference.map(|reference| grid.level_of(reference, factor));
            let held: Vec<[usize; 2]> = match base {
                Some(base) => (0..levels)
                    .filter(|&level| level != base)
                    .map(|level| [base, level])
                    .collect(),
                None => two_of(levels).collect(),
            };
            contrasts.effects.extend(
                held.into_iter()
                    .map(|[against, level]| Levels { factor, against, level }),
            );
        }
        let varied: Vec<usize> = varied().collect();
        contrasts.interactions = two_of(varied.len()).map(|two| two.map(|place| varied[place])).collect();
        contrasts.grid = Some(grid);
        contrasts
    }

    /// Tests of each figure.
    #[must_use]
    pub fn count(&self) -> usize {
        self.pairs.len() + self.effects.len() + self.interactions.len()
    }
}

/// All pairs of so many things, the first of each before the second.
fn two_of(count: usize) -> impl Iterator<Item = [usize; 2]> {
    (0..count).flat_map(move |a| (a + 1..count).map(move |b| [a, b]))
}

impl Grid {
    /// `None` where fewer than two factors vary, or a combination is missing or there twice.
    fn of(factors: &[Factor], settings: &[&[String]]) -> Option<Self> {
        let sizes: Vec<usize> = factors.iter().map(|factor| factor.levels.len()).collect();
        let count = sizes.iter().try_fold(1_usize, |count, &size| count.checked_mul(size))?;
        if count != settings.len() || sizes.iter().filter(|&&size| size > 1).count() < 2 {
            return None;
        }
        let mut cells = vec![None; count];
        for (setting, labels) in settings.iter().enumerate() {
            let mut cell = 0;
            if labels.len() != factors.len() {
                return None;
            }
            for (factor, label) in factors.iter().zip(*labels) {
                cell = cell * factor.levels.len() + factor.levels.iter().position(|level| level == label)?;
            }
            if cells[cell].replace(setting).is_some() {
                return None;
            }
        }
        let cells = cells.into_iter().collect::<Option<_>>()?;
        Some(Self { sizes, cells })
    }

    /// The level of `factor` in a cell.
    fn level_in(&self, cell: usize, factor: usize) -> usize {
        let after: usize = self.sizes[factor + 1..].iter().product();
        cell / after % self.sizes[factor]
    }

    /// The level of `factor` in a setting.
    #[must_use]
    pub fn level_of(&self, setting: usize, factor: usize) -> usize {
        let cell = self.cells.iter().position(|&other| other == setting).unwrap_or(0);
        self.level_in(cell, factor)
    }

    /// How many levels a factor has.
    #[must_use]
    pub fn levels(&self, factor: usize) -> usize {
        self.sizes[factor]
    }

    /// The settings in which factors have these levels, in the order of all other levels.
    #[must_use]
    pub fn with(&self, levels: &[(usize, usize)]) -> Vec<usize> {
        let has = |cell: usize| {
            levels
                .iter()
                .all(|&(factor, level)| self.level_in(cell, factor) == level)
        };
        let cells = (0..self.cells.len()).filter(|&cell| has(cell));
        cells.map(|cell| self.cells[cell]).collect()
    }
}

/// Why a study cannot find anything, and what it would need.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TooFew {
    /// Tests of the study.
    pub tests: usize,
    /// The least p-value that one of them can give.
    pub least: f64,
    /// The fewest trials of each setting that can show one of so many differences.
    pub needed: u64,
    /// How many tests so few trials allow.
    pub allowed: usize,
}

impl TooFew {
    /// Whether no test of so many can be significant at level `alpha`, with so many trials of each setting.
    #[must_use]
    pub fn of(tests: usize, trials: u64, paired: bool, alpha: f64) -> Option<Self> {
        let least = |trials: u64| {
            if paired {
                least_of_pairs(trials)
            } else {
                least_of_groups(trials, trials)
            }
        };
        let needed = fewest_trials(tests, alpha, least)?;
        let at = least(trials);
        (tests > 0 && trials < needed).then(|| Self {
            tests,
            least: at,
            needed,
            // One less where the quotient is whole: below alpha is asked for, not at it.
            allowed: ((alpha / at).ceil() as usize).saturating_sub(1),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factor(name: &str, levels: &[&str]) -> Factor {
        Factor {
            name: name.into(),
            levels: levels.iter().map(|&level| level.into()).collect(),
        }
    }

    fn full(sizes: &[&[&str]]) -> Vec<Vec<String>> {
        sizes.iter().fold(vec![Vec::new()], |settings, levels| {
            let with = |setting: &Vec<String>, level: &str| setting.iter().cloned().chain([level.to_owned()]).collect();
            settings
                .iter()
                .flat_map(|setting| levels.iter().map(move |level| with(setting, level)))
                .collect()
        })
    }

    fn contrasts(factors: &[Factor], settings: &[Vec<String>], reference: Option<usize>) -> Contrasts {
        let labels: Vec<&[String]> = settings.iter().map(Vec::as_slice).collect();
        Contrasts::of(factors, &labels, reference, true)
    }

    #[test]
    fn twelve_settings_of_two_factors_are_nine_differences_between_levels_and_an_interaction_and_not_66_pairs() {
        let (a, b): (&[&str], &[&str]) = (&["0.5", "1.0", "2.0"], &["0", "0.2", "0.5", "1"]);
        let factors = [factor("a", a), factor("b", b)];
        let all = contrasts(&factors, &full(&[a, b]), None);
        assert_eq!(
            (all.pairs.len(), all.effects.len(), all.interactions.len()),
            (0, 3 + 6, 1)
        );
        let grid = all.grid.unwrap();
        assert_eq!(grid.with(&[(0, 1)]), [4, 5, 6, 7]);
        assert_eq!(grid.with(&[(1, 2), (0, 2)]), [10]);
        let held = contrasts(&factors, &full(&[a, b]), Some(5));
        assert_eq!(
            (held.pairs.len(), held.effects.len(), held.interactions.len()),
            (11, 2 + 3, 1)
        );
        assert!(
            held.effects.iter().all(|levels| levels.against == 1),
            "the reference has the second levels"
        );
    }

    #[test]
    fn three_factors_have_every_interaction_of_two_and_one_of_a_single_level_none() {
        let levels: [&[&str]; 4] = [&["x", "y"], &["only"], &["0", "1"], &["p", "q", "r"]];
        let factors = levels.map(|levels| factor(levels[0], levels));
        let all = contrasts(&factors, &full(&levels), None);
        assert_eq!(all.effects.len(), 1 + 1 + 3);
        assert_eq!(all.interactions, [[0, 2], [0, 3], [2, 3]]);
        let one = contrasts(&factors[1..3], &full(&levels[1..3]), None);
        assert_eq!((one.pairs.len(), one.effects.len()), (1, 0), "a single factor varies");
    }

    #[test]
    fn designs_that_are_not_full_hold_settings_against_each_other() {
        let factors = [factor("a", &["0", "1"]), factor("b", &["0", "1"])];
        let mut settings = full(&[&["0", "1"], &["0", "1"]]);
        let whole = contrasts(&factors, &settings, None);
        assert_eq!((whole.pairs.len(), whole.count()), (0, 3));
        settings[3] = settings[0].clone();
        assert_eq!(
            contrasts(&factors, &settings, None).pairs.len(),
            6,
            "a combination is there twice"
        );
        settings.truncate(3);
        let part = contrasts(&factors, &settings, Some(0));
        assert_eq!((part.pairs.len(), part.count()), (2, 2));
    }

    #[test]
    fn a_study_that_can_find_nothing_says_how_many_trials_it_needs() {
        // 2/2⁸ · 30 = 0.23; 2/2¹¹ · 30 = 0.029; 6 · 2/2⁸ = 0.047.
        let few = TooFew::of(30, 8, true, 0.05).unwrap();
        assert_eq!((few.needed, few.allowed), (11, 6));
        assert_eq!(TooFew::of(30, 11, true, 0.05), None);
        assert_eq!(TooFew::of(6, 8, true, 0.05), None);
        assert_eq!(TooFew::of(0, 2, true, 0.05), None);
        assert_eq!(TooFew::of(1, 1, true, 0.05).unwrap().allowed, 0);
        // Independent trials: 2/C(8, 4) = 0.029 is enough for one test, not for two.
        assert_eq!(TooFew::of(1, 4, false, 0.05), None);
        assert_eq!(TooFew::of(2, 4, false, 0.05).unwrap().needed, 5);
    }
}
