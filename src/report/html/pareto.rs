//! Settings in the plane of two figures.

use plotly::Scatter;
use plotly::common::{Font, HoverInfo, Marker, Mode, Position};
use plotly::layout::{Axis, AxisRange, HoverMode};

use super::chart::{chart, escaped, shown};
use super::figure::{Figure, Panel};
use super::settings::{better, capital, error_bars, near, with_unit};
use super::table::{Cell, DataTable};
use crate::metrics::Estimate;
use crate::metrics::comparison::{Comparison, ParetoPoint, apart};
use crate::metrics::figures;
use crate::report::comparison::label;
use crate::report::number;

const FRONT: &str = "#d55e00";
const BEATEN: &str = "#8a8a8a";
/// Height of the plane, in CSS pixels.
const PLANE: u32 = 440;
/// The plane on a telephone, in CSS pixels. Wider ones only take points further apart, and with them their labels.
const NARROW: [f64; 2] = [270.0, 330.0];
/// Of a label: width of a character and height, in CSS pixels.
const LETTER: [f64; 2] = [7.0, 18.0];
/// How far a label above its point reaches below it, and the other way round, CSS pixels.
const TIPS: f64 = 4.0;
/// Labels of points further right than this share of the plane reach to the left.
const LEFT_FROM: f64 = 2.0 / 3.0;
/// Longest name that stands beside its point.
const LONGEST: usize = 12;

/// Settings in the plane of two figures.
pub fn plane(comparison: &Comparison) -> Option<Figure> {
    let pareto = comparison.pareto.as_ref().filter(|pareto| !pareto.points.is_empty())?;
    let (x, y) = (comparison.figure(&pareto.x)?, comparison.figure(&pareto.y)?);
    let points = &pareto.points;
    let estimates = [x, y].map(|figure| {
        let of = |point: &ParetoPoint| {
            let setting = comparison.setting(&point.setting)?;
            Some(setting.figure(&figure.key)?.estimate)
        };
        points
            .iter()
            .map(|point| of(point).unwrap_or_default())
            .collect::<Vec<_>>()
    });
    let ranges = [0, 1].map(|axis| range(&estimates[axis]));
    let drawn = |figure: &figures::Figure, [low, high]: [f64; 2]| -> Axis {
        near(&with_unit(figure)).range(AxisRange::new(shown(low), shown(high)))
    };
    let mut plot = chart(drawn(x, ranges[0]), drawn(y, ranges[1]), HoverMode::Closest);
    let layout = plot.layout().clone().show_legend(true);
    plot.set_layout(layout);
    let name = |place: usize| label(comparison, &points[place].setting);
    for (on_front, kind, colour) in [(true, "beaten by none", FRONT), (false, "beaten by another", BEATEN)] {
        let places: Vec<usize> = (0..points.len())
            .filter(|&place| points[place].on_front == on_front)
            .collect();
        let whiskers = |axis: usize| {
            let chosen: Vec<Estimate> = places.iter().map(|&place| estimates[axis][place]).collect();
            error_bars(&chosen).color(colour)
        };
        let marks = Scatter::new(
            places.iter().map(|&place| shown(points[place].x)).collect(),
            places.iter().map(|&place| shown(points[place].y)).collect(),
        )
        .name(kind)
        .mode(Mode::Markers)
        .hover_text_array(places.iter().map(|&place| escaped(name(place))).collect())
        .marker(Marker::new().color(colour).size(8))
        .error_x(whiskers(0))
        .error_y(whiskers(1))
        .hover_template("%{hovertext}: %{x:.5g}, %{y:.5g}<extra></extra>");
        if !places.is_empty() {
            plot.add_trace(marks);
        }
    }
    let spots: Vec<[f64; 2]> = points
        .iter()
        .map(|point| {
            let share = |axis: usize, value: f64| (value - ranges[axis][0]) / (ranges[axis][1] - ranges[axis][0]);
            [NARROW[0] * share(0, point.x), NARROW[1] * (1.0 - share(1, point.y))]
        })
        .collect();
    let names: Vec<&str> = (0..points.len()).map(name).collect();
    let (labels, key) = labels(&spots, &names);
    plot.add_trace(texts(&labels, points));
    // How far points are from the first.
    let off = |point: &ParetoPoint| [apart(point.x, points[0].x), apart(point.y, points[0].y)];
    let offsets: Vec<f64> = points.iter().flat_map(off).collect();
    let mut table = DataTable::new(&["number", "setting", &with_unit(x), &with_unit(y), "beaten by"]);
    table.rows.extend(points.iter().enumerate().map(|(place, point)| {
        vec![
            Cell::Count(place as u64 + 1),
            name(place).into(),
            point.x.into(),
            point.y.into(),
            if point.on_front { "none" } else { "another" }.into(),
        ]
    }));
    Some(Figure {
        id: "pareto".into(),
        title: format!("{} and {}", capital(&x.name), y.name).into(),
        caption: format!(
            "Settings by both figures ({}: {}; {}: {}), with 95 % intervals. Orange are those that no other beats in both, by their point estimates.{}",
            x.name,
            better(x),
            y.name,
            better(y),
            if key.is_empty() {
                ""
            } else {
                " Numbers are those of the list; points too close for a number each share one label."
            }
        ),
        panels: vec![Panel::of_height("", plot, PLANE).unless_one(offsets, |_| {
            let [x, y] = [points[0].x, points[0].y].map(number::figure);
            format!("Both are the same in every setting: {x} and {y}.")
        })],
        key,
        table,
    })
}

/// The part of an axis that holds all intervals, with some room for labels.
fn range(estimates: &[Estimate]) -> [f64; 2] {
    let ends = estimates.iter().flat_map(|estimate| {
        let [low, high] = estimate.ci95;
        [estimate.value, low, high].into_iter().flatten()
    });
    let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), end| {
        (low.min(end), high.max(end))
    });
    let margin = if high > low {
        0.1 * (high - low)
    } else {
        0.5 * high.abs().max(1e-9)
    };
    [low - margin, high + margin]
}

/// A label of the points that it stands for.
struct Label {
    /// Places of its points; it stands at the first.
    points: Vec<usize>,
    text: String,
    /// Whether it reaches to the left of its point, away from the right edge.
    left: bool,
    /// Whether it stands below its point.
    below: bool,
}

/// Labels that do not overlap, and the names of the numbers in them: names where each has room, else numbers, those of neighbours together.
fn labels(spots: &[[f64; 2]], names: &[&str]) -> (Vec<Label>, Vec<String>) {
    let groups: Vec<Vec<usize>> = (0..names.len()).map(|place| vec![place]).collect();
    if names.iter().all(|name| name.chars().count() <= LONGEST)
        && let Ok(named) = placed(spots, &groups, |points| escaped(names[points[0]]))
    {
        return (named, Vec::new());
    }
    let mut groups = groups;
    loop {
        match placed(spots, &groups, numbers) {
            Ok(labels) => return (labels, names.iter().map(|&name| name.to_owned()).collect()),
            Err([first, other]) => {
                let other = groups.remove(other);
                groups[first].extend(other);
                groups[first].sort_unstable();
            }
        }
    }
}

/// A label for each group of points, above or below its first.
///
/// # Errors
/// Two groups, the first before the second, that leave no room for each other.
fn placed(
    spots: &[[f64; 2]],
    groups: &[Vec<usize>],
    text: impl Fn(&[usize]) -> String,
) -> Result<Vec<Label>, [usize; 2]> {
    let mut labels: Vec<Label> = Vec::new();
    for (place, points) in groups.iter().enumerate() {
        let mut clash = None;
        for below in [false, true] {
            let label = Label {
                points: points.clone(),
                text: text(points),
                left: spots[points[0]][0] > LEFT_FROM * NARROW[0],
                below,
            };
            let extent = extent(&label, spots);
            let inside = extent[2] >= 0.0 && extent[3] <= NARROW[1];
            let other = labels
                .iter()
                .position(|other| overlap(self::extent(other, spots), extent));
            match other {
                None if inside || !below => {
                    labels.push(label);
                    clash = None;
                    break;
                }
                other => clash = clash.or(other),
            }
        }
        if let Some(other) = clash {
            return Err([other, place]);
        }
    }
    Ok(labels)
}

/// `1–3, 7` of the places 0, 1, 2 and 6; of many, how many they are.
fn numbers(places: &[usize]) -> String {
    let mut sorted = places.to_vec();
    sorted.sort_unstable();
    let runs = sorted.chunk_by(|a, b| a + 1 == *b);
    let words: Vec<String> = runs
        .map(|run| match run {
            [one] => (one + 1).to_string(),
            [one, other] => format!("{}, {}", one + 1, other + 1),
            _ => format!("{}–{}", run[0] + 1, run[run.len() - 1] + 1),
        })
        .collect();
    let words = words.join(", ");
    if words.chars().count() > LONGEST {
        format!("{} settings", places.len())
    } else {
        words
    }
}

/// Left, right, top and bottom of a label.
fn extent(label: &Label, spots: &[[f64; 2]]) -> [f64; 4] {
    let [x, y] = spots[label.points[0]];
    let width = LETTER[0] * label.text.chars().count() as f64 + 4.0;
    let left = if label.left { x - width } else { x };
    // The tips of letters reach beyond the point.
    let top = if label.below { y - TIPS } else { y + TIPS - LETTER[1] };
    [left, left + width, top, top + LETTER[1]]
}

fn overlap(a: [f64; 4], b: [f64; 4]) -> bool {
    a[0] < b[1] && b[0] < a[1] && a[2] < b[3] && b[2] < a[3]
}

fn texts(labels: &[Label], points: &[ParetoPoint]) -> Box<Scatter<f64, f64>> {
    let at = |label: &Label| &points[label.points[0]];
    let position = |label: &Label| match (label.below, label.left) {
        (false, false) => Position::TopRight,
        (false, true) => Position::TopLeft,
        (true, false) => Position::BottomRight,
        (true, true) => Position::BottomLeft,
    };
    Scatter::new(
        labels.iter().map(|label| shown(at(label).x)).collect(),
        labels.iter().map(|label| shown(at(label).y)).collect(),
    )
    .mode(Mode::Text)
    .text_array(labels.iter().map(|label| label.text.clone()).collect::<Vec<_>>())
    .text_position_array(labels.iter().map(position).collect())
    .text_font(Font::new().size(11))
    .clip_on_axis(false)
    .hover_info(HoverInfo::Skip)
    .show_legend(false)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn labels_of_settings_anywhere_do_not_overlap(
            spots in prop::collection::vec((0.0..270.0_f64, 0.0..330.0_f64), 1..50),
            crowded in 0.0..1.0_f64,
            letters in 1..40_usize,
        ) {
            let spots: Vec<[f64; 2]> = spots.iter().map(|(x, y)| [crowded * x, crowded * y]).collect();
            let names: Vec<String> = (0..spots.len()).map(|place| format!("{place}{}", "m".repeat(letters))).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            check(&spots, &names);
        }
    }

    fn check(spots: &[[f64; 2]], names: &[&str]) -> usize {
        let (labels, key) = labels(spots, names);
        let mut held: Vec<usize> = labels.iter().flat_map(|label| label.points.clone()).collect();
        held.sort_unstable();
        assert_eq!(held, (0..spots.len()).collect::<Vec<_>>(), "every point has a label");
        assert!(key.is_empty() || key == names);
        // Also on wider screens, where points are further apart and labels are not.
        for factor in [1.0, 1.3, 2.2, 4.0] {
            let wide: Vec<[f64; 2]> = spots.iter().map(|[x, y]| [x * factor, *y]).collect();
            for (a, label) in labels.iter().enumerate() {
                let clash = labels[a + 1..]
                    .iter()
                    .find(|other| overlap(extent(label, &wide), extent(other, &wide)));
                assert!(
                    clash.is_none(),
                    "{} and {} at {factor}",
                    label.text,
                    clash.unwrap().text
                );
            }
        }
        labels.len()
    }

    #[test]
    fn labels_of_forty_settings_do_not_overlap_at_any_width_and_leave_none_out() {
        let names: Vec<String> = (0..40).map(|place| format!("setting {place}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let spread: Vec<[f64; 2]> = (0..40)
            .map(|i| [f64::from(i * 97 % 270), f64::from(i * 61 % 330)])
            .collect();
        assert!(check(&spread, &names) > 15);
        let crowded: Vec<[f64; 2]> = (0..40)
            .map(|i| [130.0 + f64::from(i % 7), 100.0 + f64::from(i % 5)])
            .collect();
        assert!(check(&crowded, &names) <= 2);
        let curve: Vec<[f64; 2]> = (0..40)
            .map(|i| [f64::from(i * i) / 6.0, 330.0 - f64::from(i) * 8.0])
            .collect();
        check(&curve, &names);
    }

    #[test]
    fn a_few_short_names_stand_beside_their_points() {
        let (labels, key) = labels(
            &[[20.0, 20.0], [140.0, 200.0], [250.0, 300.0]],
            &["0.1 s", "0.5 s", "2 s"],
        );
        let texts: Vec<&str> = labels.iter().map(|label| label.text.as_str()).collect();
        assert_eq!((texts, key.len()), (vec!["0.1 s", "0.5 s", "2 s"], 0));
    }

    #[test]
    fn numbers_of_neighbours_are_written_as_runs() {
        assert_eq!(numbers(&[6, 0, 2, 1]), "1–3, 7");
        assert_eq!(numbers(&[1, 0]), "1, 2");
        assert_eq!(numbers(&[0, 2, 4, 6, 8, 10, 12]), "7 settings");
    }
}
