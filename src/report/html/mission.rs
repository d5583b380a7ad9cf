//! Times until something is done, of which some were cut off: missions, and targets that get their links back.

use plotly::Scatter;
use plotly::common::{DashType, Line, LineShape, Marker, MarkerSymbol, Mode};
use plotly::layout::{Axis, AxisRange, HoverMode, RangeMode};

use super::PageInput;
use super::chart::{Points, axis, band, chart, line, percent_axis, shown, topic_colour};
use super::figure::{Figure, HEIGHT, Panel};
use super::marks::Marks;
use super::names::Names;
use super::table::{Cell, DataTable};
use crate::metrics::comparison::{Comparison, Setting, Survival};
use crate::metrics::figures::COMPLETION;
use crate::report::missed::{self, Asked};
use crate::report::number;
use crate::statistics::{Observation, Step, survival_curve};

const COLOUR: &str = "#0072b2";
/// More curves than this are drawn without their bands, which would cover each other.
const MOST_BANDS: usize = 4;
/// Steps of a curve, and marks on it, at most: more would only make the page long.
const MOST_STEPS: usize = 1_000;
/// Curves that colours alone tell apart.
const DISTINCT: usize = 7;

/// When missions were complete.
pub fn completion(input: &PageInput) -> Option<Figure> {
    let observations = input.trials.values(COMPLETION);
    observations.first()?;
    let summary = input.summary;
    let median = number::estimate(&summary.steps_to_completion.median, number::figure);
    let cut_off = observations.iter().filter(|observation| !observation.happened).count() as u64;
    let caption = format!(
        "The share of missions complete by each control step of {} s, after Kaplan and Meier: {} of {} trials completed; half are done after \
         {median} control steps. {}{}{}",
        input.scenario.control.period.get(),
        number::count(summary.completed),
        number::count(observations.len() as u64),
        band_words(observations.len()),
        match cut_off {
            0 => String::new(),
            1 => " The trial that the time limit cut off counts as not yet complete, marked by a tick.".to_owned(),
            many => format!(
                " The {} trials that the time limit cut off count as not yet complete, each marked by a tick.",
                number::count(many)
            ),
        },
        why_missed(input)
    );
    let marks = Marks::of(input).in_steps(input.scenario.control.period.get());
    let caption = caption + marks.words();
    let axis = "control steps";
    Some(curve(
        "completion",
        "Time to completion",
        caption,
        &observations,
        axis,
        "missions complete",
        &marks,
    ))
}

/// Which targets failed trials missed, and why.
fn why_missed(input: &PageInput) -> String {
    let sentences = missed::sentences(input.summary, Asked::of(input.scenario).as_ref());
    let said = sentences.iter().map(|sentence| format!(" {}.", capitalised(sentence)));
    said.collect()
}

fn capitalised(sentence: &str) -> String {
    let mut letters = sentence.chars();
    let first = letters.next().map(|letter| letter.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

/// When targets had their links again after a failure.
pub fn healing(input: &PageInput) -> Option<Figure> {
    let observations: Vec<Observation> = input.trials.times("healing.unmended_s").iter().collect();
    observations.first()?;
    let total = &input.summary.healing.as_ref()?.total;
    let cut_off = if total.healed < total.failures {
        " Failures whose trial ended first are cut off, each marked by a tick."
    } else {
        ""
    };
    let caption = format!(
        "The share of failures mended by each time since the failure, of those that cost a target a link or its worker, after Kaplan and Meier: \
         {} of {} were mended, half within {}. {} It takes failures as independent, also those of one trial.{cut_off}",
        number::count(total.healed),
        number::count(total.failures),
        number::estimate(&total.time.median, number::seconds),
        band_words(observations.len())
    );
    Some(curve(
        "healing",
        "Time to heal",
        caption,
        &observations,
        "time since the failure, s",
        "failures mended",
        // Failures are where this time begins.
        &Marks::default(),
    ))
}

/// When the trials of each setting were done.
pub fn by_setting(comparison: &Comparison) -> Option<Figure> {
    let of = |setting: &'_ Setting| {
        let survival = setting
            .figures
            .0
            .iter()
            .find_map(|(_, figure)| figure.survival.clone())?;
        (!survival.curve.is_empty()).then(|| (setting.label.clone(), survival))
    };
    let curves: Vec<(String, Survival)> = comparison.settings.iter().filter_map(of).collect();
    curves.first()?;
    let mut table = DataTable::new(&["setting", "control steps", "complete, %", "low, %", "high, %"]);
    let mut steps: Vec<Step> = curves.iter().flat_map(|(_, survival)| survival.curve.clone()).collect();
    steps.sort_by(|a, b| a.time.total_cmp(&b.time));
    let end = steps.last().map_or(0.0, |last| last.time);
    let across = from_where_it_begins(axis("control steps"), &steps, end);
    let mut plot = chart(across, percent_axis("trials complete"), HoverMode::Closest);
    let layout = plot.layout().clone().show_legend(true);
    plot.set_layout(layout);
    let names = Names::of(curves.iter().map(|(name, _)| name.as_str()));
    for (place, (name, survival)) in curves.iter().enumerate() {
        let shown_as = names.at(place);
        for step in &survival.curve {
            let [low, high] = step.band;
            let shares = [step.time, done(step.survival), done(high), done(low)].map(Cell::from);
            table
                .rows
                .push(std::iter::once(name.as_str().into()).chain(shares).collect());
        }
        let points = |share: fn(&Step) -> f64| -> Points {
            let jumps = survival.curve.iter().map(|step| [step.time, done(share(step))]);
            std::iter::once([0.0, 0.0]).chain(jumps).collect()
        };
        let colour = topic_colour(place);
        if curves.len() <= MOST_BANDS {
            let [high, low] = [points(|step| step.band[1]), points(|step| step.band[0])];
            for edge in band(name, colour, &high, &low, &LineShape::Hv) {
                plot.add_trace(edge.name(&shown_as).legend_group(&shown_as));
            }
        }
        let hover = "%{y:.1f} % by %{x:.5g}<extra>%{fullData.name}</extra>";
        let curve = line(name, colour, &points(|step| step.survival), LineShape::Hv, hover);
        let curve = curve.name(&shown_as).legend_group(&shown_as);
        plot.add_trace(if place < DISTINCT {
            curve
        } else {
            let style = Line::new().color(colour).width(2.0).shape(LineShape::Hv);
            curve.line(style.dash(if place < 2 * DISTINCT {
                DashType::Dash
            } else {
                DashType::Dot
            }))
        });
    }
    Some(Figure {
        id: "completion-by-setting".into(),
        title: "Time to completion by setting".into(),
        caption: format!(
            "The share of trials complete by each control step, after Kaplan and Meier.{}",
            if curves.len() <= MOST_BANDS {
                " Bands are Greenwood's of 95 %, on the log(−log) scale."
            } else {
                " Greenwood's bands of 95 % are in the table."
            }
        ),
        // On a telephone the legend has a line for each name.
        panels: vec![
            Panel::of_height("", plot, HEIGHT + 20 * curves.len().min(40) as u32).unless_one(
                curves
                    .iter()
                    .flat_map(|(_, survival)| survival.curve.iter().map(|step| step.survival)),
                |survival| format!("{} of the trials of every setting.", number::percent(1.0 - survival)),
            ),
        ],
        key: Vec::new(),
        table,
    })
}

fn band_words(observations: usize) -> &'static str {
    if observations > 1 {
        "The band is Greenwood's of 95 %, on the log(−log) scale."
    } else {
        "One observation has no band."
    }
}

fn curve(
    id: &'static str,
    title: &'static str,
    caption: String,
    observations: &[Observation],
    unit: &str,
    what: &str,
    marks: &Marks,
) -> Figure {
    let all = survival_curve(observations.iter().copied());
    let caption = if all.len() > MOST_STEPS {
        let [all, drawn] = [all.len(), MOST_STEPS].map(|steps| number::count(steps as u64));
        format!("{caption} Of the {all} steps of the curve {drawn} are drawn and listed, spread evenly.")
    } else {
        caption
    };
    let steps = few(all);
    let end = observations
        .iter()
        .map(|observation| observation.time)
        .fold(0.0, f64::max);
    let mut table = DataTable::new(&[
        unit,
        "under way just before",
        &format!("{what}, %"),
        "low, %",
        "high, %",
    ]);
    for step in &steps {
        let [low, high] = step.band;
        let mut row: Vec<Cell> = vec![step.time.into(), step.at_risk.into()];
        row.extend([done(step.survival), done(high), done(low)].map(Cell::from));
        table.rows.push(row);
    }
    let points = |share: fn(&Step) -> f64| {
        let jumps = steps.iter().map(|step| [step.time, done(share(step))]);
        let mut points: Points = std::iter::once([0.0, 0.0]).chain(jumps).collect();
        // The curve goes on to the end of the longest trial.
        points.extend(points.last().map(|last| [end, last[1]]));
        points
    };
    let across = from_where_it_begins(axis(unit), &steps, end);
    let mut plot = marks.chart(across, percent_axis(what));
    if observations.len() > 1 {
        for edge in band(
            what,
            COLOUR,
            &points(|step| step.band[1]),
            &points(|step| step.band[0]),
            &LineShape::Hv,
        ) {
            plot.add_trace(edge);
        }
    }
    let middle = points(|step| step.survival);
    plot.add_trace(
        line(
            what,
            COLOUR,
            &middle,
            LineShape::Hv,
            "%{y:.1f} % by %{x:.5g}<extra></extra>",
        )
        .show_legend(false),
    );
    let cut_off = observations.iter().filter(|observation| !observation.happened);
    let mut cut_off: Vec<f64> = cut_off.map(|observation| observation.time).collect();
    if cut_off.len() > MOST_STEPS {
        cut_off.sort_unstable_by(f64::total_cmp);
        cut_off.dedup();
    }
    let cut_off = few(cut_off);
    let at = |time: f64| {
        let before = middle.partition_point(|point| point[0] <= time);
        before.checked_sub(1).map_or(0.0, |last| middle[last][1])
    };
    let ticks: Vec<f64> = cut_off.iter().copied().map(shown).collect();
    if !ticks.is_empty() {
        let heights: Vec<f64> = ticks.iter().map(|&time| at(time)).collect();
        let marks = Scatter::new(ticks, heights)
            .name("cut off")
            .mode(Mode::Markers)
            .marker(Marker::new().symbol(MarkerSymbol::LineNSOpen).size(10).color("#b2182b"))
            .hover_template("cut off at %{x:.5g}<extra></extra>");
        plot.add_trace(marks);
    }
    Figure {
        id: id.into(),
        title: title.into(),
        caption,
        panels: vec![alike(marks.panel("", plot), observations, unit, what)],
        key: Vec::new(),
        table,
    }
}

/// At most as many as a chart shows, evenly chosen, the first and the last among them.
fn few<T: Copy>(all: Vec<T>) -> Vec<T> {
    if all.len() <= MOST_STEPS {
        return all;
    }
    let last = all.len() - 1;
    (0..MOST_STEPS)
        .map(|place| all[place * last / (MOST_STEPS - 1)])
        .collect()
}

/// The chart, unless all are done at the same time, or none is.
fn alike(panel: Panel, observations: &[Observation], unit: &str, what: &str) -> Panel {
    let times = observations.iter().map(|observation| observation.time);
    let (all, none) = (
        observations.iter().all(|observation| observation.happened),
        observations.iter().all(|observation| !observation.happened),
    );
    let number = number::count(observations.len() as u64);
    if none {
        Panel::words("", format!("0 of {number} {what}."))
    } else if all {
        panel.unless_one(times, |time| {
            format!("{number} of {number} {what}; {unit}: {}.", number::figure(time))
        })
    } else {
        panel
    }
}

/// The axis of times; where all that happened came late, it begins shortly before that.
fn from_where_it_begins(axis: Axis, steps: &[Step], end: f64) -> Axis {
    match steps.first() {
        Some(first) if first.time > 0.6 * end => {
            let margin = (end - first.time).max(0.02 * end);
            axis.range_mode(RangeMode::Normal)
                .range(AxisRange::new((first.time - margin).max(0.0), end + 0.02 * margin))
        }
        _ => axis,
    }
}

/// The share done, in percent, of the share that is not.
fn done(survival: f64) -> f64 {
    (1.0 - survival) * 100.0
}
