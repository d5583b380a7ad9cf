//! The data of a figure: a table on the page, and the same as CSV to take away.

use std::fmt::Write as _;

use maud::{Markup, html};

use crate::text::clean;

/// Longer tables stay on the screen when the page is printed.
pub const PRINTED_ROWS: usize = 24;

/// A value in a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A count.
    Count(u64),
    /// A measured number.
    Number(f64),
    /// No value.
    Nothing,
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<u64> for Cell {
    fn from(count: u64) -> Self {
        Self::Count(count)
    }
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl<T: Into<Self>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Nothing, Into::into)
    }
}

/// A table.
#[derive(Clone, Debug, PartialEq)]
pub struct DataTable {
    /// Names of the columns, each with its unit.
    pub head: Vec<String>,
    /// The rows.
    pub rows: Vec<Vec<Cell>>,
}

impl DataTable {
    /// A table with these columns and no rows yet.
    pub fn new(head: &[&str]) -> Self {
        Self {
            head: head.iter().map(|&name| name.to_owned()).collect(),
            rows: Vec::new(),
        }
    }

    /// The table, folded up, and the link to take it away as the file `name`.
    pub fn markup(&self, name: &str) -> Markup {
        let rows = self.rows.len();
        let long = rows > PRINTED_ROWS;
        html! {
            details class=(if long { "data long" } else { "data" }) {
                summary { "Data: " (rows) (if rows == 1 { " row" } else { " rows" }) }
                div class="scroll" tabindex="0" {
                    table {
                        thead { tr { @for name in &self.head { th scope="col" { (name) } } } }
                        tbody {
                            @for row in &self.rows {
                                tr { @for cell in row { (cell.markup()) } }
                            }
                        }
                    }
                }
            }
            p class="take" {
                a href=(data_url(&self.csv())) download=(name) { "Download " (name) }
                @if long { span class="print-only" { "Its data, " (rows) " rows, are not printed: they are in the page on the screen and in " (name) "." } }
            }
        }
    }

    /// The table as CSV (RFC 4180), numbers in full. Words with which a spreadsheet would begin a formula have an apostrophe before
    /// them, by which it takes them for words.
    pub fn csv(&self) -> String {
        let head = self.head.iter().map(|name| quoted(name)).collect::<Vec<_>>();
        let mut text = head.join(",");
        text.push_str("\r\n");
        for row in &self.rows {
            let cells: Vec<String> = row.iter().map(Cell::csv).collect();
            text.push_str(&cells.join(","));
            text.push_str("\r\n");
        }
        text
    }
}

impl Cell {
    fn markup(&self) -> Markup {
        html! {
            @match self {
                Self::Text(text) => td class="text" { (text) },
                Self::Count(count) => td { (super::super::number::count(*count)) },
                Self::Number(number) => td { (readable(*number)) },
                Self::Nothing => td { (super::super::number::NOTHING) },
            }
        }
    }

    fn csv(&self) -> String {
        match self {
            Self::Text(text) => quoted(text),
            Self::Count(count) => count.to_string(),
            Self::Number(number) => number.to_string(),
            Self::Nothing => String::new(),
        }
    }
}

/// A number with five digits that count.
fn readable(number: f64) -> String {
    let rounded = super::chart::shown(number);
    if rounded != 0.0 && !(1e-4..1e7).contains(&rounded.abs()) {
        format!("{rounded:e}")
    } else {
        rounded.to_string()
    }
}

/// Words as a value: in quotes where they hold what parts values, whatever a spreadsheet takes for that, and never a formula.
fn quoted(text: &str) -> String {
    let text = clean(text);
    let apostrophe = if begins_formula(&text) { "'" } else { "" };
    if apostrophe.is_empty() && !text.contains(['"', '\'', ',', ';']) {
        text.into_owned()
    } else {
        format!("\"{apostrophe}{}\"", text.replace('"', "\"\""))
    }
}

/// Whether a spreadsheet would take words, which hold no control characters, for a formula; in the wide letters of East Asian scripts
/// too, and after blanks.
fn begins_formula(text: &str) -> bool {
    let is_number = text.parse::<f64>().is_ok_and(f64::is_finite);
    !is_number
        && text
            .trim_start()
            .starts_with(['=', '+', '-', '@', '＝', '＋', '－', '＠'])
}

/// A link that holds the file itself.
fn data_url(text: &str) -> String {
    let mut url = "data:text/csv;charset=utf-8,".to_owned();
    for byte in text.bytes() {
        if byte.is_ascii_alphanumeric() || b"-._~,".contains(&byte) {
            url.push(byte.into());
        } else {
            // Writing to a string does not fail.
            let _ = write!(url, "%{byte:02X}");
        }
    }
    url
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_with_a_comma_or_a_quote_is_quoted_and_numbers_are_whole() {
        let table = DataTable {
            head: vec!["topic".to_owned(), "share, %".to_owned()],
            rows: vec![
                vec!["say \"hi\"".into(), (1.0_f64 / 3.0).into()],
                vec![Cell::Nothing, 1_234_567_u64.into()],
            ],
        };
        assert_eq!(
            table.csv(),
            "topic,\"share, %\"\r\n\"say \"\"hi\"\"\",0.3333333333333333\r\n,1234567\r\n"
        );
    }

    #[test]
    fn words_that_a_spreadsheet_would_reckon_with_stay_words_and_numbers_numbers() {
        let table = DataTable {
            head: vec!["=HYPERLINK(\"http://x\")".to_owned()],
            rows: [
                "=1+1", "-2+3", "@SUM(A1)", "＋1", "＝1", " =1", "\t=1", "\r-1", "a;=1+1", "-inf", "-0.5", "+3e2",
                "a-b",
            ]
            .map(|label| vec![label.into()])
            .into(),
        };
        let csv = table.csv();
        let cells: Vec<&str> = csv.lines().collect();
        assert_eq!(
            cells,
            [
                "\"'=HYPERLINK(\"\"http://x\"\")\"",
                "\"'=1+1\"",
                "\"'-2+3\"",
                "\"'@SUM(A1)\"",
                "\"'＋1\"",
                "\"'＝1\"",
                "\"' =1\"",
                "␉=1",
                "␍-1",
                "\"a;=1+1\"",
                "\"'-inf\"",
                "-0.5",
                "+3e2",
                "a-b"
            ]
        );
    }

    #[test]
    fn a_data_url_holds_nothing_that_could_end_it() {
        let url = data_url("a,b\r\n\"<x>\" é#&%\n");
        assert_eq!(
            url,
            "data:text/csv;charset=utf-8,a,b%0D%0A%22%3Cx%3E%22%20%C3%A9%23%26%25%0A"
        );
    }
}
