//! The report's section on what is not as predicted.

use super::layout::Page;
use super::number::estimate;
use super::preflight::in_unit;
use crate::predict::Surprise;

/// Where the run disagrees with what closed forms say of its scenario; nothing where it agrees.
pub fn section(page: &mut Page, surprises: &[Surprise]) {
    if surprises.is_empty() {
        return;
    }
    page.heading("Not as predicted (see `desim check --predict`)");
    for (together, why) in by_reason(surprises) {
        for surprise in together {
            page.item(&words(surprise));
        }
        page.item(&format!("because {why}"));
    }
}

/// Figures that are not as predicted for the same reason, each reason once, in the order in which they come up.
pub fn by_reason(surprises: &[Surprise]) -> Vec<(Vec<&Surprise>, &str)> {
    let mut reasons: Vec<(Vec<&Surprise>, &str)> = Vec::new();
    for surprise in surprises {
        match reasons.iter_mut().find(|(_, why)| *why == surprise.why) {
            Some((together, _)) => together.push(surprise),
            None => reasons.push((vec![surprise], &surprise.why)),
        }
    }
    reasons
}

/// What is not as predicted, in words, the reason left out.
pub fn words(surprise: &Surprise) -> String {
    let Surprise {
        predicted, measured, ..
    } = surprise;
    let write = |value| in_unit(value, predicted.unit);
    format!(
        "{} {}, predicted {}",
        predicted.what,
        estimate(measured, write),
        write(predicted.value)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::Estimate;
    use crate::predict::{Holds, Prediction};
    use crate::text::Style;

    fn surprise(what: &'static str, why: &str) -> Surprise {
        Surprise {
            predicted: Prediction {
                name: what,
                what,
                value: 0.5,
                unit: "1",
                accuracy: 0.0,
                holds: Holds::Throughout,
                formula: "p",
                assumes: "nothing".to_owned(),
            },
            measured: Estimate::default(),
            why: why.to_owned(),
        }
    }

    #[test]
    fn a_reason_that_several_figures_share_is_said_once() {
        let mut page = Page::new(Style::PLAIN);
        let surprises = [
            surprise("loss", "robots moved"),
            surprise("latency", "in flight"),
            surprise("bytes", "robots moved"),
        ];
        section(&mut page, &surprises);
        let text = page.text();
        assert_eq!(text.matches("robots moved").count(), 1);
        let places =
            ["loss", "bytes", "because robots moved", "latency", "because in flight"].map(|words| text.find(words));
        assert!(places.is_sorted() && places.iter().all(Option::is_some), "{text}");
    }
}
