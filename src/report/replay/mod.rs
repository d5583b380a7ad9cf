//! A trial to be watched: one page that needs nothing but itself, on which robots move, say what they say and fail.
//!
//! [`Film`] gathers what is seen while the trial runs once more; [`replay`] makes the page of it. Numbers are binary, deflated and in base64;
//! the page's own script (`page/`) draws them.

mod airtime;
mod changes;
mod events;
mod film;
mod links;
mod sections;

pub use film::Film;

use serde_json::{Value, json};

use self::links::Toggles;
use self::sections::Sections;
use super::html::PAGE_MARK;
use super::html::chart::{cause_colour, role_colour, topic_colour};
use crate::metrics::{Outcome, TrialRecord};
use crate::motion::ObstacleConfig;
use crate::radio::{LossCause, Reach};
use crate::report::number;
use crate::scenario::Scenario;

/// So many changes of whom robots rely on a page has room for.
const MOST_CHANGES: usize = 200_000;
/// The page, and what is put into it.
const PAGE: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/page.css");
const SCRIPTS: [&str; 9] = [
    include_str!("page/1-data.js"),
    include_str!("page/2-state.js"),
    include_str!("page/3-messages.js"),
    include_str!("page/4-view.js"),
    include_str!("page/5-draw.js"),
    include_str!("page/6-side.js"),
    include_str!("page/7-events.js"),
    include_str!("page/8-charts.js"),
    include_str!("page/9-main.js"),
];

/// What a replay is made of.
#[derive(Debug)]
pub struct ReplayInput<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// The question that it asks.
    pub question: Option<&'a str>,
    /// What the trial left.
    pub record: &'a TrialRecord,
    /// Who was in range of whom.
    pub reach: &'a Reach,
    /// What the command calls the folder of the results.
    pub folder: &'a str,
}

/// The page of a trial.
#[must_use]
pub fn replay(input: &ReplayInput, mut film: Film) -> String {
    let record = input.record;
    film.close(record.simulated, record.robots.iter().map(|robot| robot.pose.position));
    let toggles = range(input.reach).is_none().then(|| Toggles::of(&film, input.reach));
    let (sections, data) = Sections::of(&film, toggles.as_ref()).deflated();
    let mut meta = meta(input, &film, toggles.as_ref());
    meta["sections"] = sections;
    let title = format!("{}, trial {}", input.scenario.name, record.trial);
    PAGE.replacen("<head>", &format!("<head>\n{PAGE_MARK}"), 1)
        .replacen("{{style}}", STYLE, 1)
        .replacen("{{script}}", &SCRIPTS.join("\n"), 1)
        .replacen("{{data}}", &data, 1)
        // What others wrote comes last, from the end on: nothing is put into it.
        .replacen("{{meta}}", &meta.to_string().replace('<', "\\u003c"), 1)
        .replacen("{{title}}", &escaped(&title), 1)
}

/// Within which distance robots are in range of each other, where that follows from distances alone.
fn range(reach: &Reach) -> Option<f64> {
    match reach {
        Reach::Disk(range) => Some(*range),
        Reach::Links(_) => None,
    }
}

fn meta(input: &ReplayInput, film: &Film, toggles: Option<&Toggles>) -> Value {
    let (scenario, record) = (input.scenario, input.record);
    let vocabulary = &film.vocabulary;
    let causes = LossCause::ALL;
    let told = events::Told {
        record,
        folder: input.folder,
        roles: vocabulary.roles,
        topics: vocabulary.topics,
        layout: &scenario.layout(),
    };
    let (events, left_out) = told.events(&film.changes.roles);
    let targets = scenario.protocol.targets().into_iter();
    let targets = targets.flat_map(|targets| targets.places);
    let targets: Vec<[f64; 2]> = targets.map(|(place, _)| [place.x, place.y]).collect();
    json!({
        "name": scenario.name,
        "question": input.question,
        "trial": record.trial,
        "seed": record.seed,
        "digest": format!("{:032x}", record.digest),
        "desim": env!("CARGO_PKG_VERSION"),
        "duration_s": record.simulated.as_secs(),
        "control_period_s": record.control_period.as_secs(),
        "outcome": outcome(record),
        "arena": [scenario.arena.size.0.get(), scenario.arena.size.1.get()],
        "body_radius_m": scenario.motion.body_radius.get(),
        "obstacles": scenario.arena.obstacles.iter().map(obstacle).collect::<Vec<_>>(),
        "targets": targets,
        "relies": relies(film),
        "robots": film.robots(),
        "roles": vocabulary.roles,
        "role_colours": (0..).zip(vocabulary.roles).map(|(index, name)| role_colour(name, index)).collect::<Vec<_>>(),
        "topics": vocabulary.topics,
        "topic_colours": (0..vocabulary.topics.len()).map(topic_colour).collect::<Vec<_>>(),
        "causes": causes.map(|cause| cause.name().replace('_', " ")),
        "cause_colours": causes.map(|cause| cause_colour(cause.name())),
        "frames": {
            "count": film.instants(),
            "every_s": film.every.as_secs(),
            "quantum_m": film::QUANTUM_M,
            "width": sections::width(film),
            "note": film.is_thinned().then(|| format!("Places every {} only, straight lines between them.", number::seconds(film.every.as_secs()))),
        },
        "range_m": range(input.reach),
        "links": toggles.map(|toggles| json!({
            "samples": toggles.looks(),
            "every_frames": toggles.every,
            "note": (toggles.every > 1).then(|| format!("Links every {}.", number::seconds(film.every.as_secs() * toggles.every as f64))),
        })),
        "messages": {
            "count": film.messages.len(),
            "copies": film.copies.len(),
            "note": left_out_words(film, left_out),
        },
        "faults": events::faults(record),
        "series": series(input, film),
        "events": events,
    })
}

/// That messages are thinned out, and events cut off, if they are.
fn left_out_words(film: &Film, events: u64) -> Option<String> {
    let messages = (film.one_of > 1).then(|| format!("One message of {} is shown.", number::count(film.one_of)));
    let events = (events > 0).then(|| {
        format!(
            "{} later changes of role and suspicions are not listed.",
            number::count(events)
        )
    });
    let words: Vec<String> = messages.into_iter().chain(events).collect();
    (!words.is_empty()).then(|| words.join(" "))
}

fn outcome(record: &TrialRecord) -> String {
    let seconds = |steps: f64| number::seconds(steps * record.control_period.as_secs());
    match record.outcome {
        Outcome::Completed { step } => format!("completed at step {}, {}", number::count(step), seconds(step as f64)),
        Outcome::Censored => format!("not completed in {}", number::seconds(record.simulated.as_secs())),
        Outcome::NoMission => format!("ran for {}", number::seconds(record.simulated.as_secs())),
    }
}

fn obstacle(config: &ObstacleConfig) -> Value {
    match config {
        ObstacleConfig::Disc { at, radius, .. } => json!({"disc": [at.0.get(), at.1.get(), radius.get()]}),
        ObstacleConfig::Wall { from, to, .. } => {
            json!({"wall": [from.0.get(), from.1.get(), to.0.get(), to.1.get()]})
        }
    }
}

/// Since when, seconds, which robot relies on which others: of robots that ever do.
fn relies(film: &Film) -> Vec<(f64, u32, Vec<u32>)> {
    let changes = film.changes.relies.iter().take(MOST_CHANGES);
    changes
        .map(|(at, robot, others)| (at.as_secs(), robot.0, others.iter().map(|other| other.0).collect()))
        .collect()
}

/// What changes over time: how well the swarm is connected, what it says.
fn series(input: &ReplayInput, film: &Film) -> Vec<Value> {
    let record = input.record;
    let samples = || record.connectivity.iter();
    let times: Vec<f64> = samples().map(|sample| sample.at.as_secs()).collect();
    let mut all = vec![
        json!({"name": "λ₂", "unit": "", "t": times, "v": samples().map(|sample| sample.lambda2).collect::<Vec<_>>()}),
        json!({"name": "components", "unit": "", "t": times, "v": samples().map(|sample| sample.components).collect::<Vec<_>>()}),
    ];
    let entries: Vec<(f64, f64)> = record
        .series
        .iter()
        .filter(|entry| entry.at > entry.since)
        .map(|entry| {
            let bytes: u64 = entry.sent.iter().map(|bytes| bytes.total).sum();
            (entry.at.as_secs(), bytes as f64 / entry.at.since(entry.since).as_secs())
        })
        .collect();
    let (times, rates): (Vec<f64>, Vec<f64>) = entries.into_iter().unzip();
    all.push(json!({"name": "bytes sent", "unit": "B/s", "t": times, "v": rates}));
    if let (Some(airtime), Some(radio)) = (&film.airtime, input.scenario.radio.shared()) {
        let [_, message_header] = input.scenario.header_bytes();
        let shares = airtime.series(&radio.phy(), message_header, record.simulated.as_secs());
        let (times, shares): (Vec<f64>, Vec<f64>) = shares.into_iter().map(|(at, share)| (at, 100.0 * share)).unzip();
        all.push(json!({"name": "on air, all robots together", "unit": "%", "t": times, "v": shares}));
    }
    // What always has one value needs no chart.
    let varies = |values: &Vec<Value>| values.iter().any(|value| *value != values[0]);
    all.retain(|series| series["v"].as_array().is_some_and(varies));
    all
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
