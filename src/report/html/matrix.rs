//! Tables drawn as colours: settings by settings, levels by levels.

use plotly::common::{ColorBar, ColorScale, ColorScaleElement, Font, HoverInfo, Mode, ThicknessMode, Title};
use plotly::layout::HoverMode;
use plotly::{HeatMap, Plot, Scatter};

use super::chart::{TOOLS, chart, escaped, shown};
use super::figure::{Panel, row_height};
use super::names::Names;
use super::verdict::{BETTER, UNCLEAR, WORSE, words};
use crate::metrics::comparison::{Comparison, Pair, Verdict};
use crate::metrics::figures::Better;
use crate::report::comparison::{fitted, label};

/// Columns of which a telephone shows a number each.
const MOST_NUMBERS: usize = 5;
/// Height that names below and a legend above take, CSS pixels.
const AROUND: u32 = 140 + TOOLS;

/// Every setting less every other in one figure, coloured by verdict.
pub fn pairs(comparison: &Comparison, pairs: &[&Pair]) -> Panel {
    let labels = || comparison.settings.iter().map(|setting| setting.label.as_str());
    let numbered: Vec<String> = (1..=comparison.settings.len())
        .map(|number| number.to_string())
        .collect();
    let rows = Names::of(
        labels()
            .zip(&numbered)
            .map(|(label, number)| format!("{label} · {number}"))
            .collect::<Vec<_>>()
            .iter()
            .map(String::as_str),
    );
    let columns = Names::of(numbered.iter().map(String::as_str));
    let largest = pairs
        .iter()
        .filter_map(|pair| pair.difference.value)
        .map(f64::abs)
        .fold(f64::MIN_POSITIVE, f64::max);
    let place = |name: &str| comparison.settings.iter().position(|setting| setting.name == name);
    let size = comparison.settings.len();
    let mut z = vec![vec![None; size]; size];
    let mut text = vec![vec![String::new(); size]; size];
    for pair in pairs {
        let (Some(row), Some(column)) = (place(&pair.setting), place(&pair.against)) else {
            continue;
        };
        let share = pair.difference.value.unwrap_or_default().abs() / largest;
        // 0 to 1 worse, 1 to 2 unclear, 2 to 3 better; more than a trace of colour where it is small.
        let shade = |base: f64| base + 0.15 + 0.8 * share;
        for (at, verdict, sign) in [
            ((row, column), pair.verdict, 1.0),
            ((column, row), turned(pair.verdict), -1.0),
        ] {
            z[at.0][at.1] = Some(shown(match verdict {
                Verdict::Worse => shade(0.0),
                Verdict::Better => shade(2.0),
                _ => shade(1.0),
            }));
            let mut difference = pair.difference;
            if sign < 0.0 {
                let [low, high] = difference.ci95;
                difference.value = difference.value.map(|value| -value);
                difference.ci95 = [high.map(|end| -end), low.map(|end| -end)];
            }
            let [one, other] = [at.0, at.1].map(|place| label(comparison, &comparison.settings[place].name));
            text[at.0][at.1] = format!(
                "{} less {}: {}, {}",
                escaped(one),
                escaped(other),
                fitted(&difference),
                words(verdict)
            );
        }
    }
    let steps = [
        (0.0, "#ffffff"),
        (0.333, WORSE),
        (0.3331, "#ffffff"),
        (0.666, UNCLEAR),
        (0.6661, "#ffffff"),
        (1.0, BETTER),
    ];
    let scale = steps.map(|(at, colour)| ColorScaleElement(at, colour.to_owned()));
    let map = HeatMap::new(columns.all(), rows.all(), z)
        .color_scale(ColorScale::Vector(scale.into()))
        .zmin(0.0)
        .zmax(3.0)
        .show_scale(false)
        .hover_on_gaps(false)
        .hover_text_matrix(text)
        .hover_info(HoverInfo::Text);
    let mut plot = chart(columns.across("less setting number"), rows.down(), HoverMode::Closest);
    plot.add_trace(map);
    Panel::of_height("", plot, AROUND + row_height(size).min(30) * size as u32)
}

fn turned(verdict: Verdict) -> Verdict {
    match verdict {
        Verdict::Better => Verdict::Worse,
        Verdict::Worse => Verdict::Better,
        other => other,
    }
}

/// What levels of one factor have in those of another.
pub struct Levels<'a> {
    /// Names of both factors, the one across first.
    pub factors: [&'a str; 2],
    /// Labels of both factors' levels.
    pub labels: [&'a [String]; 2],
    /// The value in each, row by row, where there is one.
    pub values: &'a [Vec<Option<f64>>],
}

/// A figure's value by the levels of two factors, from pale to dark the better way.
pub fn levels(table: &Levels, title: &str, better: Better, write: impl Fn(f64) -> String) -> Panel {
    let [across, down] = table.labels.map(|levels| Names::of(levels.iter().map(String::as_str)));
    let value = |value: &Option<f64>| value.map(shown);
    let z: Vec<Vec<Option<f64>>> = table.values.iter().map(|row| row.iter().map(value).collect()).collect();
    let text: Vec<Vec<String>> = table
        .values
        .iter()
        .enumerate()
        .map(|(row, values)| {
            let of = |(column, value): (usize, &Option<f64>)| {
                format!(
                    "{} {}, {} {}: {}",
                    escaped(table.factors[0]),
                    escaped(&table.labels[0][column]),
                    escaped(table.factors[1]),
                    escaped(&table.labels[1][row]),
                    value.map_or("no value".to_owned(), &write)
                )
            };
            values.iter().enumerate().map(of).collect()
        })
        .collect();
    // Pale enough for black numbers.
    let stops = [(0.0, "#ffffff"), (0.5, "#c6dbef"), (1.0, "#6baed6")];
    let scale = stops.map(|(at, colour)| ColorScaleElement(at, colour.to_owned()));
    let bar = ColorBar::new()
        .title(Title::with_text(""))
        .thickness_mode(ThicknessMode::Pixels)
        .thickness(10)
        .outline_width(0);
    let map = HeatMap::new(across.all(), down.all(), z)
        .color_scale(ColorScale::Vector(scale.into()))
        .reverse_scale(better == Better::Lower)
        .color_bar(bar)
        .hover_on_gaps(false)
        .hover_text_matrix(text)
        .hover_info(HoverInfo::Text);
    let mut plot = chart(across.across(table.factors[0]), down.down(), HoverMode::Closest);
    plot.add_trace(map);
    if table.labels[0].len() <= MOST_NUMBERS {
        numbers(&mut plot, table, [&across, &down], write);
    }
    Panel::of_height(
        title.to_owned(),
        plot,
        AROUND + row_height(table.labels[1].len()) * table.labels[1].len() as u32,
    )
}

/// The values in the middle of their cells.
fn numbers(plot: &mut Plot, table: &Levels, [across, down]: [&Names; 2], write: impl Fn(f64) -> String) {
    let (mut x, mut y, mut text) = (Vec::new(), Vec::new(), Vec::new());
    for (row, values) in table.values.iter().enumerate() {
        for (column, value) in values.iter().enumerate() {
            let Some(value) = value else { continue };
            x.push(across.at(column));
            y.push(down.at(row));
            text.push(write(*value));
        }
    }
    let words = Scatter::new(x, y)
        .mode(Mode::Text)
        .text_array(text)
        .text_font(Font::new().size(11).color("#000000"))
        .hover_info(HoverInfo::Skip)
        .show_legend(false);
    plot.add_trace(words);
}
