//! What is wrong with a scenario, as people read it.

use std::fmt;

use super::diagnostic::{Diagnostic, Kind};
use super::{drawn, limits};
use crate::text::Style;

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
