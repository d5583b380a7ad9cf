//! All tests of a study as one family: which of them can show anything, their adjusted p-values, and what to make of them.

use serde::{Deserialize, Serialize};

use super::contrasts::Contrasts;
use super::effect::{Dependence, Effect, Interaction, LevelMean, Parts};
use super::pair::{Pair, differ, gain_of};
use super::verdict::Verdict;
use super::{Design, SIGNIFICANT, Side};
use crate::statistics::{Tested, fewest_trials, holm, least_of_groups, least_of_pairs, testable};

/// The tests over which p-values are adjusted, and those that are none of them.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Family {
    /// Tests that can show something, over which p-values are adjusted.
    pub tests: u64,
    /// Tests left out because the two sides are the same in every trial, or one has no value.
    pub alike: u64,
    /// Tests left out because so few trials, or so few that differ, cannot show anything.
    pub impossible: u64,
    /// The fewest trials of each setting that can show one of as many differences as `tests` and `impossible` together.
    pub trials_needed: Option<u64>,
}

/// Everything that a study holds against each other.
#[derive(Debug, Default)]
pub(super) struct Tests {
    pub pairs: Vec<Pair>,
    pub means: Vec<LevelMean>,
    pub effects: Vec<Effect>,
    pub interactions: Vec<Interaction>,
    pub family: Family,
}

impl Tests {
    /// All tests that the design asks for, their p-values adjusted as one family.
    pub(super) fn of(design: &Design, trials: &[Side]) -> Self {
        let labels: Vec<&[String]> = trials.iter().map(|side| side.levels).collect();
        let paired = trials.windows(2).all(|two| two[0].seed == two[1].seed);
        let contrasts = Contrasts::of(&design.factors, &labels, design.reference, paired);
        let all = (contrasts.count() * design.compared.len()).max(1);
        let apart: usize = design
            .compared
            .iter()
            .map(|&figure| {
                contrasts
                    .pairs
                    .iter()
                    .filter(|pair| differ(trials, figure, **pair))
                    .count()
            })
            .sum();
        let alpha = SIGNIFICANT / (apart + all - contrasts.pairs.len() * design.compared.len()).max(1) as f64;
        let mut tests = Self::default();
        let mut found: [Vec<Option<Tested>>; 3] = Default::default();
        for &figure in &design.compared {
            for &[a, b] in &contrasts.pairs {
                let (pair, tested) = Pair::of(design, figure, [&trials[a], &trials[b]], alpha, all);
                tests.pairs.push(pair);
                found[0].push(tested);
            }
            let Some(grid) = &contrasts.grid else { continue };
            let parts = Parts::of(figure, trials);
            tests.means.extend(LevelMean::all(design, figure, grid, &parts));
            for &levels in &contrasts.effects {
                let (effect, tested) = Effect::of(design, figure, (grid, levels), &parts, all);
                tests.effects.push(effect);
                found[1].push(tested);
            }
            for &factors in &contrasts.interactions {
                let (interaction, tested) = Interaction::of(design, figure, (grid, factors), &parts, all);
                tests.interactions.push(interaction);
                found[2].push(tested);
            }
        }
        tests.judge(design, &found.concat(), paired);
        tests
    }

    /// Adjusts the p-values, of pairs, effects and interactions in this order, and says what to make of them.
    fn judge(&mut self, design: &Design, found: &[Option<Tested>], paired: bool) {
        let least: Vec<Option<f64>> = found.iter().map(|tested| tested.map(|tested| tested.least)).collect();
        let able = testable(&least, SIGNIFICANT);
        let of = |place: usize| found[place].filter(|_| able[place]).map(|tested| tested.p);
        let adjusted = holm(&(0..found.len()).map(of).collect::<Vec<_>>());
        let mut outcomes = found.iter().zip(adjusted).map(|(tested, p)| Outcome::of(*tested, p));
        let mut next = || outcomes.next().unwrap_or(Outcome::NotComparable);
        let better = |key: &str, difference: Option<f64>| {
            let figure = design.figures.iter().find(|figure| figure.key == key)?;
            Some(gain_of(figure.better, difference?) > 0.0)
        };
        for pair in &mut self.pairs {
            let outcome = next();
            pair.p_adjusted = outcome.p();
            pair.verdict = outcome.verdict(better(&pair.figure, pair.difference.value));
        }
        for effect in &mut self.effects {
            let outcome = next();
            effect.p_adjusted = outcome.p();
            effect.verdict = outcome.verdict(better(&effect.figure, effect.difference.value));
        }
        for interaction in &mut self.interactions {
            let outcome = next();
            interaction.p_adjusted = outcome.p();
            interaction.verdict = outcome.dependence();
        }
        let count = |of: &dyn Fn(usize) -> bool| (0..found.len()).filter(|&place| of(place)).count() as u64;
        let tests = count(&|place| able[place]);
        let alike = count(&|place| found[place].is_none_or(|tested| tested.alike));
        let impossible = found.len() as u64 - tests - alike;
        let asked = (tests + impossible) as usize;
        self.family = Family {
            tests,
            alike,
            impossible,
            trials_needed: fewest_trials(asked.max(1), SIGNIFICANT, |trials| {
                if paired {
                    least_of_pairs(trials)
                } else {
                    least_of_groups(trials, trials)
                }
            }),
        };
    }
}

/// What came of a test.
#[derive(Clone, Copy)]
enum Outcome {
    /// Its p-value, adjusted.
    Adjusted(f64),
    /// The two sides are the same in every trial.
    Alike,
    /// It could not have shown anything.
    Impossible,
    /// There is nothing to test.
    NotComparable,
}

impl Outcome {
    fn of(tested: Option<Tested>, adjusted: Option<f64>) -> Self {
        match (tested, adjusted) {
            (None, _) => Self::NotComparable,
            (_, Some(p)) => Self::Adjusted(p),
            (Some(tested), None) if tested.alike => Self::Alike,
            (Some(_), None) => Self::Impossible,
        }
    }

    fn p(self) -> Option<f64> {
        match self {
            Self::Adjusted(p) => Some(p),
            _ => None,
        }
    }

    /// Of a difference that is for the better, or not.
    fn verdict(self, better: Option<bool>) -> Verdict {
        match (self, better) {
            (Self::NotComparable, _) | (_, None) => Verdict::NotComparable,
            (Self::Impossible, _) => Verdict::CannotTell,
            (Self::Adjusted(p), Some(better)) if p < SIGNIFICANT => {
                if better {
                    Verdict::Better
                } else {
                    Verdict::Worse
                }
            }
            (Self::Adjusted(_) | Self::Alike, _) => Verdict::NoDetectableDifference,
        }
    }

    fn dependence(self) -> Dependence {
        match self {
            Self::NotComparable => Dependence::NotComparable,
            Self::Impossible => Dependence::CannotTell,
            Self::Adjusted(p) if p < SIGNIFICANT => Dependence::Depends,
            Self::Adjusted(_) | Self::Alike => Dependence::NoDetectableDependence,
        }
    }
}
