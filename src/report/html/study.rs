//! A study as one page.

use maud::{Markup, html};

use super::figure::Figure;
use super::page::{Section, document, numbered};
use super::settings::{by_setting, capital, differences};
use super::watch::SettingTrials;
use super::{factors, mission, pareto, watch};
use crate::metrics::comparison::{Comparison, Setting};
use crate::metrics::figures;
use crate::report::comparison::{compared, fitted, stopping};
use crate::report::number::NOTHING;

/// The page of a study, [described](crate::report::describe) and run by the version `made_by`, and which of its `trials` to watch.
#[must_use]
pub fn study_page(comparison: &Comparison, made_by: &str, trials: &[SettingTrials]) -> String {
    let sections = sections(comparison);
    let watched = watch::of_settings(comparison, trials);
    let title = format!("{}: settings compared", comparison.study);
    let body = html! {
        header {
            p class="kind" { "Settings compared" }
            h1 { (comparison.study) }
            @if let Some(question) = &comparison.question { p class="question" { (question) } }
            p class="ran" {
                (compared(comparison)) "."
                @if let Some(stopped) = &comparison.stopping { " " (stopping(stopped, comparison)) }
            }
            nav {
                @for section in &sections { a href={ "#" (section.id) } { (section.title) } }
                @if watched.is_some() { a href="#watch" { "Trials to watch" } }
            }
        }
        main {
            section id="found" {
                h2 { "What was found" }
                p { (comparison.finding) }
                (overview(comparison))
                p class="note" { "Figures in brackets are 95 % intervals over trials." }
                (in_words(comparison))
            }
            (numbered(&comparison.study, &sections))
            @if let Some(watched) = &watched { (watched) }
        }
        footer { (made_by) ". This page needs no network: charts, data and script are in it." }
    };
    document(&title, &body)
}

fn measured(comparison: &Comparison) -> impl Iterator<Item = &figures::Figure> {
    comparison.compared.iter().filter_map(|key| comparison.figure(key))
}

fn sections(comparison: &Comparison) -> Vec<Section> {
    let of_figure = |figure: &figures::Figure| Section {
        id: figure.key.clone().into(),
        title: capital(&figure.name).into(),
        figures: by_setting(comparison, figure)
            .into_iter()
            .chain(factors::effects(comparison, figure))
            .chain(factors::interactions(comparison, figure))
            .chain(differences(comparison, figure))
            .collect(),
    };
    let whole = |id: &'static str, title: &'static str, figure: Option<Figure>| Section {
        id: id.into(),
        title: title.into(),
        figures: figure.into_iter().collect(),
    };
    let mut sections: Vec<Section> = measured(comparison).map(of_figure).collect();
    sections.push(whole("times", "Time to completion", mission::by_setting(comparison)));
    sections.push(whole("front", "Pareto front", pareto::plane(comparison)));
    sections.retain(|section| !section.figures.is_empty());
    sections
}

/// Settings and what is compared of them.
fn overview(comparison: &Comparison) -> Markup {
    let value = |setting: &Setting, figure: &figures::Figure| {
        setting
            .figure(&figure.key)
            .map_or(NOTHING.to_owned(), |figure| fitted(&figure.estimate))
    };
    html! {
        div class="scroll whole" {
            table {
                thead {
                    tr {
                        th scope="col" { (comparison.factors.iter().map(|factor| factor.name.as_str()).collect::<Vec<_>>().join(", ")) }
                        @for figure in measured(comparison) {
                            th scope="col" { (figure.name) @if figure.unit.as_ref() != "1" { ", " (figure.unit) } }
                        }
                    }
                }
                tbody {
                    @for setting in &comparison.settings {
                        tr {
                            th scope="row" {
                                (setting.label)
                                @if comparison.reference.as_ref() == Some(&setting.name) { " (reference)" }
                            }
                            @for figure in measured(comparison) { td { (value(setting, figure)) } }
                        }
                    }
                }
            }
        }
    }
}

/// Every difference in a sentence.
fn in_words(comparison: &Comparison) -> Markup {
    let effects = comparison.effects.iter().map(|effect| effect.words.as_str());
    let interactions = comparison
        .interactions
        .iter()
        .map(|interaction| interaction.words.as_str());
    let pairs = comparison.pairs.iter().map(|pair| pair.words.as_str());
    let words = effects.chain(interactions).chain(pairs);
    html! {
        details {
            summary { "Every difference in words" }
            ul { @for words in words.filter(|words| !words.is_empty()) { li { (words) } } }
        }
    }
}
