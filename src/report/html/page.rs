//! The page around the figures.

use std::borrow::Cow;

use maud::{DOCTYPE, Markup, PreEscaped, html};
use plotly::Plot;

use super::figure::Figure;
use super::{
    PageInput, air, bandwidth, connectivity, detection, gossip, map, mission, overview, radio, robots, series, watch,
};
use crate::report::number::{count, seconds};
use crate::scenario::to_ron;
use crate::text::{clean, clean_lines};

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// Nothing may be fetched: what a page needs is in it.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:";

/// By what a page of desim is known, near its beginning.
pub const PAGE_MARK: &str = "<meta name=\"generator\" content=\"desim\">";

/// A part of a page.
pub(super) struct Section {
    /// Its name in links.
    pub id: Cow<'static, str>,
    /// What it is about.
    pub title: Cow<'static, str>,
    /// Its figures.
    pub figures: Vec<Figure>,
}

/// The page, whole.
#[must_use]
pub fn page(input: &PageInput) -> String {
    let sections = sections(input);
    let title = format!("{}: bandwidth and detection report", input.scenario.name);
    let watched = watch::of_trials(input);
    let replay = input.watch.as_ref().and_then(|watch| watch.replays.get(&0));
    let body = html! {
        header {
            p class="kind" { "Bandwidth and detection report" }
            h1 { (input.scenario.name) }
            @if let Some(question) = input.question { p class="question" { (question) } }
            p class="ran" { (ran(input)) }
            @if let Some([drawn, all]) = input.drawn() {
                p class="ran" {
                    "Figures in numbers are of all " (all) " trials, and so are charts that do not say otherwise. Charts for which a trial's whole record is needed are "
                    "drawn from " (drawn) " trials, spread evenly over all, and say so."
                }
            }
            nav {
                @for section in &sections { a href={ "#" (section.id) } { (section.title) } }
                @if watched.is_some() { a href="#watch" { "Trials to watch" } }
                @if let Some(replay) = replay { a href=(replay) { "Watch trial 0" } }
            }
        }
        main {
            section id="found" {
                h2 { "What was found" }
                div class="scroll whole" {
                    table class="overview" {
                        tbody { @for (name, value) in overview::rows(input) { tr { th scope="row" { (name) } td { (value) } } } }
                    }
                }
                p class="note" { "Figures in brackets are 95 % intervals over trials." }
            }
            (numbered(&input.scenario.name, &sections))
            @if let Some(watched) = &watched { (watched) }
            (scenario(input))
        }
        footer {
            "Digest " code { (input.summary.digest) } ". " (input.made_by) ". This page needs no network: charts, data and script are in it."
        }
    };
    document(&title, &body)
}

/// The document around a page's body: style, the script of the charts, our own. What others wrote into the body is words already;
/// here it loses what nobody could see.
pub(super) fn document(title: &str, body: &Markup) -> String {
    let body = PreEscaped(clean_lines(&body.0).into_owned());
    let document = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                (PreEscaped(PAGE_MARK))
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                title { (clean(title)) }
                link rel="icon" href="data:,";
                style { (PreEscaped(STYLE)) }
                (PreEscaped(chart_script()))
            }
            body {
                (body)
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    document.into_string()
}

/// The script that draws, without the one for formulas that the crate adds after it: no label here has a formula, and it
/// is 2 MB.
fn chart_script() -> String {
    let all = Plot::offline_js_sources();
    let end = "</script>";
    all.find(end).map(|at| all[..at + end.len()].to_owned()).unwrap_or(all)
}

fn sections(input: &PageInput) -> Vec<Section> {
    // Those that are drawn from whole records.
    let drawn = |figure: Option<Figure>| match (figure, input.drawn()) {
        (Some(figure), Some([drawn, all])) => Some(Figure {
            caption: format!(
                "{} Drawn from {drawn} of the {all} trials, spread evenly.",
                figure.caption
            ),
            ..figure
        }),
        (figure, _) => figure,
    };
    let all: [(&str, &str, Vec<Option<Figure>>); 7] = [
        (
            "mission",
            "Mission",
            vec![mission::completion(input), drawn(gossip::spread(input))],
        ),
        (
            "bandwidth",
            "Bandwidth",
            vec![
                drawn(Some(bandwidth::by_topic(input))),
                drawn(bandwidth::by_role(input)),
                drawn(Some(robots::distribution(input))),
                drawn(robots::by_number(input)),
                drawn(Some(robots::lorenz(input))),
                drawn(series::by_topic(input)),
                drawn(series::over_robots(input)),
                drawn(Some(bandwidth::headers(input))),
            ],
        ),
        (
            "radio",
            "Radio",
            vec![
                Some(radio::lost(input)),
                radio::latency(input),
                gossip::duplicates(input),
            ],
        ),
        ("air", "Air", vec![drawn(air::by_distance(input)), air::causes(input)]),
        (
            "graph",
            "Connectivity",
            vec![drawn(connectivity::graph(input)), drawn(connectivity::roles(input))],
        ),
        (
            "failures",
            "Failures and their detection",
            vec![
                drawn(detection::suspicions(input)),
                detection::times(input),
                mission::healing(input),
            ],
        ),
        ("place", "Map", vec![map::traffic(input)]),
    ];
    let sections = all.into_iter().map(|(id, title, figures)| Section {
        id: id.into(),
        title: title.into(),
        figures: figures.into_iter().flatten().collect(),
    });
    sections.filter(|section| !section.figures.is_empty()).collect()
}

/// Sections with their figures numbered throughout, whose data files are named after `name`.
pub(super) fn numbered(name: &str, sections: &[Section]) -> Markup {
    let mut number = 0;
    html! {
        @for section in sections {
            section id=(section.id) {
                h2 { (section.title) }
                @for figure in &section.figures {
                    ({ number += 1; figure.markup(number, name) })
                }
            }
        }
    }
}

/// What was run.
fn ran(input: &PageInput) -> String {
    let seeds: Vec<String> = input.trials.seeds().iter().map(u64::to_string).collect();
    let trials = input.trials.count() as u64;
    format!(
        "{} trial{} with seed{} {}, {} robots, {} simulated, {} control steps of {} s.",
        count(trials),
        if trials == 1 { "" } else { "s" },
        if seeds.len() == 1 { "" } else { "s" },
        seeds.join(", "),
        count(input.scenario.swarm.robots.into()),
        seconds(input.summary.simulated_s.value),
        count(input.summary.steps.value),
        input.scenario.control.period.get()
    )
}

fn scenario(input: &PageInput) -> Markup {
    html! {
        section id="scenario" {
            h2 { "The scenario" }
            p { "Everything that the trials were given, defaults and overrides worked in." }
            details class="long" { summary { "The scenario in full" } div class="scroll" tabindex="0" { pre { (to_ron(input.scenario)) } } }
        }
    }
}
