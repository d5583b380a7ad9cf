//! A figure: charts, the words below them, and their data.

use std::borrow::Cow;

use maud::{Markup, PreEscaped, html};
use plotly::Plot;

use super::chart::{TOOLS, one_value};
use super::table::DataTable;

/// A figure.
pub struct Figure {
    /// Its name in links and files: letters and dashes.
    pub id: Cow<'static, str>,
    /// What it shows.
    pub title: Cow<'static, str>,
    /// What a reader sees in it.
    pub caption: String,
    /// Its charts.
    pub panels: Vec<Panel>,
    /// Names of the numbers in its charts, from 1; none where charts name what they show.
    pub key: Vec<String>,
    /// Its data.
    pub table: DataTable,
}

/// A part of a figure.
pub struct Panel {
    /// What tells it from the others; empty if it is alone.
    pub title: Cow<'static, str>,
    /// What is seen.
    pub content: Content,
}

/// What is seen in a part of a figure.
pub enum Content {
    /// A chart, and its height in CSS pixels.
    Chart(Box<Plot>, u32),
    /// A sentence, where a chart would show one value only.
    Words(String),
}

/// Height of a chart that is as any other.
pub const HEIGHT: u32 = 320 + TOOLS;

impl Panel {
    /// A chart of the usual height.
    pub fn new(title: impl Into<Cow<'static, str>>, plot: Plot) -> Self {
        Self::of_height(title, plot, HEIGHT)
    }

    /// A chart of `rows` bars, boxes or intervals: the more there are, the closer they stand.
    pub fn of_rows(title: impl Into<Cow<'static, str>>, plot: Plot, rows: usize) -> Self {
        Self::of_height(title, plot, TOOLS + 90 + row_height(rows) * rows.max(1) as u32)
    }

    /// A chart of its own height.
    pub fn of_height(title: impl Into<Cow<'static, str>>, plot: Plot, height: u32) -> Self {
        Self {
            title: title.into(),
            content: Content::Chart(Box::new(plot), height),
        }
    }

    /// The same, unless `values`, all that it shows, are one: no chart is needed to see that, only what `alike` says of it.
    pub fn unless_one(self, values: impl IntoIterator<Item = f64>, alike: impl FnOnce(f64) -> String) -> Self {
        match one_value(values) {
            Some(value) => Self::words(self.title, alike(value)),
            None => self,
        }
    }

    /// A sentence instead of a chart.
    pub fn words(title: impl Into<Cow<'static, str>>, words: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            content: Content::Words(words.into()),
        }
    }
}

/// Height of one of so many rows, CSS pixels; the least still has room for its name.
pub fn row_height(rows: usize) -> u32 {
    match rows {
        0..=10 => 44,
        11..=20 => 30,
        21..=40 => 22,
        _ => 18,
    }
}

impl Figure {
    /// The figure on the page, number `number`, its data files named after `scenario`.
    pub fn markup(&self, number: usize, scenario: &str) -> Markup {
        html! {
            figure id=(self.id) {
                h3 { "Figure " (number) ". " (self.title) }
                div class=(if self.panels.len() > 1 { "panels" } else { "panel" }) {
                    @for (place, panel) in self.panels.iter().enumerate() {
                        div class="chart" {
                            @if !panel.title.is_empty() { h4 { (panel.title) } }
                            @match &panel.content {
                                // plotly writes the data as JSON in which no tag can end the script.
                                Content::Chart(plot, height) => div class="plot" style=(format!("height:{height}px")) {
                                    (PreEscaped(plot.to_inline_html(Some(&format!("{}-{place}", self.id)))))
                                },
                                Content::Words(words) => p class="flat" { (words) },
                            }
                        }
                    }
                }
                @if !self.key.is_empty() {
                    ol class="key" { @for name in &self.key { li { (name) } } }
                }
                figcaption { (self.caption) }
                (self.table.markup(&format!("{scenario}-{}.csv", self.id)))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chart_of_one_value_is_a_sentence_and_any_other_a_chart() {
        let panel = |values: &[f64]| {
            Panel::new("Sent", Plot::new()).unless_one(values.iter().copied(), |value| format!("{value} at all times."))
        };
        for (values, words) in [
            (&[3.0, 3.0, 3.0][..], Some("3 at all times.")),
            (&[0.1 + 0.2, 0.3], Some("0.30000000000000004 at all times.")),
            (&[3.0, 3.1], None),
            (&[], None),
        ] {
            let panel = panel(values);
            assert_eq!(panel.title, "Sent");
            match (panel.content, words) {
                (Content::Words(said), Some(words)) => assert_eq!(said, words),
                (Content::Chart(..), None) => {}
                (Content::Chart(..), Some(words)) => panic!("a chart, and not: {words}"),
                (Content::Words(said), None) => panic!("no chart of {values:?}, but: {said}"),
            }
        }
    }
}
