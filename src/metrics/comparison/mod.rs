//! Settings compared: what `comparison.json` holds and the report of a study shows. Everything follows from what each trial tells of
//! each figure, and depends on no machine. Keys and their order are stable.

mod contrasts;
mod effect;
mod family;
mod pair;
mod setting;
mod verdict;

pub use contrasts::{Contrasts, Grid, Levels, TooFew};
pub use effect::{Dependence, Effect, Interaction, LevelMean};
pub use family::Family;
pub use pair::{Gain, Pair, Plan, Tests};
pub use setting::{Estimated, Setting, Survival};
pub use verdict::Verdict;

use std::rc::Rc;

use serde::{Deserialize, Serialize};

use super::figures::{Figure, Pooled, Sample, Samples};

/// Below this, a p-value adjusted for the family shows a difference.
pub const SIGNIFICANT: f64 = 0.05;

/// Settings compared by their figures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// Name of the study.
    pub study: String,
    /// The question that it answers.
    pub question: Option<String>,
    /// What it found, in a sentence or a few; filled in by the report.
    pub finding: String,
    /// Whether trials of the same number share their random numbers, all settings having one seed.
    pub paired: bool,
    /// What was varied.
    pub factors: Vec<Factor>,
    /// What the figures are.
    pub figures: Vec<Figure>,
    /// The key of the figure that the study is about.
    pub primary: String,
    /// The keys of all figures that are tested, the primary one first.
    pub compared: Vec<String>,
    /// The setting that the others are held against; absent where all are held against each other.
    pub reference: Option<String>,
    /// A relative difference worth finding: trials are planned for it.
    pub relevant: f64,
    /// The settings, in the order of the study.
    pub settings: Vec<Setting>,
    /// The differences between settings, figure by figure. In a full design of several factors only those against the reference.
    pub pairs: Vec<Pair>,
    /// In a full design of several factors: the mean of each figure over every level.
    pub level_means: Vec<LevelMean>,
    /// In a full design of several factors: what levels do, averaged over the other factors.
    pub effects: Vec<Effect>,
    /// In a full design of several factors: whether what one factor does depends on another.
    pub interactions: Vec<Interaction>,
    /// The tests over which p-values are adjusted: all of pairs, effects and interactions that can show something.
    pub family: Family,
    /// Which settings no other beats in two figures at once, if the study asks.
    pub pareto: Option<Pareto>,
    /// When trials stopped being added, if they were.
    pub stopping: Option<Stopping>,
}

/// What was varied.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Factor {
    /// Its name.
    pub name: String,
    /// Labels of its levels.
    pub levels: Vec<String>,
}

/// Settings as points in the plane of two figures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pareto {
    /// Key of the figure across.
    pub x: String,
    /// Key of the figure upwards.
    pub y: String,
    /// The settings that have both.
    pub points: Vec<ParetoPoint>,
}

/// A setting in the plane of two figures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParetoPoint {
    /// Its name.
    pub setting: String,
    /// Its value of the figure across.
    pub x: f64,
    /// Its value of the figure upwards.
    pub y: f64,
    /// Whether no other setting is better in one figure and at least as good in the other, by their point estimates.
    pub on_front: bool,
}

/// How trials were added until a figure was known well enough. An interval looked at so often is a little too narrow.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stopping {
    /// Key of the figure.
    pub figure: String,
    /// The width that the interval was to have in every setting.
    pub width: f64,
    /// The widest interval at the end; absent where one had none.
    pub widest: Option<f64>,
    /// Trials of a setting at the end.
    pub trials: u32,
    /// Most trials that a setting may have.
    pub cap: u32,
    /// Whether the width was reached.
    pub reached: bool,
}

/// A setting's trials.
#[derive(Clone, Debug)]
pub struct Trials {
    /// Its name; its results lie in the folder of that name.
    pub name: String,
    /// What people call it.
    pub label: String,
    /// The label of its level of each factor.
    pub levels: Vec<String>,
    /// Its seed.
    pub seed: u64,
    /// What its trials tell of its own figures.
    pub samples: Rc<Samples>,
    /// Where each figure of the design stands among those.
    pub places: Vec<usize>,
}

/// A setting as tests see it: what its trials tell of the figures that are tested, what was cut off restricted.
#[derive(Clone, Debug)]
struct Side<'a> {
    name: &'a str,
    levels: &'a [String],
    seed: u64,
    /// By the figure's place in the design; empty where it is not tested.
    samples: Vec<Vec<Sample>>,
}

/// What is to be compared, and how.
#[derive(Clone, Debug)]
pub struct Design {
    /// Name of the study.
    pub study: String,
    /// The question that it answers.
    pub question: Option<String>,
    /// What was varied.
    pub factors: Vec<Factor>,
    /// The figures of all settings.
    pub figures: Vec<Figure>,
    /// Places of the figures that are tested, the primary one first.
    pub compared: Vec<usize>,
    /// Place of the setting that the others are held against.
    pub reference: Option<usize>,
    /// A relative difference worth finding.
    pub relevant: f64,
    /// Places of two figures.
    pub pareto: Option<[usize; 2]>,
}

impl Comparison {
    /// Compares settings, all of which have the figures of `design`.
    #[must_use]
    pub fn of(design: &Design, trials: &[Trials], stopping: Option<Stopping>) -> Self {
        let mut figures: Vec<Vec<Estimated>> = vec![Vec::new(); trials.len()];
        let mut sides: Vec<Side> = trials.iter().map(Side::of).collect();
        // One figure at a time: there may be many trials.
        for (place, figure) in design.figures.iter().enumerate() {
            let whole: Vec<Pooled> = trials.iter().map(|trials| trials.of(place)).collect();
            let restricted = restrict(&whole);
            let settings = figures.iter_mut().zip(&mut sides).zip(whole.iter().zip(&restricted));
            for ((figures, side), (whole, restricted)) in settings {
                figures.push(Estimated::of(figure, whole, restricted));
                let is_tested = design.compared.contains(&place);
                side.samples
                    .push(if is_tested { restricted.samples() } else { Vec::new() });
            }
        }
        let settings = trials.iter().zip(figures);
        let settings: Vec<Setting> = settings
            .map(|(trials, figures)| Setting::of(design, trials, figures))
            .collect();
        let key = |&figure: &usize| design.figures[figure].key.clone();
        let pareto = design.pareto.map(|axes| Pareto::of(design, axes, &settings));
        let family::Tests {
            pairs,
            means,
            effects,
            interactions,
            family,
        } = family::Tests::of(design, &sides);
        Self {
            study: design.study.clone(),
            question: design.question.clone(),
            finding: String::new(),
            paired: trials.windows(2).all(|pair| pair[0].seed == pair[1].seed),
            factors: design.factors.clone(),
            figures: design.figures.clone(),
            primary: design.compared.first().map(key).unwrap_or_default(),
            compared: design.compared.iter().map(key).collect(),
            reference: design.reference.map(|reference| trials[reference].name.clone()),
            relevant: design.relevant,
            pairs,
            level_means: means,
            effects,
            interactions,
            family,
            settings,
            pareto,
            stopping,
        }
    }

    /// A figure by its key.
    #[must_use]
    pub fn figure(&self, key: &str) -> Option<&Figure> {
        self.figures.iter().find(|figure| figure.key == key)
    }

    /// A setting by its name.
    #[must_use]
    pub fn setting(&self, name: &str) -> Option<&Setting> {
        self.settings.iter().find(|setting| setting.name == name)
    }

    /// What levels do to a figure.
    pub fn effects_in<'a>(&'a self, key: &'a str) -> impl Iterator<Item = &'a Effect> {
        self.effects.iter().filter(move |effect| effect.figure == key)
    }

    /// Whether what one factor does to a figure depends on another.
    pub fn interactions_in<'a>(&'a self, key: &'a str) -> impl Iterator<Item = &'a Interaction> {
        self.interactions
            .iter()
            .filter(move |interaction| interaction.figure == key)
    }

    /// The differences in a figure.
    pub fn pairs_in<'a>(&'a self, key: &'a str) -> impl Iterator<Item = &'a Pair> {
        self.pairs.iter().filter(move |pair| pair.figure == key)
    }
}

impl Trials {
    /// What its trials tell of figure number `place` of the design.
    #[must_use]
    pub fn of(&self, place: usize) -> Pooled {
        self.samples.of(self.places[place])
    }
}

impl<'a> Side<'a> {
    /// Of no figure yet.
    fn of(trials: &'a Trials) -> Self {
        Self {
            name: &trials.name,
            levels: &trials.levels,
            seed: trials.seed,
            samples: Vec::new(),
        }
    }
}

/// Restricts what was cut off, in any setting, to the shortest time that a trial was watched in vain: up to there every trial has a
/// value, so that its mean, the restricted mean, leaves nothing out and flatters nobody (Irwin, 1949; Royston and Parmar, 2013).
fn restrict(settings: &[Pooled]) -> Vec<Pooled> {
    let limit = settings.iter().map(Pooled::least_cut_off).fold(f64::INFINITY, f64::min);
    let mut restricted = settings.to_vec();
    for setting in &mut restricted {
        setting.restrict(limit);
    }
    restricted
}

/// The widest interval of figure number `place` of the design over the settings, for what would be compared so far; `None` where one has none.
#[must_use]
pub fn widest(figure: &Figure, trials: &[Trials], place: usize) -> Option<f64> {
    let whole: Vec<Pooled> = trials.iter().map(|trials| trials.of(place)).collect();
    let mut widths = restrict(&whole).into_iter().map(|setting| {
        let [low, high] = setting.estimate(figure).ci95;
        Some(high? - low?)
    });
    widths.try_fold(0.0, |widest: f64, width| Some(widest.max(width?)))
}

impl Pareto {
    fn of(design: &Design, axes: [usize; 2], settings: &[Setting]) -> Self {
        let [x, y] = axes.map(|axis| &design.figures[axis]);
        let value = |setting: &Setting, figure: &Figure| setting.figure(&figure.key)?.estimate.value;
        let places: Vec<_> = settings
            .iter()
            .filter_map(|setting| Some((setting, [value(setting, x)?, value(setting, y)?])))
            .collect();
        let beaten = |place: &[f64; 2]| {
            places.iter().any(|(_, other)| {
                let better = [x, y].map(|figure| figure.better);
                let ahead = [0, 1].map(|axis| pair::gain_of(better[axis], apart(other[axis], place[axis])));
                ahead.iter().all(|ahead| *ahead >= 0.0) && ahead.iter().any(|ahead| *ahead > 0.0)
            })
        };
        Self {
            x: x.key.clone(),
            y: y.key.clone(),
            points: places
                .iter()
                .map(|(setting, place)| ParetoPoint {
                    setting: setting.name.clone(),
                    x: place[0],
                    y: place[1],
                    on_front: !beaten(place),
                })
                .collect(),
        }
    }
}

/// How much `value` is above `other`; nothing where they differ by rounding alone.
#[must_use]
pub fn apart(value: f64, other: f64) -> f64 {
    let difference = value - other;
    if difference.abs() <= 1e-12 * value.abs().max(other.abs()) {
        0.0
    } else {
        difference
    }
}

#[cfg(test)]
mod effect_tests;
#[cfg(test)]
mod tests;
