//! What is wrong with a scenario, as people read it.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use super::lines::{line_of, line_start};
use super::{drawn, limits};
use crate::text::Style;

/// One thing that is wrong, or looks so, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// What is wrong.
    pub message: String,
    /// What would be right and what to do.
    pub help: Option<String>,
    /// Path of the field that it is about, such as `radio.loss`; `None` if it is about no field.
    pub path: Option<String>,
    /// Where it stands; `None` if it is about the file as a whole.
    pub place: Option<Place>,
}

/// Where something stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Name of the file, or `--set`.
    pub name: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What the label under the line says.
    pub label: String,
    /// The bytes of `text` that it is, on one line.
    pub(super) span: Range<usize>,
    /// What `name` holds.
    pub(super) text: Arc<str>,
}

impl Place {
    /// The place of the bytes `span` in `text`, which `name` holds.
    #[must_use]
    pub fn new(name: &str, text: &Arc<str>, span: Range<usize>, label: impl Into<String>) -> Self {
        let start = floor(text, span.start);
        let first = line_start(text, start);
        let line_end = text[start..].find('\n').map_or(text.len(), |newline| start + newline);
        let end = floor(text, span.end).clamp(start, line_end);
        Self {
            name: name.into(),
            line: line_of(text, start),
            column: 1 + text[first..start].chars().count(),
            label: label.into(),
            span: start..end,
            text: Arc::clone(text),
        }
    }
}

/// The last place at or before `at` where `text` can be cut.
fn floor(text: &str, at: usize) -> usize {
    text.floor_char_boundary(at)
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Diagnostic {}

/// Everything that is wrong with a scenario: one diagnostic or more.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// What is wrong, in the order of the file; the first of it where there is more than helps.
    pub diagnostics: Vec<Diagnostic>,
    /// How much more is known to be wrong.
    pub more: usize,
}

/// What looks wrong with a scenario that holds: settings that do nothing, or not what their author will have meant.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Warnings {
    /// What looks wrong, in the order of the file; the first of it where there is more than helps.
    pub diagnostics: Vec<Diagnostic>,
    /// How much more looks wrong.
    pub more: usize,
}

impl Report {
    /// The report as people read it, each diagnostic with the line that it is about.
    #[must_use]
    pub fn render(&self, style: Style) -> String {
        render(&self.diagnostics, self.more, Kind::Fault, style)
    }
}

impl Warnings {
    /// Whether nothing looks wrong.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.diagnostics.is_empty()
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.diagnostics.len() + self.more
    }

    /// The warnings as people read them, each with the line that it is about.
    #[must_use]
    pub fn render(&self, style: Style) -> String {
        render(&self.diagnostics, self.more, Kind::Warning, style)
    }
}

/// What a diagnostic is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Something that is wrong.
    Fault,
    /// Something that looks so.
    Warning,
}

impl Kind {
    /// What stands before the message.
    pub(super) const fn prefix(self) -> &'static str {
        match self {
            Self::Fault => "",
            Self::Warning => "warning: ",
        }
    }
}

fn render(diagnostics: &[Diagnostic], more: usize, kind: Kind, style: Style) -> String {
    let mut text = drawn::all(diagnostics, kind, style);
    if more > 0 {
        text.extend(["  and ", &more.to_string(), " more\n"]);
    } else if kind == Kind::Fault && diagnostics.len() >= limits::DIAGNOSTICS {
        text.push_str("  and perhaps more: reading ends here\n");
    }
    text
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(Style::PLAIN))
    }
}

impl std::error::Error for Report {}

impl From<Vec<Diagnostic>> for Report {
    fn from(diagnostics: Vec<Diagnostic>) -> Self {
        Self { diagnostics, more: 0 }
    }
}

impl From<Diagnostic> for Report {
    fn from(diagnostic: Diagnostic) -> Self {
        vec![diagnostic].into()
    }
}
