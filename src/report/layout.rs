//! Words on a terminal.

use std::fmt::Write as _;

use comfy_table::{ContentLineStyle, LineStyle, TableStyle};

/// Columns that every line keeps within.
pub const WIDTH: usize = 80;
/// Tables: columns apart, a rule under the header.
pub const RULED: TableStyle = TableStyle::new()
    .header_lines(ContentLineStyle::none())
    .header_separator(LineStyle::none().fill('─'))
    .content_lines(ContentLineStyle::none());
/// Columns of the names on the left.
const MARGIN: usize = 14;

/// Breaks `words` at blanks into lines of at most `width` characters; a longer word stands alone.
pub fn wrap(words: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words.split(' ').filter(|word| !word.is_empty()) {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Text being laid out.
pub struct Page {
    /// What is laid out so far.
    pub text: String,
    /// Whether to use colours.
    pub colour: bool,
}

impl Page {
    /// The name in bold, then the question that the results answer.
    pub fn title(&mut self, name: &str, question: Option<&str>) {
        let name = self.bold(name);
        self.line(&name);
        for line in wrap(question.unwrap_or_default(), WIDTH) {
            self.line(&line);
        }
    }

    /// A heading, after an empty line.
    pub fn heading(&mut self, words: &str) {
        self.line("");
        for line in wrap(words, WIDTH) {
            let line = self.bold(&line);
            self.line(&line);
        }
    }

    /// A name on the left, words on the right, over as many lines as they need.
    pub fn entry(&mut self, name: &str, words: &str) {
        let mut name = name;
        for line in wrap(words, WIDTH - MARGIN - 2) {
            self.line(&format!("  {name:<MARGIN$}{line}"));
            name = "";
        }
    }

    /// Words over as many lines as they need, a little in.
    pub fn words(&mut self, words: &str) {
        for line in wrap(words, WIDTH - 2) {
            self.line(&format!("  {line}"));
        }
    }

    /// An item of a list, over as many lines as it needs, all but the first indented.
    pub fn item(&mut self, words: &str) {
        let mut indent = "  ";
        for line in wrap(words, WIDTH - 4) {
            self.line(&format!("{indent}{line}"));
            indent = "    ";
        }
    }

    /// A line as it is.
    pub fn line(&mut self, words: &str) {
        // Writing to a string does not fail.
        let _ = writeln!(self.text, "{}", words.trim_end());
    }

    fn bold(&self, words: &str) -> String {
        if self.colour {
            format!("\u{1b}[1m{words}\u{1b}[0m")
        } else {
            words.to_owned()
        }
    }
}
