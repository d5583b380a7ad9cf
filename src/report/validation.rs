//! Oracles and what was measured of them, as a table.

use super::grid::{Column, Grid};
use super::layout::Page;
use super::number::{NOTHING, percent};
use crate::text::Style;
use crate::validate::{Judged, Validation, Verdict};

/// Digits that a number has at most, zeros at its beginning not counted.
const DIGITS: i32 = 7;

/// What was validated, as text.
#[must_use]
pub fn validation(validation: &Validation, style: Style) -> String {
    let mut page = Page::new(style);
    page.title("validation", None);
    page.gap();
    page.table(&table(&validation.rows));
    page.gap();
    for row in validation.differing() {
        page.item(&difference(row));
    }
    page.words(&conclusion(validation));
    page.words(&format!(
        "± is half of an interval, in which the form must lie, give or take its own margin. The intervals of all rows of the catalogue hold their truths together for {} of seeds; this one is {}.",
        percent(validation.level),
        validation.seed
    ));
    page.text()
}

fn table(rows: &[Judged]) -> Grid {
    let columns = [Column::Words, Column::Figures, Column::Figures, Column::Words];
    let mut table = Grid::new(&columns, ["", "form", "measured", ""]);
    let mut model = "";
    for row in rows {
        if row.model != model {
            model = row.model;
            table.row([model, "", "", ""]);
        }
        let (form, measured) = numbers(row);
        table.row([format!("  {}", row.name), form, measured, verdict(row).to_owned()]);
    }
    table
}

const fn verdict(row: &Judged) -> &'static str {
    match row.verdict {
        Verdict::Agrees => "agrees",
        Verdict::Differs => "DIFFERS",
    }
}

/// What the form gives, and what was measured with half of its interval: two digits of that count.
fn numbers(row: &Judged) -> (String, String) {
    let unit = if row.unit.is_empty() {
        ""
    } else {
        &format!(" {}", row.unit)
    };
    let (Some(value), Some([low, high])) = (row.measured, row.interval) else {
        return (fixed(row.expected, 5), NOTHING.to_owned());
    };
    let half = (high - low) / 2.0;
    let before = row.expected.abs().max(value.abs()).max(1e-9).log10().floor() as i32;
    let decimals = if half > 0.0 { 1 - half.log10().floor() as i32 } else { 2 };
    let decimals = decimals.min(DIGITS - 1 - before).clamp(0, 9) as usize;
    let measured = format!("{} ± {half:.decimals$}{unit}", fixed(value, decimals));
    (fixed(row.expected, decimals), measured)
}

fn fixed(value: f64, decimals: usize) -> String {
    format!("{value:.decimals$}").replace('-', "\u{2212}")
}

fn difference(row: &Judged) -> String {
    let (form, measured) = numbers(row);
    let margin = row
        .margin_for
        .map_or_else(String::new, |why| format!(", give or take {:.2e} ({why})", row.margin));
    format!(
        "{} differs: the form gives {form}{margin}, {} trials {measured}. {}",
        row.name, row.trials, row.form
    )
}

fn conclusion(validation: &Validation) -> String {
    let all = validation.rows.len();
    let differing: Vec<&str> = validation.differing().map(|row| row.name.as_str()).collect();
    match differing.len() {
        0 => format!("{all} of {all} agree."),
        count => format!(
            "{} of {all} agree. These differ: {}.",
            all - count,
            differing.join(", ")
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(name: &str, expected: f64, half: f64, verdict: Verdict) -> Judged {
        Judged {
            model: "airtime",
            name: name.to_owned(),
            form: "T".to_owned(),
            unit: "µs",
            expected,
            measured: Some(expected),
            interval: Some([expected - half, expected + half]),
            margin: 0.0,
            margin_for: None,
            trials: 20,
            verdict,
            scenario: String::new(),
        }
    }

    fn of(rows: Vec<Judged>) -> Validation {
        Validation {
            version: "1",
            seed: 1,
            level: 0.99,
            rows,
        }
    }

    #[test]
    fn numbers_have_as_many_digits_as_their_interval_tells() {
        let numbers = |expected, half| numbers(&judged("a", expected, half, Verdict::Agrees));
        assert_eq!(numbers(0.62831, 0.0021), ("0.6283".into(), "0.6283 ± 0.0021 µs".into()));
        assert_eq!(
            numbers(1184.0, 0.00118),
            ("1184.000".into(), "1184.000 ± 0.001 µs".into())
        );
        assert_eq!(
            numbers(-69.73, 1e-5),
            ("−69.73000".into(), "−69.73000 ± 0.00001 µs".into())
        );
        assert_eq!(numbers(0.0, 0.0), ("0.00".into(), "0.00 ± 0.00 µs".into()));
    }

    #[test]
    fn what_differs_is_named_with_what_it_should_have_been() {
        let rows = vec![
            judged("a.b", 2.0, 0.1, Verdict::Agrees),
            judged("a.c", 3.0, 0.1, Verdict::Differs),
        ];
        let text = validation(&of(rows), Style::PLAIN);
        assert!(text.contains("1 of 2 agree. These differ: a.c."), "{text}");
        assert!(
            text.contains("a.c differs: the form gives 3.00, 20 trials 3.00 ± 0.10 µs. T"),
            "{text}"
        );
        assert!(text.contains("  a.c") && text.contains("DIFFERS"), "{text}");
    }
}
