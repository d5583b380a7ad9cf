//! What is expected of a scenario, before it is run.

use super::grid::{Column, Grid};
use super::layout::Page;
use super::number::{figure, percent, seconds};
use crate::predict::{Holds, Prediction, Preflight};
use crate::text::Style;

/// A time beyond which its length no longer matters, seconds: a year.
const LONG: f64 = 365.25 * 86_400.0;

/// The expectations as text; `question` is the scenario's.
#[must_use]
pub fn preflight(preflight: &Preflight, question: Option<&str>, style: Style) -> String {
    let mut page = Page::new(style);
    page.title(&preflight.scenario, question);
    for (holds, heading) in [
        (Holds::Throughout, "Expected throughout a run"),
        (Holds::AtStart, "Expected at the start of a run"),
        (Holds::InRange, "Expected of robots that stay in range of each other"),
        (Holds::AtEnd, "Expected of the formation at the end"),
    ] {
        let of_these = || {
            preflight
                .predictions
                .iter()
                .filter(|prediction| prediction.holds == holds)
        };
        if of_these().next().is_some() {
            page.heading(heading);
            page.table(&table(of_these()));
        }
    }
    if !preflight.not_predicted.is_empty() {
        page.heading("Not predicted");
        for unpredicted in &preflight.not_predicted {
            page.item(&format!("{}: {}", unpredicted.what, unpredicted.why));
        }
    }
    page.text()
}

fn table<'a>(predictions: impl Iterator<Item = &'a Prediction>) -> Grid {
    let columns = [Column::Words, Column::Figures, Column::Figures, Column::Words];
    let mut table = Grid::new(&columns, ["", "value", "within", "rests on"]);
    for prediction in predictions {
        let within = if prediction.accuracy > 0.0 {
            percent(prediction.accuracy / prediction.value.abs())
        } else {
            "exact".to_owned()
        };
        let basis = format!("{}\n{}", prediction.formula, prediction.assumes);
        table.row([prediction.what.to_owned(), value(prediction), within, basis]);
    }
    table
}

fn value(prediction: &Prediction) -> String {
    in_unit(prediction.value, prediction.unit)
}

/// A figure in its unit as people read it.
pub fn in_unit(value: f64, unit: &str) -> String {
    match unit {
        "1" => percent(value),
        "s" if value > LONG => "over a year".to_owned(),
        "s" => seconds(value),
        _ => format!("{} {unit}", figure(value)),
    }
}
