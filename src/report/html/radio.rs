//! What the air does to frames: losses by cause, latency as felt.

use plotly::Bar;
use plotly::Scatter;
use plotly::common::{HoverInfo, LineShape, Marker, MarkerSymbol, Mode, Orientation};
use plotly::layout::{AxisRange, AxisType, HoverMode};

use super::PageInput;
use super::chart::{ALL, DIRECTIONS, axis, cause_colour, chart, line, percent_axis, shown, stacked, words};
use super::figure::{Figure, Panel};
use super::names::Names;
use super::table::{Cell, DataTable};
use crate::metrics::LatencyHistogram;
use crate::metrics::summary::Fates;
use crate::report::number;

/// Copies lost, by topic and cause.
pub fn lost(input: &PageInput) -> Figure {
    let frames = &input.summary.frames;
    // A cause that took nothing has no place, neither in the table nor in the legend.
    let causes = frames.total.lost.0.iter().enumerate();
    let causes: Vec<(usize, &str)> = causes
        .filter(|(_, (_, lost))| *lost > 0)
        .map(|(number, (cause, _))| (number, cause.as_str()))
        .collect();
    let of_cause = |fates: &Fates, cause: usize| fates.lost.0.get(cause).map_or(0, |(_, frames)| *frames);
    let mut head: Vec<String> = ["topic", "offered", "delivered", "in flight"].map(str::to_owned).into();
    head.extend(
        causes
            .iter()
            .map(|(_, cause)| format!("lost: {}", cause.replace('_', " "))),
    );
    let mut table = DataTable { head, rows: Vec::new() };
    let topics = frames.by_topic.0.iter().map(|(name, fates)| (name.as_str(), fates));
    let rows: Vec<_> = topics.chain([("all topics", &frames.total)]).collect();
    for (name, fates) in &rows {
        let mut row: Vec<Cell> = vec![
            (*name).into(),
            fates.offered.into(),
            fates.delivered.into(),
            fates.in_flight.into(),
        ];
        row.extend(causes.iter().map(|(cause, _)| Cell::from(of_cause(fates, *cause))));
        table.rows.push(row);
    }
    let readable: Vec<String> = rows.iter().map(|(name, _)| name.replace('_', " ")).collect();
    let names = Names::of(readable.iter().map(String::as_str));
    let mut plot = stacked(axis("share of copies offered").tick_suffix(" %"), names.down());
    let mut shares = Vec::new();
    for &(cause, name) in &causes {
        let share =
            |(_, fates): &(&str, &Fates)| shown(100.0 * of_cause(fates, cause) as f64 / fates.offered.max(1) as f64);
        shares.extend(rows.iter().map(share));
        let bars = Bar::new(rows.iter().map(share).collect(), names.all())
            .name(words(name))
            .orientation(Orientation::Horizontal)
            .marker(Marker::new().color(cause_colour(name)))
            .hover_template("%{y}: %{x:.4g} %");
        plot.add_trace(bars);
    }
    let total: u64 = frames.total.lost.0.iter().map(|(_, frames)| frames).sum();
    Figure {
        id: "lost".into(),
        title: "Lost frames by cause".into(),
        caption: format!(
            "Of the copies of frames that were offered to robots in range {}, the share that was lost, by cause. A frame that five robots could hear \
             is five copies, each with a fate of its own. In all, {} of {} copies were lost.",
            input.in_trials(),
            number::count(total),
            number::count(frames.total.offered)
        ),
        panels: vec![if total > 0 {
            Panel::of_rows("", plot, rows.len()).unless_one(shares, |share| {
                let causes: Vec<String> = causes.iter().map(|(_, name)| name.replace('_', " ")).collect();
                format!(
                    "{} on every topic: {}.",
                    number::percent(share / 100.0),
                    causes.join(", ")
                )
            })
        } else {
            Panel::words("", "No copy was lost.")
        }],
        key: Vec::new(),
        table,
    }
}

/// Times that frames took, as receivers felt them.
pub fn latency(input: &PageInput) -> Option<Figure> {
    let all = input.trials.latency();
    let (least, most) = (all.min()?, all.max()?);
    let mut curve = vec![[least.as_secs() * 1e3, 0.0]];
    let mut below = 0;
    for (_, high, count) in all.buckets() {
        below += count;
        let high = high.min(most.as_nanos());
        curve.push([high as f64 / 1e6, 100.0 * below as f64 / all.count() as f64]);
    }
    let mut table = DataTable::new(&["latency, ms", "copies that took no longer, %"]);
    table.rows = curve
        .iter()
        .map(|[time, share]| vec![(*time).into(), (*share).into()])
        .collect();
    let wide = least.as_nanos() > 0 && most.as_nanos() / least.as_nanos().max(1) >= 20;
    let x = axis("latency, ms");
    let x = if wide {
        x.type_(AxisType::Log)
    } else {
        x.range(AxisRange::new(0.0, shown(most.as_secs() * 1.15e3)))
    };
    let mut plot = chart(x, percent_axis("copies that took no longer"), HoverMode::Closest);
    let hover = "%{y:.2f} % within %{x:.4g} ms<extra></extra>";
    plot.add_trace(line("copies", ALL, &curve, LineShape::Hv, hover).show_legend(false));
    for (mark, symbol) in quantiles(all).iter().zip(SYMBOLS) {
        plot.add_trace(mark.trace(symbol));
    }
    Some(Figure {
        id: "latency".into(),
        title: "Latency as felt".into(),
        caption: format!(
            "Which share of the {} copies that arrived {} took no longer than so many milliseconds, from the start of its transmission to its arrival; marks are the median and the 95th and \
             99th percentile. Times are those of buckets at most 1/128 of their lower end wide.{}",
            number::count(all.count()),
            input.in_trials(),
            if wide { " Mind the logarithmic axis." } else { "" }
        ),
        panels: vec![if least == most {
            Panel::words("", format!("Every copy took {}.", number::seconds(least.as_secs())))
        } else {
            Panel::new("", plot)
        }],
        key: Vec::new(),
        table,
    })
}

/// A mark on the curve.
struct Mark {
    /// Where, milliseconds and percent.
    at: [f64; 2],
    /// Which quantiles it is.
    names: String,
    /// Their latency, in words.
    time: String,
}

/// A mark for each: none looks like another.
const SYMBOLS: [MarkerSymbol; 3] = [MarkerSymbol::Circle, MarkerSymbol::Square, MarkerSymbol::Diamond];

impl Mark {
    /// The mark, named above the chart: beside it a telephone has no room.
    fn trace(&self, symbol: MarkerSymbol) -> Box<Scatter<f64, f64>> {
        Scatter::new(vec![self.at[0]], vec![self.at[1]])
            .mode(Mode::Markers)
            .name(format!("{}: {}", self.names, self.time))
            .marker(Marker::new().color(DIRECTIONS[1]).symbol(symbol).size(9))
            .hover_info(HoverInfo::Skip)
    }
}

/// Marks at the median and at the 95th and 99th percentile, those that read the same in one.
fn quantiles(all: &LatencyHistogram) -> Vec<Mark> {
    let mut marks: Vec<Mark> = Vec::new();
    for (q, name) in [(0.5, "median"), (0.95, "95 %"), (0.99, "99 %")] {
        let Some(latency) = all.quantile(q) else { continue };
        let time = number::seconds(latency.as_secs());
        match marks.iter_mut().find(|mark| mark.time == time) {
            Some(mark) => mark.names = format!("{}, {name}", mark.names),
            None => marks.push(Mark {
                at: [shown(latency.as_secs() * 1e3), q * 100.0],
                names: name.to_owned(),
                time,
            }),
        }
    }
    marks
}
