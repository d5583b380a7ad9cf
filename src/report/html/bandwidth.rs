//! What robots send and receive: by topic, by role, payload and headers.

use plotly::common::{Marker, Orientation};
use plotly::layout::{AxisRange, HoverMode};
use plotly::{Bar, BoxPlot, Plot};

use super::PageInput;
use super::chart::{axis, chart, faint, role_colour, shown, stacked, topic_colour, words};
use super::data::Spread;
use super::figure::{Figure, Panel};
use super::names::Names;
use super::table::{Cell, DataTable};
use crate::metrics::TrafficRow;
use crate::report::number;

const UNIT: &str = "bytes a control step, headers included";
const SPREAD: [&str; 11] = [
    "of",
    "direction",
    "robots × trials",
    "least, B/step",
    "5 %, B/step",
    "25 %, B/step",
    "median, B/step",
    "75 %, B/step",
    "95 %, B/step",
    "most, B/step",
    "mean, B/step",
];

/// Bytes of a row, one way.
type Bytes = fn(&TrafficRow) -> u64;
/// Both ways, by the names that tables have for them.
pub const WAYS: [(&str, &str, Bytes); 2] = [
    ("sent", "Sent", |row| row.sent.bytes()),
    ("received", "Received", |row| row.received.bytes()),
];

/// A named group of robots' bandwidths.
struct Group<'a> {
    name: &'a str,
    colour: &'static str,
    spread: Spread,
}

/// How the bandwidth of robots spreads, by topic.
pub fn by_topic(input: &PageInput) -> Figure {
    let groups = |bytes: Bytes| {
        let of_topic = |topic: usize| {
            let records = input.records().iter();
            let values = records.flat_map(|record| {
                record.bytes_per_step(|row| if usize::from(row.topic) == topic { bytes(row) } else { 0 })
            });
            Some(Group {
                name: input.topic(topic),
                colour: topic_colour(topic),
                spread: Spread::of(values.collect())?,
            })
        };
        (0..input.topics.len()).filter_map(of_topic).collect::<Vec<_>>()
    };
    let caption = format!(
        "How many {UNIT}, each robot sent and received {}, topic by topic. The box holds the middle half of the robots, its \
         line is their median, its dashed line their mean; whiskers reach from the least to the most of any robot in any trial. A \
         broadcast counts once where it is sent and at every robot that hears it.",
        input.in_drawn()
    );
    spread_figure(
        "bytes-by-topic",
        "Bytes by topic",
        caption,
        &WAYS.map(|(.., bytes)| groups(bytes)),
    )
}

/// How the bandwidth of robots spreads while they are in a role.
pub fn by_role(input: &PageInput) -> Option<Figure> {
    if input.roles.len() < 2 {
        return None;
    }
    let groups = |bytes: Bytes| {
        let of_role = |role: usize| {
            let is_its = |row: &TrafficRow| usize::from(row.role) == role;
            let values = input.records().iter().flat_map(|record| {
                let all = record.bytes_per_step(|row| if is_its(row) { bytes(row) } else { 0 });
                let rows = record.traffic.iter().filter(|row| is_its(row));
                let mut robots: Vec<_> = rows.map(|row| row.robot.index()).collect();
                robots.dedup();
                robots.into_iter().map(move |robot| all[robot]).collect::<Vec<_>>()
            });
            Some(Group {
                name: input.role(role),
                colour: role_colour(input.role(role), role),
                spread: Spread::of(values.collect())?,
            })
        };
        (0..input.roles.len()).filter_map(of_role).collect::<Vec<_>>()
    };
    let caption = format!(
        "How many {UNIT}, robots sent and received while in each role {}, as in the figure before. A robot counts in every role \
         that it was in, with what it carried meanwhile over all steps of its trial: roles add up to the whole.",
        input.in_drawn()
    );
    let groups = WAYS.map(|(.., bytes)| groups(bytes));
    Some(spread_figure("bytes-by-role", "Bytes by role", caption, &groups))
}

fn spread_figure(id: &'static str, title: &'static str, caption: String, ways: &[Vec<Group>; 2]) -> Figure {
    let mut table = DataTable::new(&SPREAD);
    let mut panels = Vec::new();
    for ((direction, heading, _), groups) in WAYS.iter().zip(ways) {
        let ends = groups.iter().flat_map(|group| [group.spread.min, group.spread.max]);
        let panel = Panel::of_rows(*heading, boxes(groups), groups.len());
        panels.push(panel.unless_one(ends, |value| {
            format!("{} B/step in each of them.", number::figure(value))
        }));
        for group in groups {
            let Spread {
                n,
                min,
                quantiles,
                max,
                mean,
            } = group.spread;
            let mut row: Vec<Cell> = vec![group.name.into(), (*direction).into(), n.into(), min.into()];
            row.extend(quantiles.map(Cell::from));
            row.extend([max.into(), mean.into()]);
            table.rows.push(row);
        }
    }
    Figure {
        id: id.into(),
        title: title.into(),
        caption,
        panels,
        key: Vec::new(),
        table,
    }
}

fn boxes(groups: &[Group]) -> Plot {
    let readable: Vec<String> = groups.iter().map(|group| group.name.replace('_', " ")).collect();
    let names = Names::of(readable.iter().map(String::as_str));
    let mut plot = chart(axis("B/step"), names.down(), HoverMode::Closest);
    // The first stands at the top.
    for (place, group) in groups.iter().enumerate().rev() {
        let Spread {
            min,
            quantiles,
            max,
            mean,
            ..
        } = group.spread;
        let one = |value: f64| vec![shown(value)];
        let drawn = BoxPlot::<f64, String>::new_xy(Vec::new(), vec![names.at(place)])
            .name(words(group.name))
            .orientation(Orientation::Horizontal)
            .q1(one(quantiles[1]))
            .median(one(quantiles[2]))
            .q3(one(quantiles[3]))
            .lower_fence(one(min))
            .upper_fence(one(max))
            .mean(one(mean))
            .box_mean(plotly::box_plot::BoxMean::True)
            .marker(Marker::new().color(group.colour))
            .fill_color(faint(group.colour, 0.3))
            .show_legend(false);
        plot.add_trace(drawn);
    }
    plot
}

/// Payload and headers in what is sent, by topic.
pub fn headers(input: &PageInput) -> Figure {
    let mut table = DataTable::new(&[
        "topic",
        "frames sent",
        "payload, B",
        "headers, B",
        "share of headers, %",
        "payload, B/step and robot",
        "headers, B/step and robot",
    ]);
    let robot_steps: f64 = input
        .records()
        .iter()
        .flat_map(|record| &record.robots)
        .map(|robot| robot.steps.max(1) as f64)
        .sum();
    let mut bars = Vec::new();
    for topic in 0..input.topics.len() {
        let rows = input.records().iter().flat_map(|record| &record.traffic);
        let (mut frames, mut payload, mut header) = (0, 0, 0);
        for row in rows.filter(|row| usize::from(row.topic) == topic) {
            frames += row.sent.frames;
            payload += row.sent.payload_bytes;
            header += row.sent.header_bytes;
        }
        let share = (payload + header > 0).then(|| header as f64 / (payload + header) as f64);
        let [payload_rate, header_rate] = [payload, header].map(|bytes| bytes as f64 / robot_steps.max(1.0));
        table.rows.push(vec![
            input.topic(topic).into(),
            frames.into(),
            payload.into(),
            header.into(),
            share.map(|share| share * 100.0).into(),
            payload_rate.into(),
            header_rate.into(),
        ]);
        let label = share.map_or(String::new(), |share| format!("{:.0} %", share * 100.0));
        bars.push((input.topic(topic).replace('_', " "), payload_rate, header_rate, label));
    }
    let names = Names::of(bars.iter().map(|(name, ..)| name.as_str()));
    let stack = |name: &str, colour: &'static str, values: Vec<f64>, labels: Option<Vec<String>>| {
        let bar = Bar::new(values.into_iter().map(shown).collect(), names.all())
            .name(name)
            .orientation(Orientation::Horizontal)
            .marker(Marker::new().color(colour))
            .hover_template("%{y}: %{x:.4g} B/step");
        match labels {
            Some(labels) => bar
                .text_array(labels)
                .text_position(plotly::common::TextPosition::Outside)
                .clip_on_axis(false),
            None => bar,
        }
    };
    // Room for the label of the longest bar.
    let longest = bars.iter().map(|bar| bar.1 + bar.2).fold(f64::MIN_POSITIVE, f64::max);
    let x = axis("B/step sent by a robot, mean").range(AxisRange::new(0.0, longest * 1.3));
    let mut plot = stacked(x, names.down());
    plot.add_trace(stack(
        "payload",
        "#4d7ea8",
        bars.iter().map(|bar| bar.1).collect(),
        None,
    ));
    let labels = bars.iter().map(|bar| bar.3.clone()).collect();
    plot.add_trace(stack(
        "headers",
        "#c9c9c9",
        bars.iter().map(|bar| bar.2).collect(),
        Some(labels),
    ));
    let [of_frame, of_message] = input.scenario.header_bytes();
    Figure {
        id: "headers".into(),
        title: "Payload and headers".into(),
        caption: format!(
            "What a robot sends on average {}, split into the bytes of the messages and of their headers, {of_frame} for each frame and {of_message} for \
             each message in it; the number is the share of headers. Small messages pay most for their headers: sending several in one \
             frame saves some of that.",
            input.in_drawn()
        ),
        panels: vec![Panel::of_rows("", plot, input.topics.len()).unless_one(
            bars.iter().flat_map(|bar| [bar.1, bar.2]),
            |rate| {
                if rate == 0.0 {
                    "Nothing was sent.".to_owned()
                } else {
                    format!("{} B/step of messages, and as much of headers.", number::figure(rate))
                }
            },
        )],
        key: Vec::new(),
        table,
    }
}
