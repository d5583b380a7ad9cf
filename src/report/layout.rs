//! Words on a terminal: paragraphs, entries and lists that keep within its width. Whatever comes from files is made safe here.

use std::fmt::Write as _;

use super::grid::Grid;
use crate::text::{Style, clean, clean_lines, columns, wrap};

/// Columns of the names on the left.
const MARGIN: usize = 14;
/// Columns that words have at least beside anything else.
const BESIDE: usize = 24;
/// How far in lines begin that go on, and no further where there is little room.
const INDENT: usize = 4;

/// Text being laid out.
pub struct Page {
    text: String,
    style: Style,
}

impl Page {
    /// A page with nothing on it.
    pub fn new(style: Style) -> Self {
        Self {
            text: String::new(),
            style,
        }
    }

    /// What is on it.
    pub fn text(self) -> String {
        self.text
    }

    /// The name in bold, then the question that the results answer.
    pub fn title(&mut self, name: &str, question: Option<&str>) {
        self.bold(name);
        self.paragraph("", "", question.unwrap_or_default());
    }

    /// A heading, after an empty line.
    pub fn heading(&mut self, words: &str) {
        self.gap();
        self.bold(words);
    }

    /// A name on the left, words on the right, over as many lines as they need.
    pub fn entry(&mut self, name: &str, words: &str) {
        if self.style.width < 2 + MARGIN + BESIDE {
            let name = if name.is_empty() { name } else { &format!("{name}: ") };
            return self.item(&format!("{name}{words}"));
        }
        let name = clean(name);
        let pad = " ".repeat(MARGIN.saturating_sub(columns(&name)));
        self.paragraph(&format!("  {name}{pad}"), &" ".repeat(2 + MARGIN), words);
    }

    /// An item of a list, over as many lines as it needs, all but the first indented.
    pub fn item(&mut self, words: &str) {
        self.paragraph("  ", "    ", words);
    }

    /// Words over as many lines as they need, a little in.
    pub fn words(&mut self, words: &str) {
        self.paragraph("  ", "  ", words);
    }

    /// Words over as many lines as they need, after `first` on the first line and `rest` on the others; where there is little
    /// room beside them, `first` is the words' beginning.
    pub fn paragraph(&mut self, first: &str, rest: &str, words: &str) {
        let words = clean(words);
        let indent = columns(first).max(columns(rest));
        if indent + BESIDE > self.style.width && indent > INDENT {
            let indent = " ".repeat(INDENT);
            return self.paragraph(&indent[..2], &indent, &format!("{} {words}", first.trim()));
        }
        let mut before = first;
        for line in wrap(&words, self.style.width.saturating_sub(indent)) {
            self.put(&format!("{before}{line}"));
            before = rest;
        }
    }

    /// A table, in parts where it is too wide.
    pub fn table(&mut self, grid: &Grid) {
        for (part, lines) in grid.lines(self.style.width).iter().enumerate() {
            if part > 0 {
                self.gap();
            }
            for line in lines {
                self.put(line);
            }
        }
    }

    /// An empty line.
    pub fn gap(&mut self) {
        self.put("");
    }

    fn bold(&mut self, words: &str) {
        for line in wrap(&clean(words), self.style.width) {
            if self.style.colour {
                self.put(&format!("\u{1b}[1m{line}\u{1b}[0m"));
            } else {
                self.put(&line);
            }
        }
    }

    fn put(&mut self, line: &str) {
        // Writing to a string does not fail.
        let _ = writeln!(self.text, "{}", line.trim_end());
    }
}

/// A message, line by line within `width` columns where that is known, as safe as everything else; what a line begins
/// with goes on under its beginning.
#[must_use]
pub fn message(words: &str, width: Option<usize>) -> String {
    let words = clean_lines(words.trim_end());
    let Some(width) = width else {
        return format!("{words}\n");
    };
    let mut page = Page::new(Style { colour: false, width });
    for line in words.lines() {
        if columns(line) <= width {
            page.put(line);
            continue;
        }
        let indent = " ".repeat(line.len() - line.trim_start_matches(' ').len());
        page.paragraph(&indent, &format!("{indent}  "), line);
    }
    page.text
}
