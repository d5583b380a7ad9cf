//! From factors to settings.

use super::{DesignConfig, Study};
use crate::scenario::limits;

/// The combinations of a study: of each, the place of a level for every factor. Labels that no level has leave theirs out.
pub fn combinations(study: &Study) -> Vec<Vec<usize>> {
    let factors = &study.factors;
    match &study.design {
        DesignConfig::Full => factors.iter().fold(vec![Vec::new()], |settings, factor| {
            let with = |setting: &Vec<usize>, level| setting.iter().copied().chain([level]).collect();
            let levels = 0..factor.levels.len();
            settings
                .iter()
                .flat_map(|setting| levels.clone().map(move |level| with(setting, level)))
                .collect()
        }),
        DesignConfig::Paired => {
            let levels = factors.iter().map(|factor| factor.levels.len()).min().unwrap_or(0);
            (0..levels).map(|level| vec![level; factors.len()]).collect()
        }
        DesignConfig::Explicit(settings) => settings.iter().filter_map(|labels| places(study, labels)).collect(),
    }
}

/// How many combinations there are, counted before any is made.
pub fn count(study: &Study) -> usize {
    match &study.design {
        DesignConfig::Full => study
            .factors
            .iter()
            .fold(1_usize, |count, factor| count.saturating_mul(factor.levels.len())),
        DesignConfig::Paired => study
            .factors
            .iter()
            .map(|factor| factor.levels.len())
            .min()
            .unwrap_or(0),
        DesignConfig::Explicit(settings) => settings.len(),
    }
}

/// The places of levels with these labels, one for each factor.
pub fn places(study: &Study, labels: &[String]) -> Option<Vec<usize>> {
    let factors = &study.factors;
    let place = |(factor, label): (&super::FactorConfig, &String)| {
        factor.levels.iter().position(|level| level.label() == *label)
    };
    let found = factors.iter().zip(labels).map(place).collect::<Option<Vec<_>>>();
    found.filter(|_| labels.len() == factors.len())
}

/// The labels of a combination, one for each factor.
pub fn labels(study: &Study, setting: &[usize]) -> Vec<String> {
    let factors = study.factors.iter().zip(setting);
    factors.map(|(factor, &level)| factor.levels[level].label()).collect()
}

/// The name of a setting with these labels: letters and digits, with a dash for whatever else lies between them.
pub fn name(labels: &[String]) -> String {
    let slug = |label: &String| {
        let words = label.split(|letter: char| !letter.is_ascii_alphanumeric());
        words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join("-")
    };
    labels.iter().map(slug).collect::<Vec<_>>().join("_")
}

/// Whether a folder can have this name.
pub fn is_name(name: &str) -> bool {
    let fits = |letter: char| letter.is_ascii_alphanumeric() || letter == '-' || letter == '_';
    name.chars().all(fits) && name.chars().any(|letter| letter.is_ascii_alphanumeric()) && name.len() <= limits::NAME
}
