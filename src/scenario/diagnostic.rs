//! One thing that is wrong with a scenario, or looks so, and where it stands.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use super::lines::{line_of, line_start};

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
