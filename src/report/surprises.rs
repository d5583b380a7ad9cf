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
    for surprise in surprises {
        page.item(&words(surprise));
    }
}

/// What is not as predicted, in words.
pub fn words(surprise: &Surprise) -> String {
    let Surprise {
        predicted,
        measured,
        why,
    } = surprise;
    let write = |value| in_unit(value, predicted.unit);
    format!(
        "{} {}, predicted {}: {why}",
        predicted.what,
        estimate(measured, write),
        write(predicted.value)
    )
}
