//! Settings in the plane of two figures.

use plotly::Scatter;
use plotly::common::{Marker, Mode};
use plotly::layout::HoverMode;

use super::chart::{chart, shown, words};
use super::figure::{Figure, Panel};
use super::settings::{better, capital, error_bars, near, with_unit};
use super::table::DataTable;
use crate::metrics::comparison::{Comparison, ParetoPoint};
use crate::metrics::figures;
use crate::report::comparison::label;

const FRONT: &str = "#d55e00";
const BEATEN: &str = "#8a8a8a";
/// Height of the plane, in CSS pixels.
const PLANE: u32 = 440;

/// Settings in the plane of two figures.
pub fn plane(comparison: &Comparison) -> Option<Figure> {
    let pareto = comparison.pareto.as_ref().filter(|pareto| !pareto.points.is_empty())?;
    let (x, y) = (comparison.figure(&pareto.x)?, comparison.figure(&pareto.y)?);
    let mut plot = chart(near(&with_unit(x)), near(&with_unit(y)), HoverMode::Closest);
    let layout = plot.layout().clone().show_legend(true);
    plot.set_layout(layout);
    for (on_front, name, colour) in [(true, "beaten by none", FRONT), (false, "beaten by another", BEATEN)] {
        let points: Vec<&ParetoPoint> = pareto
            .points
            .iter()
            .filter(|point| point.on_front == on_front)
            .collect();
        let whiskers = |figure: &figures::Figure| {
            let estimate = |point: &ParetoPoint| {
                let setting = comparison.setting(&point.setting);
                setting
                    .and_then(|setting| setting.figure(&figure.key))
                    .map(|figure| figure.estimate)
            };
            error_bars(
                &points
                    .iter()
                    .map(|point| estimate(point).unwrap_or_default())
                    .collect::<Vec<_>>(),
            )
        };
        let labels = points.iter().map(|point| words(label(comparison, &point.setting)));
        let marks = Scatter::new(
            points.iter().map(|point| shown(point.x)).collect(),
            points.iter().map(|point| shown(point.y)).collect(),
        )
        .name(name)
        .mode(Mode::Markers)
        .text_array(labels.collect())
        .marker(Marker::new().color(colour).size(8))
        .error_x(whiskers(x).color(colour))
        .error_y(whiskers(y).color(colour))
        .hover_template("%{text}: %{x:.5g}, %{y:.5g}<extra></extra>");
        if !points.is_empty() {
            plot.add_trace(marks);
        }
    }
    let mut table = DataTable::new(&["setting", &with_unit(x), &with_unit(y), "beaten by"]);
    table.rows.extend(pareto.points.iter().map(|point| {
        vec![
            label(comparison, &point.setting).into(),
            point.x.into(),
            point.y.into(),
            if point.on_front { "none" } else { "another" }.into(),
        ]
    }));
    Some(Figure {
        id: "pareto".into(),
        title: format!("{} and {}", capital(&x.name), y.name).into(),
        caption: format!(
            "Settings by both figures ({}: {}; {}: {}), with 95 % intervals. Orange are those that no other beats in both, by their point estimates.",
            x.name,
            better(x),
            y.name,
            better(y)
        ),
        panels: vec![Panel {
            title: "",
            plot,
            height: PLANE,
        }],
        table,
    })
}
