//! What no field of a study shows on its own.

use super::design::{combinations, count, is_name, labels, name, places};
use super::{DesignConfig, FactorConfig, Study};
use crate::kind::Problem;
use crate::scenario::limits;
use crate::scenario::path::FieldPath;

/// Fields that the study itself decides.
const OF_THE_STUDY: [&str; 3] = ["name", "trials", "seed"];

/// Everything wrong with `study` that shows without its base.
pub fn problems(study: &Study) -> Vec<Problem> {
    let mut found = Vec::new();
    if !is_name(&study.name) {
        let help = format!(
            "use 1 to {} letters a-z, A-Z, digits, `-` and `_`: it names the results folder",
            limits::NAME
        );
        found.push(Problem::new(
            "name",
            format!("the name {:?} names no folder", study.name),
            help,
        ));
    }
    if !(1..=limits::TRIALS).contains(&study.trials) {
        let help = format!("expected a whole number from 1 to {}", limits::TRIALS);
        found.push(Problem::new(
            "trials",
            format!("{} is out of range for `trials`", study.trials),
            help,
        ));
    }
    if study.factors.is_empty() {
        found.push(Problem::new(
            "factors",
            "nothing is varied",
            "give at least one factor with two levels",
        ));
    }
    for (place, factor) in study.factors.iter().enumerate() {
        let twice = study.factors[..place].iter().any(|other| other.name == factor.name);
        if twice || factor.name.trim().is_empty() {
            let message = format!("another factor is called {:?}, or the name is empty", factor.name);
            found.push(Problem::new(
                &format!("factors[{place}].name"),
                message,
                "give it a name of its own",
            ));
        }
        found.extend(factor_problems(place, factor));
    }
    found.extend(path_problems(study));
    if found.is_empty() {
        found.extend(design_problems(study));
    }
    if found.is_empty() {
        found.extend(setting_problems(study));
    }
    found
}

fn factor_problems(place: usize, factor: &FactorConfig) -> Vec<Problem> {
    let at = |field: &str| format!("factors[{place}].{field}");
    let mut found = Vec::new();
    if factor.paths.is_empty() {
        found.push(Problem::new(
            &at("paths"),
            "the factor sets no field",
            "name one, such as \"radio.loss\"",
        ));
    }
    if factor.levels.is_empty() {
        let help = "give it two or more, such as (values: [0.1])";
        found.push(Problem::new(&at("levels"), "the factor has no level", help));
    }
    for (index, level) in factor.levels.iter().enumerate() {
        if level.values.len() != factor.paths.len() {
            let (values, paths) = (level.values.len(), factor.paths.len());
            let message = format!("the level has {values} values for {paths} paths");
            let help = "give a value for each path of the factor, in their order";
            found.push(Problem::new(&at(&format!("levels[{index}].values")), message, help));
        }
        if factor.levels[..index]
            .iter()
            .any(|other| other.label() == level.label())
        {
            let message = format!("another level of the factor is called {:?}", level.label());
            let help = "give each level a label of its own";
            found.push(Problem::new(&at(&format!("levels[{index}]")), message, help));
        }
    }
    found
}

/// Paths that are none, that are the study's own, or that two factors set.
fn path_problems(study: &Study) -> Vec<Problem> {
    let mut found = Vec::new();
    let mut known: Vec<FieldPath> = Vec::new();
    for (factor, config) in study.factors.iter().enumerate() {
        for (index, text) in config.paths.iter().enumerate() {
            let at = format!("factors[{factor}].paths[{index}]");
            let Some(path) = FieldPath::parse(text) else {
                let help = "write names with dots between, such as radio.range";
                found.push(Problem::new(&at, format!("{text:?} is no path of a field"), help));
                continue;
            };
            if OF_THE_STUDY.contains(&path.to_string().as_str()) {
                let help =
                    "leave it out: settings differ in nothing but their levels, and share their seed and their trials";
                found.push(Problem::new(&at, format!("`{path}` is the study's own"), help));
            }
            if known.iter().any(|other| other.holds(&path) || path.holds(other)) {
                let message = format!("`{path}` is set twice");
                found.push(Problem::new(&at, message, "let one factor set it, once"));
            }
            known.push(path);
        }
    }
    found
}

fn design_problems(study: &Study) -> Vec<Problem> {
    let mut found = Vec::new();
    if let DesignConfig::Explicit(settings) = &study.design {
        for (index, setting) in settings.iter().enumerate() {
            found.extend(label_problem(study, &format!("design.Explicit[{index}]"), setting));
        }
    }
    let levels = || study.factors.iter().map(|factor| factor.levels.len());
    if study.design == DesignConfig::Paired && levels().min() != levels().max() {
        let message = "factors have different numbers of levels, which cannot be paired";
        found.push(Problem::new(
            "design",
            message,
            "give all factors as many levels, or use Full or Explicit",
        ));
    }
    let settings = count(study);
    if !(2..=limits::SETTINGS).contains(&settings) {
        let help = format!("a study compares 2 to {} settings", limits::SETTINGS);
        found.push(Problem::new(
            "factors",
            format!("the design has {settings} settings"),
            help,
        ));
    }
    if !study.reference.is_empty() {
        found.extend(label_problem(study, "reference", &study.reference));
    }
    found
}

/// Whether `setting` has a label of a level for each factor.
fn label_problem(study: &Study, path: &str, setting: &[String]) -> Option<Problem> {
    if places(study, setting).is_some() {
        return None;
    }
    let all = study.factors.iter().map(|factor| {
        let labels: Vec<_> = factor
            .levels
            .iter()
            .map(|level| format!("{:?}", level.label()))
            .collect();
        format!("{}: {}", factor.name, labels.join(", "))
    });
    let help = format!("give one label for each factor. {}", all.collect::<Vec<_>>().join("; "));
    Some(Problem::new(path, format!("{setting:?} is no combination of levels"), help).with(&["factors"]))
}

fn setting_problems(study: &Study) -> Vec<Problem> {
    let mut found = Vec::new();
    let combinations = combinations(study);
    let mut names: Vec<(String, Vec<String>)> = Vec::new();
    for setting in &combinations {
        let labels = labels(study, setting);
        let folder = name(&labels);
        let help = "give the levels other labels, of letters and digits";
        // A part without a letter would say nothing of its level.
        if !is_name(&folder) || folder.split('_').any(str::is_empty) {
            let message = format!("setting {labels:?} has no folder: {folder:?} is none, or too long");
            found.push(Problem::new("factors", message, help));
        } else if let Some((_, other)) = names.iter().find(|(name, _)| *name == folder) {
            let message = format!("settings {other:?} and {labels:?} would share the folder {folder:?}");
            found.push(Problem::new("factors", message, help));
        }
        names.push((folder, labels));
    }
    if let Some(reference) = places(study, &study.reference).filter(|_| !study.reference.is_empty())
        && !combinations.contains(&reference)
    {
        let message = format!(
            "the reference {:?} is not among the settings of the design",
            study.reference
        );
        found.push(Problem::new("reference", message, "choose one that the design has"));
    }
    found
}
