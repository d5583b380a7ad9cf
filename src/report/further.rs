//! The figures that have no words of their own.

use super::layout::Page;
use super::number::{estimate, signed};
use crate::metrics::Summary;

/// A name and a value of each: the estimate with its interval, its unit, what is known of what was cut off, and how many trials tell of it, if
/// not all do.
pub fn rows(summary: &Summary) -> Vec<(String, String)> {
    let listed = summary.figures.0.iter().map(|(_, listed)| {
        let unit = match &*listed.unit {
            "1" => "",
            unit => &format!(" {unit}"),
        };
        let cut_off = match listed.cut_off {
            Some(cut_off) => format!(", {cut_off} cut off"),
            None => String::new(),
        };
        let few = if listed.estimate.n < summary.trials {
            format!(", of {} of {} trials", listed.estimate.n, summary.trials)
        } else {
            String::new()
        };
        let words = format!("{}{unit}{cut_off}{few}", estimate(&listed.estimate, signed));
        (listed.name.clone(), words)
    });
    listed.collect()
}

/// All of them, if there are any.
pub fn section(page: &mut Page, summary: &Summary) {
    let rows = rows(summary);
    if rows.is_empty() {
        return;
    }
    page.heading("Further figures");
    for (name, words) in rows {
        page.item(&format!("{name}: {words}"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::Estimate;
    use crate::metrics::summary::Listed;
    use crate::text::Style;

    fn listed(name: &str, value: f64, unit: &str, cut_off: Option<u64>) -> (String, Listed) {
        let estimate = Estimate {
            value: Some(value),
            ci95: [Some(value - 1.0), Some(value + 1.0)],
            n: 3,
        };
        let listed = Listed {
            name: name.to_owned(),
            estimate,
            cut_off,
            unit: unit.to_owned().into(),
        };
        (name.to_owned(), listed)
    }

    #[test]
    fn what_may_be_below_0_has_its_sign_and_names_of_others_are_made_safe() {
        let mut summary = Summary::of("a", &[], &[], &[]);
        let mut page = Page::new(Style::PLAIN);
        section(&mut page, &summary);
        assert_eq!(page.text(), "", "where there is none, nothing is said");

        summary.trials = 3;
        summary.figures.0 = vec![
            listed("drift\u{1b}[31m", -2.5, "m", None),
            listed("share", 0.0, "1", None),
            listed("wait", 20.0, "s", Some(4)),
        ];
        let mut page = Page::new(Style::PLAIN);
        section(&mut page, &summary);
        let text = page.text();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[..2], ["", "Further figures"]);
        assert!(
            lines[2].ends_with(": \u{2212}2.50 [\u{2212}3.50, \u{2212}1.50] m") && !lines[2].contains('\u{1b}'),
            "{text}"
        );
        assert_eq!(lines[3], "  share: 0 [\u{2212}1.00, 1.00]");
        assert_eq!(lines[4], "  wait: 20.0 [19.0, 21.0] s, 4 cut off");

        summary.trials = 20;
        assert!(rows(&summary)[2].1.ends_with(" s, 4 cut off, of 3 of 20 trials"));
    }
}
