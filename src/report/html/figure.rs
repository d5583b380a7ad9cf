//! A figure: charts, the words below them, and their data.

use std::borrow::Cow;

use maud::{Markup, PreEscaped, html};
use plotly::Plot;

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
    /// Its data.
    pub table: DataTable,
}

/// A chart of a figure.
pub struct Panel {
    /// What tells it from the others; empty if it is alone.
    pub title: &'static str,
    /// The chart.
    pub plot: Plot,
    /// Its height in CSS pixels.
    pub height: u32,
}

/// Height of a chart that is as any other.
pub const HEIGHT: u32 = 320;

impl Panel {
    /// A chart of the usual height.
    pub fn new(title: &'static str, plot: Plot) -> Self {
        Self {
            title,
            plot,
            height: HEIGHT,
        }
    }

    /// A chart of `rows` bars or boxes.
    pub fn of_rows(title: &'static str, plot: Plot, rows: usize) -> Self {
        let height = 100 + 44 * rows.max(1) as u32;
        Self { title, plot, height }
    }
}

impl Figure {
    /// The figure on the page, number `number`, its data files named after `scenario`.
    pub fn markup(&self, number: usize, scenario: &str) -> Markup {
        let plots = self.panels.iter().enumerate().map(|(panel, chart)| {
            // plotly writes the data as JSON in which no tag can end the script.
            let plot = chart.plot.to_inline_html(Some(&format!("{}-{panel}", self.id)));
            (chart, PreEscaped(plot))
        });
        html! {
            figure id=(self.id) {
                h3 { "Figure " (number) ". " (self.title) }
                div class=(if self.panels.len() > 1 { "panels" } else { "panel" }) {
                    @for (chart, plot) in plots {
                        div class="chart" {
                            @if !chart.title.is_empty() { h4 { (chart.title) } }
                            div class="plot" style=(format!("height:{}px", chart.height)) { (plot) }
                        }
                    }
                }
                figcaption { (self.caption) }
                (self.table.markup(&format!("{scenario}-{}.csv", self.id)))
            }
        }
    }
}
