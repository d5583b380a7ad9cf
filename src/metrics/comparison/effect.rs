//! What single factors do, averaged over the levels of all others, and whether what one does depends on another. Every setting weighs
//! the same: means over levels are unweighted means of the settings' values, and trials are paired throughout.

use serde::{Deserialize, Serialize};

use super::contrasts::{Grid, Levels};
use super::{Design, Side, Verdict};
use crate::statistics::{
    Estimate, Estimator, Part, Tested, difference, paired_permutation, ratio_of_sums, sign_permutation,
};

/// A figure's mean over all settings in which a factor has one level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LevelMean {
    /// Key of the figure.
    pub figure: String,
    /// Name of the factor.
    pub factor: String,
    /// Label of the level.
    pub level: String,
    /// The unweighted mean over the other factors' levels, with its interval.
    pub mean: Estimate,
}

/// What one level of a factor does to a figure, held against another level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Effect {
    /// Key of the figure.
    pub figure: String,
    /// Name of the factor.
    pub factor: String,
    /// Label of the level.
    pub level: String,
    /// Label of the level that it is held against.
    pub against: String,
    /// The figure at the level less that at the other, mean over all levels of the other factors, with its interval.
    pub difference: Estimate,
    /// The difference over the other level's mean.
    pub relative: Option<f64>,
    /// Two-sided p-value of the permutation test in which each trial is swapped in all settings together.
    pub p: Option<f64>,
    /// The p-value by Holm's adjustment over the family; absent where it is not in it.
    pub p_adjusted: Option<f64>,
    /// What to make of it.
    pub verdict: Verdict,
    /// The same in words; filled in by the report.
    pub words: String,
}

/// Whether what one factor does to a figure depends on another, averaged over the levels of the rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Interaction {
    /// Key of the figure.
    pub figure: String,
    /// Names of the two factors.
    pub factors: [String; 2],
    /// Where it shows most: of the first factor, a level and the one that it is held against.
    pub first: [String; 2],
    /// Of the second factor, the same.
    pub second: [String; 2],
    /// What the first factor's step does at the second factor's level, and at the level held against.
    pub steps: [Option<f64>; 2],
    /// The former less the latter, a difference of differences, with its interval; it is the largest of all, which its interval does
    /// not allow for.
    pub difference: Estimate,
    /// Two-sided p-value of the permutation test of all differences of differences at once.
    pub p: Option<f64>,
    /// The p-value by Holm's adjustment over the family; absent where it is not in it.
    pub p_adjusted: Option<f64>,
    /// What to make of it.
    pub verdict: Dependence,
    /// The same in words; filled in by the report.
    pub words: String,
}

/// What to make of an interaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Dependence {
    /// What one factor does depends on the other.
    Depends,
    /// The trials show no dependence, which does not mean that there is none.
    NoDetectableDependence,
    /// So few trials cannot show one.
    CannotTell,
    /// A setting has no value of the figure.
    NotComparable,
}

/// A figure's parts in every setting, trial by trial, as many trials as all have.
pub(super) struct Parts {
    settings: Vec<Vec<Part>>,
    trials: usize,
}

impl Parts {
    pub(super) fn of(figure: usize, trials: &[Side]) -> Self {
        let all = trials.iter().map(|trials| &trials.samples[figure]);
        let count = all.clone().map(Vec::len).min().unwrap_or(0);
        let settings = all.map(|samples| samples[..count].iter().map(|sample| sample.part).collect());
        Self {
            settings: settings.collect(),
            trials: count,
        }
    }

    /// The mean over `settings` of the ratio of sums.
    fn mean(&self, settings: &[usize]) -> f64 {
        let ratios = settings
            .iter()
            .map(|&setting| ratio_of_sums(self.settings[setting].iter().copied()));
        ratios.sum::<f64>() / settings.len() as f64
    }

    /// The mean over `settings` of what each trial adds to a ratio of sums, to first order: of plain values the value itself, else the ratio
    /// plus the trial's residual over the mean denominator. Over trials its mean is the mean of the ratios.
    fn by_trial(&self, settings: &[usize]) -> Vec<f64> {
        let mut sums = vec![0.0; self.trials];
        for &setting in settings {
            let parts = &self.settings[setting];
            let ratio = ratio_of_sums(parts.iter().copied());
            let weight = parts.iter().map(|part| part[1]).sum::<f64>() / self.trials as f64;
            for (sum, [a, b]) in sums.iter_mut().zip(parts) {
                *sum += ratio + (a - ratio * b) / weight;
            }
        }
        sums.into_iter().map(|sum| sum / settings.len() as f64).collect()
    }
}

/// How means over settings are estimated: of values that each trial has, such as these parts, equal ones are certain only where a figure is
/// fixed by the scenario.
fn estimator(design: &Design, figure: usize) -> Estimator {
    match design.figures[figure].estimator {
        Estimator::Signed => Estimator::Signed,
        Estimator::Mean | Estimator::Fraction => Estimator::Mean,
        _ => Estimator::Count,
    }
}

/// Values that trials have as parts of their mean. Nothing where one of them has none.
fn as_parts(values: Vec<f64>) -> Vec<Part> {
    let known = values.iter().all(|value| value.is_finite());
    values
        .into_iter()
        .map(|value| if known { [value, 1.0] } else { [0.0; 2] })
        .collect()
}

impl LevelMean {
    /// The means of a figure over every level of every factor that has several.
    pub(super) fn all(design: &Design, figure: usize, grid: &Grid, parts: &Parts) -> Vec<Self> {
        let mut means = Vec::new();
        for (place, factor) in design
            .factors
            .iter()
            .enumerate()
            .filter(|(_, factor)| factor.levels.len() > 1)
        {
            for (level, label) in factor.levels.iter().enumerate() {
                let values = as_parts(parts.by_trial(&grid.with(&[(place, level)])));
                means.push(Self {
                    figure: design.figures[figure].key.clone(),
                    factor: factor.name.clone(),
                    level: label.clone(),
                    mean: estimator(design, figure).estimate(&values),
                });
            }
        }
        means
    }
}

impl Effect {
    /// The effect, not judged yet, and what its test found in a family of so many `tests`.
    pub(super) fn of(
        design: &Design,
        figure: usize,
        (grid, levels): (&Grid, Levels),
        parts: &Parts,
        tests: usize,
    ) -> (Self, Option<Tested>) {
        let [against, at] = [levels.against, levels.level].map(|level| grid.with(&[(levels.factor, level)]));
        let sides = [&against, &at].map(|settings| as_parts(parts.by_trial(settings)));
        let difference = difference(estimator(design, figure), [&sides[0], &sides[1]], true);
        let base = parts.mean(&against);
        let strata: Vec<[&[Part]; 2]> = against
            .iter()
            .zip(&at)
            .map(|(&against, &at)| [&parts.settings[against][..], &parts.settings[at][..]])
            .collect();
        let tested = paired_permutation(&strata, tests);
        let factor = &design.factors[levels.factor];
        let effect = Self {
            figure: design.figures[figure].key.clone(),
            factor: factor.name.clone(),
            level: factor.levels[levels.level].clone(),
            against: factor.levels[levels.against].clone(),
            relative: difference
                .value
                .map(|value| value / base.abs())
                .filter(|share| share.is_finite()),
            difference,
            p: tested.map(|tested| tested.p),
            p_adjusted: None,
            verdict: Verdict::NotComparable,
            words: String::new(),
        };
        (effect, tested)
    }
}

impl Interaction {
    /// The interaction, not judged yet, and what its test found in a family of so many `tests`. Its steps are taken from the levels of the
    /// reference, if there is one.
    pub(super) fn of(
        design: &Design,
        figure: usize,
        (grid, [first, second]): (&Grid, [usize; 2]),
        parts: &Parts,
        tests: usize,
    ) -> (Self, Option<Tested>) {
        let sizes = [first, second].map(|factor| grid.levels(factor));
        let cell = |a: usize, b: usize| grid.with(&[(first, a), (second, b)]);
        let tested = sign_permutation(&residuals(sizes, |a, b| parts.by_trial(&cell(a, b))), tests);
        let value = |a: usize, b: usize| parts.mean(&cell(a, b));
        let base = design
            .reference
            .map(|reference| [first, second].map(|factor| grid.level_of(reference, factor)));
        let steps = steps(sizes, base);
        let step = |&[[a0, a1], [b0, b1]]: &[[usize; 2]; 2]| [b1, b0].map(|b| value(a1, b) - value(a0, b));
        let size = |place: &&[[usize; 2]; 2]| {
            let [at, against] = step(place);
            (at - against).abs()
        };
        let largest = steps
            .iter()
            .max_by(|x, y| size(x).total_cmp(&size(y)).then_with(|| y.cmp(x)));
        let place = largest.copied().unwrap_or([[0, 1]; 2]);
        let names = |factor: usize, [against, level]: [usize; 2]| {
            [level, against].map(|level| design.factors[factor].levels[level].clone())
        };
        // (y₁₁ − y₀₁) − (y₁₀ − y₀₀): twice the mean over both settings with a plus less that over both with a minus.
        let [[a0, a1], [b0, b1]] = place;
        let side = |cells: [Vec<usize>; 2]| {
            let values = parts.by_trial(&cells.concat());
            as_parts(values.into_iter().map(|value| 2.0 * value).collect())
        };
        let plus = side([cell(a1, b1), cell(a0, b0)]);
        let minus = side([cell(a0, b1), cell(a1, b0)]);
        let interaction = Self {
            figure: design.figures[figure].key.clone(),
            factors: [first, second].map(|factor| design.factors[factor].name.clone()),
            first: names(first, place[0]),
            second: names(second, place[1]),
            steps: step(&place).map(|step| Some(step).filter(|step| step.is_finite())),
            difference: difference(estimator(design, figure), [&minus, &plus], true),
            p: tested.map(|tested| tested.p),
            p_adjusted: None,
            verdict: Dependence::NotComparable,
            words: String::new(),
        };
        (interaction, tested)
    }
}

/// Of each trial, what is left of its values once the means over both factors' levels are taken off: all zero where the factors add up.
/// What is left by rounding alone is nothing.
fn residuals([rows, columns]: [usize; 2], by_trial: impl Fn(usize, usize) -> Vec<f64>) -> Vec<Vec<f64>> {
    let cells: Vec<Vec<f64>> = (0..rows * columns)
        .map(|cell| by_trial(cell / columns, cell % columns))
        .collect();
    let trials = cells.first().map_or(0, Vec::len);
    let of_trial = |trial: usize| {
        let value = |row: usize, column: usize| cells[row * columns + column][trial];
        let of_row = |row: usize| (0..columns).map(|column| value(row, column)).sum::<f64>() / columns as f64;
        let of_column = |column: usize| (0..rows).map(|row| value(row, column)).sum::<f64>() / rows as f64;
        let whole = (0..rows).map(of_row).sum::<f64>() / rows as f64;
        let scale = cells.iter().map(|cell| cell[trial].abs()).fold(0.0, f64::max);
        (0..rows * columns)
            .map(|cell| {
                let (row, column) = (cell / columns, cell % columns);
                let left = value(row, column) - of_row(row) - of_column(column) + whole;
                if left.abs() <= 1e-9 * scale { 0.0 } else { left }
            })
            .collect()
    };
    (0..trials).map(of_trial).collect()
}

/// All steps of two factors, from the levels of `base` where there is one: of each factor the level held against and the level.
fn steps(sizes: [usize; 2], base: Option<[usize; 2]>) -> Vec<[[usize; 2]; 2]> {
    let of = |size: usize, base: Option<usize>| -> Vec<[usize; 2]> {
        let all = (0..size).flat_map(|from| (0..size).map(move |to| [from, to]));
        all.filter(|[from, to]| match base {
            Some(base) => from == &base && to != from,
            None => from < to,
        })
        .collect()
    };
    let first = of(sizes[0], base.map(|base| base[0]));
    let second = of(sizes[1], base.map(|base| base[1]));
    first
        .iter()
        .flat_map(|&first| second.iter().map(move |&second| [first, second]))
        .collect()
}
