//! What is wrong with a scenario, as people read it.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, Severity, SourceCode};

use super::limits;
use super::lines::{line_of, line_start};
use crate::text::{Style, clean, clean_lines, columns};

/// Longest line that is shown around an error, bytes.
const LONGEST_LINE: usize = 400;

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
    span: Range<usize>,
    text: Arc<str>,
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

    fn is_on_a_short_line(&self) -> bool {
        let before = line_start(&self.text, self.span.start);
        let line = self.text[before..].find('\n').unwrap_or(self.text.len() - before);
        line <= LONGEST_LINE
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

/// A diagnostic as miette draws it, safe to show.
#[derive(Debug)]
struct Drawn {
    message: String,
    help: Option<String>,
    severity: Severity,
    source: Option<(NamedSource<String>, LabeledSpan)>,
}

impl Drawn {
    fn new(diagnostic: &Diagnostic, severity: Severity, width: usize) -> Self {
        let place = diagnostic.place.as_ref();
        let shown = place.filter(|place| place.is_on_a_short_line());
        let kind = if severity == Severity::Warning { "warning: " } else { "" };
        let message = match place {
            Some(place) if shown.is_none() => {
                let Place { name, line, column, .. } = place;
                format!("{kind}{name}:{line}:{column}: {}", diagnostic.message)
            }
            _ => format!("{kind}{}", diagnostic.message),
        };
        Self {
            message: clean_lines(&message).into_owned(),
            help: diagnostic.help.as_ref().map(|help| clean_lines(help).into_owned()),
            severity,
            source: shown.map(|place| source(place, width)),
        }
    }
}

/// The text of a place and its label, lines cut off where there are no columns for them, but not before the label's end. Signs are
/// longer than what they stand for, so the span is counted again.
fn source(place: &Place, width: usize) -> (NamedSource<String>, LabeledSpan) {
    // Before each line stands its number, as wide as that of the next, and a bar.
    let room = width.saturating_sub(" │ ".chars().count() + 1 + (place.line + 1).to_string().len());
    let Range { start, end } = place.span;
    let parts = [0..start, start..end, end..place.text.len()];
    let [before, within, after] = parts.map(|part| clean_lines(&place.text[part]));
    let line = before.rfind('\n').map_or(0, |newline| newline + 1);
    let (above, line) = before.split_at(line);
    let taken = columns(line) + columns(&within);
    let cut_off = |line: &str| cut(line, room);
    let mut text: String = above.split_inclusive('\n').map(cut_off).collect();
    let span = (text.len() + line.len(), within.len());
    text.push_str(line);
    text.push_str(&within);
    let mut rest = after.split_inclusive('\n');
    text.extend(rest.next().map(|rest| cut(rest, room.saturating_sub(taken))));
    text.extend(rest.map(cut_off));
    let label = LabeledSpan::new(Some(clean(&place.label).into_owned()), span.0, span.1);
    (NamedSource::new(clean(&place.name), text), label)
}

/// A line, or the end of one, within `room` columns.
fn cut(line: &str, room: usize) -> String {
    let (words, newline) = line.strip_suffix('\n').map_or((line, ""), |words| (words, "\n"));
    if columns(words) <= room {
        return line.to_owned();
    }
    let mut kept = String::new();
    for letter in words.chars() {
        kept.push(letter);
        if columns(&kept) >= room {
            kept.pop();
            break;
        }
    }
    kept + "…" + newline
}

impl fmt::Display for Drawn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Drawn {}

impl miette::Diagnostic for Drawn {
    fn severity(&self) -> Option<Severity> {
        Some(self.severity)
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        let help = self.help.as_ref()?;
        Some(Box::new(help))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.source.as_ref().map(|(source, _)| source as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let (_, label) = self.source.as_ref()?;
        Some(Box::new(std::iter::once(label.clone())))
    }
}

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
        render(&self.diagnostics, self.more, Severity::Error, style)
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
        render(&self.diagnostics, self.more, Severity::Warning, style)
    }
}

fn render(diagnostics: &[Diagnostic], more: usize, severity: Severity, style: Style) -> String {
    let theme = if style.colour {
        GraphicalTheme::unicode()
    } else {
        GraphicalTheme::unicode_nocolor()
    };
    let handler = GraphicalReportHandler::new_themed(theme)
        .with_width(style.width)
        .with_links(false);
    let mut text = String::new();
    for diagnostic in diagnostics {
        // Writing to a string does not fail; were it to, the message alone still says what is wrong.
        if handler
            .render_report(&mut text, &Drawn::new(diagnostic, severity, style.width))
            .is_err()
        {
            text.push_str(&clean(&diagnostic.message));
        }
    }
    if more > 0 {
        text.extend(["  and ", &more.to_string(), " more\n"]);
    } else if severity == Severity::Error && diagnostics.len() >= limits::DIAGNOSTICS {
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
