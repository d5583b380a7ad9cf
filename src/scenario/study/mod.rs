//! Study files: a base scenario, and what is varied in it. A study is a question about settings, as a scenario is one about a setting.
//!
//! A file is RON: comments, of which the first is the question, then `Study( ... )`. [`load_study`] answers a [`Plan`]: every
//! setting as a scenario that holds, or all that is wrong with the study, its base and its combinations.

mod design;
mod figures;
mod plan;
mod power;
mod problems;
mod text;

pub use plan::{Plan, Setting, load_study, plan_of_files};
pub use problems::problems;
pub use text::RonText;

use schemars::{JsonSchema, Schema, generate::SchemaSettings};
use serde::{Deserialize, Serialize};

use super::{limits, tree};
use crate::quantity::Positive;

/// A study: settings of one scenario, compared.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// Name of the study; the default results folder is `results/<name>`. Letters, digits, `-` and `_`.
    #[schemars(regex(pattern = r"^[A-Za-z0-9_-]{1,64}$"))]
    pub name: String,
    /// Path of the base scenario, relative to the study file.
    pub base: String,
    /// Number of trials of each setting, instead of the base's. Trials of the same number share their random numbers.
    #[schemars(range(min = 1, max = limits::TRIALS))]
    #[serde(default = "trials")]
    pub trials: u32,
    /// Seed of every random stream in every setting, instead of the base's.
    #[serde(default = "seed")]
    pub seed: u64,
    /// What is varied.
    pub factors: Vec<FactorConfig>,
    /// How levels of factors are combined.
    #[serde(default)]
    pub design: DesignConfig,
    /// Key of the figure that the study is about, such as `steps_to_completion`.
    pub figure: String,
    /// Keys of further figures to compare.
    #[serde(default)]
    pub also: Vec<String>,
    /// The setting that the others are held against: a label for each factor. None by default: all are held against each other, in a full
    /// design of several factors the levels of each over all of the others.
    #[serde(default)]
    pub reference: Vec<String>,
    /// A relative difference worth finding, such as 0.05: where no difference is found, the report says how many trials would show one
    /// of this size.
    #[serde(default = "relevant")]
    pub relevant: Positive,
    /// Keys of two figures, across and upwards, in whose plane settings are drawn: which of them does no other beat in both?
    #[serde(default)]
    pub pareto: Option<(String, String)>,
}

fn trials() -> u32 {
    35
}

fn seed() -> u64 {
    1
}

fn relevant() -> Positive {
    Positive::new(0.05)
}

/// Something that is varied: one field of the scenario, or several together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FactorConfig {
    /// What people call it.
    pub name: String,
    /// Paths of the scenario's fields that it sets, such as `radio.loss`.
    pub paths: Vec<String>,
    /// Its levels.
    pub levels: Vec<LevelConfig>,
}

/// A level of a factor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LevelConfig {
    /// What people call it; by default its values as they are written.
    #[serde(default)]
    pub label: Option<String>,
    /// A value for each path of the factor, as it would stand in the scenario.
    pub values: Vec<RonText>,
}

impl LevelConfig {
    /// What people call it.
    #[must_use]
    pub fn label(&self) -> String {
        let written = || {
            self.values
                .iter()
                .map(|value| value.0.as_str())
                .collect::<Vec<_>>()
                .join(", ")
        };
        self.label.clone().unwrap_or_else(written)
    }
}

/// How levels of factors are combined to settings.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub enum DesignConfig {
    /// Every level of each factor with every one of the others.
    #[default]
    Full,
    /// The first levels of all factors together, the second ones together, and so on.
    Paired,
    /// These combinations: of each, a label for every factor.
    Explicit(Vec<Vec<String>>),
}

/// Whether `text` holds a study, and not a scenario.
#[must_use]
pub fn is_study(text: &str) -> bool {
    let name = tree::read(text).0.and_then(|root| root.name);
    name.is_some_and(|name| &text[name] == "Study")
}

/// The JSON Schema of study files.
#[must_use]
pub fn study_schema() -> Schema {
    SchemaSettings::draft2020_12()
        .into_generator()
        .into_root_schema_for::<Study>()
}
