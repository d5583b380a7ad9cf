//! The report that `desim scenario` ends with.

use std::path::Path;

use super::air;
use super::failures;
use super::further;
use super::grid::Grid;
use super::layout::Page;
use super::missed::{self, Asked};
use super::number::{NOTHING, count, estimate, figure, lasted, maybe, percent, seconds};
use super::spread;
use super::surprises;
use crate::metrics::Summary;
use crate::metrics::summary::{Detection, Directions, Quantity, Spread, TopicBandwidth};
use crate::predict::Surprise;
use crate::text::{Style, shown};

/// What a report is made of.
#[derive(Debug)]
pub struct Input<'a> {
    /// The question that the scenario asks.
    pub question: Option<&'a str>,
    /// The figures.
    pub summary: &'a Summary,
    /// What the mission asks for, if there is one with targets.
    pub asked: Option<&'a Asked>,
    /// Length of a control step, seconds.
    pub control_period_s: f64,
    /// Whether robots ran a failure detector.
    pub detects: bool,
    /// Where the run is not as predicted.
    pub surprises: &'a [Surprise],
    /// What the run took.
    pub speed: Speed,
    /// Where the results are.
    pub folder: &'a Path,
    /// Names of the files there.
    pub files: &'a [&'a str],
    /// How it is laid out.
    pub style: Style,
}

/// What the trials took, all together.
#[derive(Clone, Copy, Debug)]
pub struct Speed {
    /// Simulated seconds.
    pub simulated_s: f64,
    /// Copies of frames delivered.
    pub delivered: u64,
    /// Wall time of the threads that ran the trials, seconds.
    pub wall_s: f64,
}

/// The report as text.
#[must_use]
pub fn terminal(input: &Input) -> String {
    let mut page = Page::new(input.style);
    page.title(&input.summary.scenario, input.question);
    outcome(&mut page, input);
    failures::section(&mut page, input.summary);
    spread::section(&mut page, input.summary);
    bandwidth(&mut page, input.summary);
    radio(&mut page, input.summary);
    air::section(&mut page, input.summary);
    connectivity(&mut page, input.summary);
    detection(&mut page, input);
    further::section(&mut page, input.summary);
    surprises::section(&mut page, input.surprises);
    run(&mut page, input);
    page.text()
}

fn outcome(page: &mut Page, input: &Input) {
    let summary = input.summary;
    page.heading("Mission");
    let Some(share) = summary.completion_ratio.estimate.value else {
        page.words("none: every trial ran to its time limit");
        return;
    };
    let [low, high] = summary
        .completion_ratio
        .estimate
        .ci95
        .map(|end| end.map_or(NOTHING.into(), percent));
    let completed = format!(
        "{} of {} trials: {} [{low}, {high}]",
        count(summary.completed),
        count(summary.completion_ratio.estimate.n),
        percent(share)
    );
    page.entry("completed", &completed);
    let median = &summary.steps_to_completion.median;
    let steps = match median.value {
        Some(steps) => format!(
            "{} control steps, {}: Kaplan–Meier median of {} trials",
            estimate(median, figure),
            seconds(steps * input.control_period_s),
            median.n
        ),
        None => format!(
            "{}: fewer than half of {} trials completed",
            estimate(median, figure),
            median.n
        ),
    };
    page.entry("after", &steps);
    page.entry(
        "robots used",
        &format!("{} on average", estimate(&summary.robots_used.estimate, figure)),
    );
    let mut name = "missed";
    for sentence in missed::sentences(summary, input.asked) {
        page.entry(name, &sentence);
        name = "";
    }
}

fn bandwidth(page: &mut Page, summary: &Summary) {
    let bandwidth = &summary.bandwidth;
    page.heading("Bandwidth of a robot: bytes a control step, headers included");
    let mut table = Grid::of_figures(&HEADER);
    for (name, topic) in &bandwidth.by_topic.0 {
        let TopicBandwidth {
            directions,
            lost_bytes_per_step,
            header_share,
        } = topic;
        table.row(row(
            name,
            directions,
            &cell(lost_bytes_per_step.median),
            &share(header_share),
        ));
    }
    table.row(row("all topics", &bandwidth.total, "", ""));
    page.table(&table);
    page.gap();
    let mean = |spread: &Spread| estimate(&spread.mean, figure);
    let Directions {
        tx_bytes_per_step: sent,
        rx_bytes_per_step: received,
        ..
    } = &bandwidth.total;
    page.entry("mean", &format!("sent {}, received {}", mean(sent), mean(received)));
    let load = &summary.load_imbalance;
    let gini = |load| estimate(load, |gini| format!("{gini:.3}"));
    let load = format!("sent {}, received {}", gini(&load.tx), gini(&load.rx));
    page.entry("Gini of load", &format!("{load}; 0 where all carry the same"));
}

const HEADER: [&str; 9] = [
    "",
    "sent\nleast",
    "\nmedian",
    "\nmost",
    "received\nleast",
    "\nmedian",
    "\nmost",
    "lost\nmedian",
    "headers\nin sent",
];

fn row(name: &str, directions: &Directions, lost: &str, header: &str) -> [String; 9] {
    let [sent_least, sent, sent_most] = spread(&directions.tx_bytes_per_step);
    let [least, received, most] = spread(&directions.rx_bytes_per_step);
    let (lost, header) = (lost.to_owned(), header.to_owned());
    [
        name.to_owned(),
        sent_least,
        sent,
        sent_most,
        least,
        received,
        most,
        lost,
        header,
    ]
}

fn spread(spread: &Spread) -> [String; 3] {
    [spread.min, spread.median, spread.max].map(cell)
}

/// A figure that may be missing, short enough for a column.
fn cell(value: Option<f64>) -> String {
    if value.is_some_and(|value| value > 0.0 && value < 0.01) {
        "<0.01".to_owned()
    } else {
        maybe(value)
    }
}

fn share(share: &Quantity<Option<f64>>) -> String {
    share
        .value
        .map_or_else(|| NOTHING.to_owned(), |share| format!("{:.0} %", share * 100.0))
}

fn radio(page: &mut Page, summary: &Summary) {
    page.heading("Radio");
    let fates = &summary.frames.total;
    page.entry(
        "delivered",
        &format!(
            "{} of the copies offered",
            estimate(&summary.delivery_ratio.estimate, percent)
        ),
    );
    let latency = &summary.latency_s;
    let [median, p95, p99] =
        [latency.p50, latency.p95, latency.p99].map(|quantile| quantile.map_or(NOTHING.into(), seconds));
    page.entry(
        "latency",
        &format!("median {median}, 95 % within {p95}, 99 % within {p99}"),
    );
    let lost: u64 = fates.lost.0.iter().map(|(_, frames)| frames).sum();
    let causes: Vec<_> = fates
        .lost
        .0
        .iter()
        // Where there are many, they have their own lines.
        .filter(|(_, frames)| *frames > 0 && summary.radio.is_none())
        .map(|(cause, frames)| format!("{} {}", cause.replace('_', " "), count(*frames)))
        .collect();
    let causes = if causes.is_empty() {
        String::new()
    } else {
        format!(" ({})", causes.join(", "))
    };
    let balanced = fates.offered == fates.delivered + lost + fates.in_flight;
    let balance = format!(
        "{} copies {} {} delivered + {} lost{} + {} in flight",
        count(fates.offered),
        if balanced { "=" } else { "≠" },
        count(fates.delivered),
        count(lost),
        causes,
        count(fates.in_flight)
    );
    page.entry("offered", &balance);
    if summary.duplicates.any() {
        let share = estimate(&summary.duplicates.total, percent);
        page.entry(
            "duplicates",
            &format!("{share} of what was delivered told its receiver nothing new"),
        );
    }
}

fn connectivity(page: &mut Page, summary: &Summary) {
    page.heading("Connectivity");
    let lambda2 = &summary.lambda2_min;
    if lambda2.min.is_none() {
        page.words("not sampled");
        return;
    }
    let least = format!(
        "{} median of trials, {} at worst",
        estimate(&lambda2.estimate, figure),
        maybe(lambda2.min)
    );
    page.entry("least λ₂", &least);
    let connected = estimate(&summary.connected_share.estimate, percent);
    page.entry("in one piece", &format!("{connected} of the time"));
}

fn detection(page: &mut Page, input: &Input) {
    let detection = &input.summary.detection;
    page.heading("Failure detection");
    if !input.detects {
        page.words("none: robots ran no failure detector");
        return;
    }
    if detection.monitored_s.value <= 0.0 && detection.suspicions.value == 0 {
        page.words("no robot watched another");
        return;
    }
    let Detection {
        suspicions, failures, ..
    } = detection;
    let by_cause = suspicions.by_cause.0.iter().filter(|(_, number)| *number > 0);
    let by_cause: Vec<_> = by_cause
        .map(|(cause, number)| format!("{} {}", cause.replace('_', " "), count(*number)))
        .collect();
    let causes = match &by_cause[..] {
        [] => String::new(),
        causes => format!(", for {}", causes.join(", ")),
    };
    page.entry("suspicions", &format!("{}{causes}", count(suspicions.value)));
    let mistakes = match detection.mistakes.value {
        0 => "none".to_owned(),
        mistakes => format!(
            "{}: of a pair of robots one every {} s, for {}",
            count(mistakes),
            estimate(&detection.mistake_recurrence_s.estimate, figure),
            lasted(&detection.mistake_duration_s)
        ),
    };
    page.entry("mistakes", &mistakes);
    let accuracy = estimate(&detection.query_accuracy.estimate, percent);
    page.entry(
        "accuracy",
        &format!("robots that were well were trusted {accuracy} of the time"),
    );
    if failures.observed > 0 {
        let detected = format!(
            "{} of {} detected by those who watched, after {}",
            count(failures.detected),
            count(failures.observed),
            lasted(&detection.detection_time_s)
        );
        page.entry("failures", &detected);
    }
}

fn run(page: &mut Page, input: &Input) {
    page.heading("Run");
    let Speed {
        simulated_s,
        delivered,
        wall_s,
    } = input.speed;
    let trials = input.summary.trials;
    let simulated = format!(
        "{} in {} trial{}, {} control steps",
        seconds(simulated_s),
        count(trials),
        if trials == 1 { "" } else { "s" },
        count(input.summary.steps.value)
    );
    page.entry("simulated", &simulated);
    if wall_s > 0.0 {
        let speed = format!(
            "{} simulated seconds and {} deliveries a second on each thread",
            figure(simulated_s / wall_s),
            figure(delivered as f64 / wall_s)
        );
        page.entry("speed", &speed);
    }
    page.entry("digest", &input.summary.digest);
    page.entry("results", &shown(input.folder));
    page.entry("", &input.files.join(", "));
    page.gap();
    page.paragraph("", "", "Figures in brackets are 95 % intervals over trials.");
}
