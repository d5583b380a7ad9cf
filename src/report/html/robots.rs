//! How the load spreads over robots: who carries it, and how evenly.

use plotly::Scatter;
use plotly::common::{DashType, ErrorData, ErrorType, Line, LineShape, Marker, Mode};
use plotly::layout::{AxisRange, HoverMode};

use super::PageInput;
use super::bandwidth::WAYS;
use super::chart::{DIRECTIONS, Points, axis, band, chart, line, percent_axis, shown};
use super::data::Spread;
use super::figure::{Figure, Panel};
use super::table::DataTable;
use crate::metrics::TrialRecord;
use crate::report::number;
use crate::statistics::{gini, quantile};

/// Above this many robots, one mark each would hide the others.
const MOST_ROBOTS: usize = 250;
/// Steps of a curve over robots.
const STEPS: u32 = 100;

/// Which share of the robots has no more than so many bytes.
pub fn distribution(input: &PageInput) -> Figure {
    let mut table = DataTable::new(&[
        "direction",
        "share of robots, %",
        "5 % of trials, B/step",
        "median of trials, B/step",
        "95 % of trials, B/step",
    ]);
    let mut panels = Vec::new();
    for ((direction, heading, bytes), colour) in WAYS.into_iter().zip(DIRECTIONS) {
        let trials: Vec<Vec<f64>> = input
            .records()
            .iter()
            .map(|record| sorted(record.bytes_per_step(bytes)))
            .collect();
        let mut curves: [Points; 3] = Default::default();
        for step in 0..=STEPS {
            let share = f64::from(step) / f64::from(STEPS);
            let values = trials.iter().filter_map(|trial| quantile(trial, share)).collect();
            let Some(spread) = Spread::of(values) else { continue };
            let chosen = [spread.quantiles[0], spread.median(), spread.quantiles[4]];
            for (curve, value) in curves.iter_mut().zip(chosen) {
                curve.push([value, share * 100.0]);
            }
            let [low, middle, high] = chosen;
            table.rows.push(vec![
                direction.into(),
                (share * 100.0).into(),
                low.into(),
                middle.into(),
                high.into(),
            ]);
        }
        let mut plot = chart(axis("B/step"), percent_axis("robots with no more"), HoverMode::Closest);
        let [low, middle, high] = curves;
        if trials.len() > 1 {
            // High ends of the share's values lie to the right: the band goes from left to right.
            for edge in band(direction, colour, &low, &high, &LineShape::Linear) {
                plot.add_trace(edge);
            }
        }
        plot.add_trace(
            line(
                direction,
                colour,
                &middle,
                LineShape::Linear,
                "%{y:.0f} % of robots: at most %{x:.4g} B/step",
            )
            .show_legend(false),
        );
        panels.push(panel(heading, plot, &trials));
    }
    Figure {
        id: "bytes-by-robot".into(),
        title: "Bytes by robot".into(),
        caption: format!(
            "Which share of the robots sent, and received, no more than so many bytes a control step, on all topics, headers \
             included, {}. A steep curve means that all carry about the same.{}",
            input.in_drawn(),
            if input.records().len() > 1 {
                " The line is the median of the trials' curves, the band holds nine of ten of them."
            } else {
                ""
            }
        ),
        panels,
        key: Vec::new(),
        table,
    }
}

/// The chart, unless all robots of all trials carry the same.
fn panel(heading: &'static str, plot: plotly::Plot, trials: &[Vec<f64>]) -> Panel {
    Panel::new(heading, plot).unless_one(trials.iter().flatten().copied(), |value| {
        format!("{} B/step, each of them.", number::figure(value))
    })
}

/// What each robot carries, by its number.
pub fn by_number(input: &PageInput) -> Option<Figure> {
    let robots = input.records().iter().map(|record| record.robots.len()).max()?;
    if robots > MOST_ROBOTS {
        return None;
    }
    let mut table = DataTable::new(&[
        "robot",
        "direction",
        "trials",
        "least, B/step",
        "median, B/step",
        "most, B/step",
    ]);
    let mut panels = Vec::new();
    for ((direction, heading, bytes), colour) in WAYS.into_iter().zip(DIRECTIONS) {
        let trials: Vec<Vec<f64>> = input
            .records()
            .iter()
            .map(|record| record.bytes_per_step(bytes))
            .collect();
        let (mut x, mut middle, mut up, mut down) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for robot in 0..robots {
            let values = trials.iter().filter_map(|trial| trial.get(robot).copied()).collect();
            let Some(spread) = Spread::of(values) else { continue };
            x.push(robot as f64);
            middle.push(shown(spread.median()));
            up.push(shown(spread.max - spread.median()));
            down.push(shown(spread.median() - spread.min));
            table.rows.push(vec![
                (robot as u64).into(),
                direction.into(),
                spread.n.into(),
                spread.min.into(),
                spread.median().into(),
                spread.max.into(),
            ]);
        }
        let whiskers = ErrorData::new(ErrorType::Data)
            .array(up)
            .array_minus(down)
            .symmetric(false)
            .thickness(1.0)
            .width(0)
            .color("#b0b0b0");
        let marks = Scatter::new(x, middle)
            .mode(Mode::Markers)
            .marker(Marker::new().color(colour).size(5))
            .error_y(whiskers)
            .show_legend(false)
            .name(direction)
            .hover_template("robot %{x}: %{y:.4g} B/step<extra></extra>");
        let x = axis("robot").range(AxisRange::new(-1.0, robots as f64));
        let mut plot = chart(x, axis("B/step"), HoverMode::Closest);
        plot.add_trace(marks);
        panels.push(panel(heading, plot, &trials));
    }
    Some(Figure {
        id: "bytes-by-robot-number".into(),
        title: "Bytes of each robot".into(),
        caption: "The same robots by their numbers: the median over trials, and a line from the least to the most of any trial. A robot \
                  that stands out in every trial has a burden by its task, not by chance."
            .to_owned(),
        panels,
        key: Vec::new(),
        table,
    })
}

/// How unevenly robots share the load.
pub fn lorenz(input: &PageInput) -> Figure {
    let mut table = DataTable::new(&["direction", "share of robots, %", "share of bytes, %"]);
    let mut plot = chart(
        percent_axis("robots, those with the fewest bytes first"),
        percent_axis("their bytes"),
        HoverMode::Closest,
    );
    let equal = Scatter::new(vec![0.0, 100.0], vec![0.0, 100.0])
        .name("all carry the same")
        .mode(Mode::Lines)
        .line(Line::new().color("#999999").width(1.0).dash(DashType::Dash))
        .hover_info(plotly::common::HoverInfo::Skip);
    plot.add_trace(equal);
    let mut words = Vec::new();
    // How far curves hang below the diagonal.
    let mut below = vec![0.0];
    for ((direction, _, bytes), colour) in WAYS.into_iter().zip(DIRECTIONS) {
        let curve = mean_lorenz(input.records(), bytes);
        // What comes of rounding hangs nowhere.
        below.extend(curve.iter().map(|[robots, share]| (1e6 * (robots - share)).round()));
        for [robots, share] in &curve {
            table
                .rows
                .push(vec![direction.into(), (*robots).into(), (*share).into()]);
        }
        plot.add_trace(line(
            direction,
            colour,
            &curve,
            LineShape::Linear,
            "%{x:.0f} % of robots: %{y:.1f} % of the bytes",
        ));
        let of = if direction == "sent" {
            &input.summary.load_imbalance.tx
        } else {
            &input.summary.load_imbalance.rx
        };
        words.push(format!(
            "{} of bytes {direction}",
            number::estimate(of, |gini| format!("{gini:.3}"))
        ));
    }
    Figure {
        id: "load".into(),
        title: "How evenly robots share the load".into(),
        caption: format!(
            "Lorenz curves: which share of all bytes the robots with the fewest carry, mean over trials. The further a curve hangs \
             below the diagonal, the less even the load. The Gini coefficient, twice the area between, is {}; 0 where all carry the same.",
            words.join(" and ")
        ),
        panels: vec![Panel::new("", plot).unless_one(below, |_| "All robots carry the same.".to_owned())],
        key: Vec::new(),
        table,
    }
}

/// The mean over trials of the share of bytes that the first robots carry.
fn mean_lorenz(records: &[TrialRecord], bytes: fn(&crate::metrics::TrafficRow) -> u64) -> Points {
    let trials: Vec<Vec<f64>> = records
        .iter()
        .map(|record| sorted(record.bytes_per_step(bytes)))
        .collect();
    // A trial without a byte has no shares.
    let trials: Vec<Vec<f64>> = trials
        .into_iter()
        .filter(|trial| gini(trial).is_some())
        .map(cumulated)
        .collect();
    if trials.is_empty() {
        return Vec::new();
    }
    let at = |share: f64| {
        let sum: f64 = trials.iter().filter_map(|trial| quantile(trial, share)).sum();
        [share * 100.0, sum / trials.len() as f64 * 100.0]
    };
    (0..=STEPS).map(|step| at(f64::from(step) / f64::from(STEPS))).collect()
}

/// The share of the whole up to each of ascending values, from 0 to 1.
fn cumulated(values: Vec<f64>) -> Vec<f64> {
    let whole: f64 = values.iter().sum();
    let mut sum = 0.0;
    let shares = values.into_iter().map(|value| {
        sum += value;
        sum / whole
    });
    std::iter::once(0.0).chain(shares).collect()
}

fn sorted(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lorenz_curve_of_one_owner_is_flat_up_to_the_owner() {
        assert_eq!(cumulated(vec![0.0, 0.0, 0.0, 8.0]), [0.0, 0.0, 0.0, 0.0, 1.0]);
        assert_eq!(cumulated(vec![2.0, 2.0]), [0.0, 0.5, 1.0]);
    }
}
