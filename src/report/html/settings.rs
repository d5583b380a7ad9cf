//! Settings held against each other: every figure by setting, and how settings differ in it.

use plotly::Scatter;
use plotly::common::{ErrorData, ErrorType, Marker, Mode};
use plotly::layout::{Axis, HoverMode, RangeMode};

use super::chart::{INK, axis, chart, escaped, one_value, shown};
use super::figure::{Figure, Panel};
use super::matrix;
use super::names::Names;
use super::table::{Cell, DataTable};
use super::verdict::{colour, words};
use crate::metrics::Estimate;
use crate::metrics::comparison::{Comparison, Pair};
use crate::metrics::figures::{self, Better};
use crate::report::comparison::{family, label};
use crate::report::number;

const NEUTRAL: &str = "#0072b2";

/// Differences between settings, pair by pair, of which more than this are drawn as a table of all settings by all.
const MOST_PAIRS: usize = 15;

/// A named estimate on its line.
pub struct Row {
    /// What it is of.
    pub name: String,
    /// The estimate.
    pub estimate: Estimate,
    /// Its colour.
    pub colour: &'static str,
}

/// A figure's value in every setting.
pub fn by_setting(comparison: &Comparison, figure: &figures::Figure) -> Option<Figure> {
    let estimated = comparison.settings.iter().map(|setting| {
        let estimate = setting.figure(&figure.key).map(|figure| figure.estimate);
        (setting, estimate.unwrap_or_default())
    });
    let estimated: Vec<_> = estimated.collect();
    estimated.iter().find(|(_, estimate)| estimate.value.is_some())?;
    let mut table = DataTable::new(&["setting", "trials", &with_unit(figure), "low", "high"]);
    table.rows.extend(estimated.iter().map(|(setting, estimate)| {
        let mut row: Vec<Cell> = vec![setting.label.as_str().into(), setting.trials.into()];
        row.extend(cells(estimate));
        row
    }));
    let rows = estimated.iter().map(|(setting, estimate)| Row {
        name: setting.label.clone(),
        estimate: *estimate,
        colour: NEUTRAL,
    });
    let caption = format!(
        "{}; {}. The {} with its 95 % interval.",
        capital(&figure.name),
        better(figure),
        match (figure.is_ratio, cut_off(comparison, figure)) {
            (true, _) => "ratio of sums over trials",
            (false, true) => "mean over trials, restricted to the time limit where trials were cut off,",
            (false, false) => "mean over trials",
        }
    );
    Some(Figure {
        id: format!("by-setting-{}", slug(&figure.key)).into(),
        title: format!("{} by setting", capital(&figure.name)).into(),
        caption,
        panels: vec![forest(&rows.collect::<Vec<_>>(), near(&with_unit(figure)), |value| {
            format!("{} is the same in every setting: {value}.", capital(&with_unit(figure)))
        })],
        key: Vec::new(),
        table,
    })
}

/// How settings differ in a figure.
pub fn differences(comparison: &Comparison, figure: &figures::Figure) -> Option<Figure> {
    let pairs: Vec<&Pair> = comparison
        .pairs_in(&figure.key)
        .filter(|pair| pair.difference.value.is_some())
        .collect();
    pairs.first()?;
    let mut table = DataTable::new(&[
        "setting",
        "against",
        "pairs or trials",
        &format!("difference, {}", unit(figure)),
        "low",
        "high",
        "relative, %",
        "Cliff's δ",
        "p",
        "p adjusted",
        "verdict",
        "variance, paired",
        "variance, independent seeds",
        "gain by common random numbers",
    ]);
    table.rows.extend(pairs.iter().map(|pair| row(comparison, pair)));
    let of = match &comparison.reference {
        Some(reference) => format!("Each setting less {}", label(comparison, reference)),
        None => "Settings less each other".to_owned(),
    };
    let judged = format!(
        "Green is better, orange worse, at 5 %, {}; grey shows no difference, which does not mean that there is none.",
        family(comparison)
    );
    let (caption, panel) = if comparison.reference.is_none() && pairs.len() > MOST_PAIRS {
        let caption = format!(
            "The setting of each row less that of each column, in shares of the largest difference: the darker, the larger. {judged}"
        );
        let differences = pairs.iter().filter_map(|pair| pair.difference.value);
        let panel = matrix::pairs(comparison, &pairs).unless_one(differences, |value| {
            format!("Every difference is {}.", number::figure(value))
        });
        (caption, panel)
    } else {
        let rows = pairs.iter().map(|pair| Row {
            name: match comparison.reference {
                Some(_) => label(comparison, &pair.setting).to_owned(),
                None => format!(
                    "{} less {}",
                    label(comparison, &pair.setting),
                    label(comparison, &pair.against)
                ),
            },
            estimate: pair.difference,
            colour: colour(pair.verdict),
        });
        let caption = format!("{of}, with the 95 % interval of the difference. {judged}");
        let panel = forest(&rows.collect::<Vec<_>>(), difference_axis(figure), |value| {
            format!("Every difference is {value}.")
        });
        (caption, panel)
    };
    Some(Figure {
        id: format!("differences-{}", slug(&figure.key)).into(),
        title: format!("Differences in {}", figure.name).into(),
        caption,
        panels: vec![panel],
        key: Vec::new(),
        table,
    })
}

/// An axis of differences in a figure, with its zero.
pub fn difference_axis(figure: &figures::Figure) -> Axis {
    near(&format!("difference, {}", unit(figure)))
        .zero_line(true)
        .zero_line_color(INK)
}

fn row(comparison: &Comparison, pair: &Pair) -> Vec<Cell> {
    let mut row: Vec<Cell> = vec![
        label(comparison, &pair.setting).into(),
        label(comparison, &pair.against).into(),
        pair.difference.n.into(),
    ];
    row.extend(cells(&pair.difference));
    row.extend([
        pair.relative.map(|share| share * 100.0).into(),
        pair.cliffs_delta.value.into(),
        pair.p.into(),
        pair.p_adjusted.into(),
        words(pair.verdict).into(),
    ]);
    let gain = pair.gain.as_ref();
    row.extend([
        gain.map(|gain| gain.paired_variance).into(),
        gain.map(|gain| gain.independent_variance).into(),
        gain.and_then(|gain| gain.ratio).into(),
    ]);
    row
}

/// An axis that shows where the values are, zero or not: a place on it is no length.
pub(super) fn near(title: &str) -> Axis {
    axis(title).range_mode(RangeMode::Normal)
}

/// Estimates line by line, the first at the top; or, where all have one value, what `alike` says of it.
pub fn forest(rows: &[Row], x: Axis, alike: impl Fn(&str) -> String) -> Panel {
    let ends = |row: &Row| {
        let [low, high] = row.estimate.ci95;
        [row.estimate.value, low, high].into_iter().flatten()
    };
    if rows.len() > 1
        && rows.iter().all(|row| row.estimate.value.is_some())
        && let Some(value) = one_value(rows.iter().flat_map(ends))
    {
        return Panel::words("", alike(&number::figure(value)));
    }
    let names = Names::of(rows.iter().map(|row| row.name.as_str()));
    let estimates: Vec<Estimate> = rows.iter().map(|row| row.estimate).collect();
    let values = estimates
        .iter()
        .map(|estimate| shown(estimate.value.unwrap_or(f64::NAN)));
    let marks = Scatter::new(values.collect(), names.all())
        .mode(Mode::Markers)
        .marker(
            Marker::new()
                .size(9)
                .color_array(rows.iter().map(|row| row.colour).collect()),
        )
        .error_x(error_bars(&estimates))
        .hover_text_array(rows.iter().map(|row| escaped(&row.name)).collect())
        .show_legend(false)
        .hover_template("%{hovertext}: %{x:.5g}<extra></extra>");
    let mut plot = chart(x, names.down(), HoverMode::Closest);
    plot.add_trace(marks);
    Panel::of_rows("", plot, rows.len())
}

pub(super) fn error_bars(estimates: &[Estimate]) -> ErrorData {
    let arm = |end: usize| {
        let length = |estimate: &Estimate| {
            let length = estimate.ci95[end]
                .zip(estimate.value)
                .map(|(end, value)| (end - value).abs());
            shown(length.unwrap_or(0.0))
        };
        estimates.iter().map(length).collect::<Vec<f64>>()
    };
    ErrorData::new(ErrorType::Data)
        .array(arm(1))
        .array_minus(arm(0))
        .symmetric(false)
        .thickness(1.5)
        .width(4)
        .color("#6b6b6b")
}

/// The value and its interval.
pub fn cells(estimate: &Estimate) -> [Cell; 3] {
    [estimate.value.into(), estimate.ci95[0].into(), estimate.ci95[1].into()]
}

fn cut_off(comparison: &Comparison, figure: &figures::Figure) -> bool {
    comparison.settings.iter().any(|setting| {
        let survival = setting.figure(&figure.key).and_then(|figure| figure.survival.as_ref());
        survival.is_some_and(|survival| survival.censored > 0)
    })
}

pub(super) fn better(figure: &figures::Figure) -> &'static str {
    match figure.better {
        Better::Lower => "less is better",
        Better::Higher => "more is better",
    }
}

/// A figure's unit in words.
pub fn unit(figure: &figures::Figure) -> &str {
    match figure.unit.as_ref() {
        "1" => "a pure number",
        unit => unit,
    }
}

pub(super) fn with_unit(figure: &figures::Figure) -> String {
    match figure.unit.as_ref() {
        "1" => figure.name.clone(),
        unit => format!("{}, {unit}", figure.name),
    }
}

pub(super) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A figure's key as part of a link: letters, digits and dashes.
pub fn slug(key: &str) -> String {
    key.chars()
        .map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '-' })
        .collect()
}
