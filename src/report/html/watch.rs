//! Which trials to watch: the one in the middle and the worst, and how.

use std::collections::BTreeMap;

use maud::{Markup, html};

use super::PageInput;
use super::settings::with_unit;
use crate::metrics::comparison::Comparison;
use crate::metrics::figures::{COMPLETION, Exemplars, Figure, Told};
use crate::report::comparison::label;
use crate::report::number;
use crate::statistics::Estimator;

/// Where single trials of results can be watched.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Watch {
    /// The folder of the results, as a command names it.
    pub folder: String,
    /// Pages that show a trial, by its number: their paths from the folder of the page of charts on.
    pub replays: BTreeMap<u32, String>,
}

/// The trials of a setting of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct SettingTrials {
    /// The setting's name.
    pub setting: String,
    /// What those that have a value tell of the figure that the study is about.
    pub told: Vec<Told>,
    /// Where they can be watched.
    pub watch: Watch,
}

/// What one row of the table is about.
struct Row<'a> {
    name: &'a str,
    exemplars: Exemplars,
    watch: &'a Watch,
}

/// Which trials of each setting to watch; nothing where nothing is known of trials.
pub fn of_settings(comparison: &Comparison, settings: &[SettingTrials]) -> Option<Markup> {
    let figure = comparison.figure(&comparison.primary)?;
    let rows: Vec<Row> = settings
        .iter()
        .filter_map(|trials| {
            Some(Row {
                name: label(comparison, &trials.setting),
                exemplars: exemplars(figure, &trials.told)?,
                watch: &trials.watch,
            })
        })
        .collect();
    rows.first()?;
    Some(section(
        figure,
        Some(
            &comparison
                .factors
                .iter()
                .map(|factor| factor.name.as_str())
                .collect::<Vec<_>>()
                .join(", "),
        ),
        &rows,
    ))
}

/// Which trials of a scenario to watch; nothing if there is one, or nobody knows where they are.
pub fn of_trials(input: &PageInput) -> Option<Markup> {
    let watch = input.watch.as_ref()?;
    if input.trials.count() < 2 {
        return None;
    }
    // What the mission is about, else what the protocol's own robots note, else the first that differs.
    let rank = |figure: &Figure| match figure.key.as_str() {
        COMPLETION => 0,
        key if key.starts_with("noted.") => 1,
        _ => 2,
    };
    let mut figures: Vec<_> = input.trials.figures().collect();
    figures.sort_by_key(|(figure, _)| rank(figure));
    let mut chosen = figures.into_iter().filter_map(|(figure, pooled)| {
        let told: Vec<Told> = pooled().told(input.trials.numbers()).collect();
        Some((figure, exemplars(figure, &told)?))
    });
    let (figure, exemplars) = chosen.find(|(_, exemplars)| exemplars.differ)?;
    let row = Row {
        name: "",
        exemplars,
        watch,
    };
    Some(section(figure, None, &[row]))
}

/// The trials that stand for the others. What a trial adds to a mean of times is no time that was cut off, even where some of its own were.
fn exemplars(figure: &Figure, told: &[Told]) -> Option<Exemplars> {
    let of_times = figure.estimator == Estimator::Times;
    let whole = |one: &Told| Told {
        is_censored: one.is_censored && !of_times,
        ..*one
    };
    let told: Vec<Told> = told.iter().map(whole).collect();
    Exemplars::of(figure.better, &told)
}

fn section(figure: &Figure, of: Option<&str>, rows: &[Row]) -> Markup {
    html! {
        section id="watch" {
            h2 { "Trials to watch" }
            p {
                "By " (with_unit(figure)) ", the trial in the middle" @if of.is_some() { " of each setting" } " and the worst; of trials that read the same, the first. "
                "A command makes the page on which a trial can be watched."
            }
            div class="scroll whole" {
                table class="watch" {
                    thead {
                        tr {
                            @if let Some(of) = of { th scope="col" { (of) } }
                            th scope="col" { "which" }
                            th scope="col" { "trial" }
                            th scope="col" { (figure.name) }
                            th scope="col" { "to watch it" }
                        }
                    }
                    tbody {
                        @for row in rows {
                            @for (which, told) in which(&row.exemplars) {
                                tr {
                                    @if of.is_some() { th scope="row" { (row.name) } }
                                    td class="text" { (which) }
                                    td { (told.trial) }
                                    td { (if told.is_censored { "more than " } else { "" }) (number::figure(told.value)) }
                                    td class="text" { (how(row.watch, told.trial)) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// The trials that a row names: one, where all read the same.
fn which(exemplars: &Exemplars) -> Vec<(String, Told)> {
    if !exemplars.differ {
        let words = match exemplars.trials {
            1 => "the only one".to_owned(),
            trials => format!("all {} alike", number::count(trials as u64)),
        };
        return vec![(words, exemplars.median)];
    }
    vec![
        ("median".to_owned(), exemplars.median),
        ("worst".to_owned(), exemplars.worst),
    ]
}

/// The link to the page that shows a trial, if there is one, and the command that makes it.
fn how(watch: &Watch, trial: u32) -> Markup {
    html! {
        @if let Some(page) = watch.replays.get(&trial) { a href=(page) { "watch trial " (trial) } " " }
        code { "desim replay " (as_word(&watch.folder)) " --trial " (trial) }
    }
}

/// A path as a shell takes it for one word.
fn as_word(path: &str) -> String {
    let is_plain = |letter: char| letter.is_alphanumeric() || "_-./+,:@%".contains(letter);
    if !path.is_empty() && path.chars().all(is_plain) && !path.starts_with('-') {
        path.to_owned()
    } else {
        format!("'{}'", path.replace('\'', "'\\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_that_was_cut_off_is_a_least_one_and_what_a_trial_adds_to_a_mean_is_not() {
        let told = [3.0, 5.0, 5.0].map(|value| Told {
            trial: value as u32,
            value,
            is_censored: value > 4.0,
        });
        let figure = |estimator| Figure {
            key: "time".into(),
            name: "time".into(),
            unit: "s".into(),
            better: crate::metrics::figures::Better::Lower,
            is_ratio: estimator == Estimator::Times,
            estimator,
        };
        let page = |estimator| {
            let figure = figure(estimator);
            let row = Row {
                name: "",
                exemplars: exemplars(&figure, &told).expect("there are trials"),
                watch: &Watch::default(),
            };
            section(&figure, None, &[row]).into_string()
        };
        assert_eq!(page(Estimator::Count).matches("more than 5.00").count(), 2);
        assert_eq!(page(Estimator::Times).matches("more than").count(), 0);
    }

    #[test]
    fn a_path_is_one_word_of_a_command_whatever_is_in_it() {
        assert_eq!(as_word("results/a_b-1.5"), "results/a_b-1.5");
        assert_eq!(as_word("my results/it's"), "'my results/it'\\''s'");
        assert_eq!(as_word("a;rm"), "'a;rm'");
    }
}
