//! How rumours spread, and what was heard in vain.

use plotly::Bar;
use plotly::common::{LineShape, Marker, Orientation};
use plotly::layout::HoverMode;

use super::PageInput;
use super::chart::{ALL, axis, chart, line, one_value, percent_axis, shown, topic_colour, words};
use super::faults;
use super::figure::{Figure, Panel};
use super::names::Names;
use super::table::DataTable;
use crate::engine::SimTime;
use crate::report::number;

/// Points of a curve: more than a screen can show would only make the page long.
const MOST_POINTS: usize = 300;

/// Who knew the rumours when; none without rumours.
pub fn spread(input: &PageInput) -> Option<Figure> {
    let pairs = || {
        let rumors = input.records.iter().flat_map(|record| &record.spread);
        rumors.flat_map(|rumor| &rumor.informed)
    };
    let count = pairs().count();
    let mut times: Vec<SimTime> = pairs().copied().flatten().collect();
    times.sort_unstable();
    let end = input.records.iter().map(|record| record.simulated).max()?;
    (count > 0).then_some(())?;
    let share = |informed: usize| 100.0 * informed as f64 / count as f64;
    let every = times.len().div_ceil(MOST_POINTS).max(1);
    let marks = times.iter().enumerate().map(|(index, at)| (index + 1, at));
    let kept = marks.filter(|(informed, _)| informed.is_multiple_of(every) || *informed == times.len());
    let mut curve: Vec<[f64; 2]> = kept.map(|(informed, at)| [at.as_secs(), share(informed)]).collect();
    curve.push([end.as_secs(), share(times.len())]);
    let mut table = DataTable::new(&["time, s", "pairs informed, %"]);
    table.rows = curve
        .iter()
        .map(|[time, share]| vec![(*time).into(), (*share).into()])
        .collect();
    let mut plot = chart(axis("time, s"), percent_axis("pairs informed"), HoverMode::Closest);
    let hover = "%{y:.1f} % at %{x:.4g} s<extra></extra>";
    plot.add_trace(line("informed", ALL, &curve, LineShape::Hv, hover).show_legend(false));
    faults::mark(&mut plot, input);
    Some(Figure {
        id: "spread".into(),
        title: "Spread of rumours".into(),
        caption: format!(
            "Which share of all pairs of a robot and a rumour {} was informed by when: a robot knows a rumour from its arrival on. All \
             trials in one curve; robots that failed are counted too.{}",
            input.in_trials(),
            faults::words(input)
        ),
        panels: vec![Panel::new("", plot)],
        key: Vec::new(),
        table,
    })
}

/// Messages that told their receiver nothing new; none where the protocol names no duplicates.
pub fn duplicates(input: &PageInput) -> Option<Figure> {
    let duplicates = Some(&input.summary.duplicates).filter(|duplicates| duplicates.any())?;
    let mut table = DataTable::new(&["topic", "duplicates in messages delivered", "95 % from", "to"]);
    let topics = || duplicates.by_topic.0.iter().enumerate();
    let readable: Vec<String> = topics().map(|(_, (name, _))| name.replace('_', " ")).collect();
    let names = Names::of(readable.iter().map(String::as_str));
    let mut plot = chart(
        axis("share of the messages delivered").tick_suffix(" %"),
        names.down(),
        HoverMode::Closest,
    );
    for (topic, (name, share)) in topics() {
        table.rows.push(vec![
            name.as_str().into(),
            share.value.into(),
            share.ci95[0].into(),
            share.ci95[1].into(),
        ]);
        let bar = Bar::new(vec![shown(100.0 * share.value.unwrap_or(0.0))], vec![names.at(topic)])
            .name(words(name))
            .orientation(Orientation::Horizontal)
            .marker(Marker::new().color(topic_colour(topic)))
            .show_legend(false)
            .hover_template("%{y}: %{x:.4g} %<extra></extra>");
        plot.add_trace(bar);
    }
    Some(Figure {
        id: "duplicates".into(),
        title: "Duplicates".into(),
        caption: format!(
            "Of the messages of each topic that were delivered {}, the share that told their receiver nothing new, as the protocol \
             judges it. A topic of which nothing was delivered has none.",
            input.in_trials()
        ),
        panels: vec![
            match one_value(topics().map(|(_, (_, share))| share.value.unwrap_or(0.0))) {
                Some(share) if topics().count() > 1 || share == 0.0 => {
                    Panel::words("", format!("{} on every topic.", number::percent(share)))
                }
                _ => Panel::of_rows("", plot, topics().count()),
            },
        ],
        key: Vec::new(),
        table,
    })
}
