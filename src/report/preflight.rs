//! What is expected of a scenario, before it is run.

use comfy_table::{CellAlignment, ColumnConstraint, ContentArrangement, Table, Width};

use super::layout::{Page, RULED, WIDTH};
use super::number::{figure, percent, seconds};
use crate::predict::{Holds, Prediction, Preflight};

/// Columns of what is expected, by how much it may be off, and what it rests on.
const WIDTHS: [u16; 4] = [20, 18, 9, 33];

/// A time beyond which its length no longer matters, seconds: a year.
const LONG: f64 = 365.25 * 86_400.0;

/// The expectations as text, at most 80 columns wide; `question` is the scenario's.
#[must_use]
pub fn preflight(preflight: &Preflight, question: Option<&str>, colour: bool) -> String {
    let mut page = Page {
        text: String::new(),
        colour,
    };
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
            page.line(&table(of_these()));
        }
    }
    if !preflight.not_predicted.is_empty() {
        page.heading("Not predicted");
        for unpredicted in &preflight.not_predicted {
            page.item(&format!("{}: {}", unpredicted.what, unpredicted.why));
        }
    }
    page.text
}

fn table<'a>(predictions: impl Iterator<Item = &'a Prediction>) -> String {
    let mut table = Table::new();
    table.load_style(RULED).set_header(["", "value", "within", "rests on"]);
    table
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_width(WIDTH as u16);
    for prediction in predictions {
        let within = if prediction.accuracy > 0.0 {
            percent(prediction.accuracy / prediction.value.abs())
        } else {
            "exact".to_owned()
        };
        let basis = format!("{}\n{}", prediction.formula, prediction.assumes);
        table.add_row([prediction.what.to_owned(), value(prediction), within, basis]);
    }
    for (index, column) in table.column_iter_mut().enumerate() {
        column.set_padding((if index == 0 { 0 } else { 2 }, 0));
        column.set_constraint(ColumnConstraint::Absolute(Width::Fixed(WIDTHS[index])));
        column.set_cell_alignment(if index == 1 || index == 2 {
            CellAlignment::Right
        } else {
            CellAlignment::Left
        });
    }
    table.trim_fmt()
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
