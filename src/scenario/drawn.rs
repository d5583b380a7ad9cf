//! What is wrong with a scenario, drawn: each diagnostic under the line that it is about.

use std::fmt;
use std::ops::Range;

use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, Severity, SourceCode};

use super::diagnostic::{Diagnostic, Kind, Place};
use super::lines::line_start;
use crate::text::{Style, clean, clean_lines, columns};

/// Longest line that is shown around an error, bytes.
const LONGEST_LINE: usize = 400;

/// All of `diagnostics`, one below the other.
pub fn all(diagnostics: &[Diagnostic], kind: Kind, style: Style) -> String {
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
            .render_report(&mut text, &Drawn::new(diagnostic, kind, style.width))
            .is_err()
        {
            text.push_str(&clean(&diagnostic.message));
        }
    }
    text
}

fn is_on_a_short_line(place: &Place) -> bool {
    let before = line_start(&place.text, place.span.start);
    let line = place.text[before..].find('\n').unwrap_or(place.text.len() - before);
    line <= LONGEST_LINE
}

/// A diagnostic as miette draws it, safe to show.
#[derive(Debug)]
struct Drawn {
    message: String,
    help: Option<String>,
    severity: Severity,
    source: Option<(NamedSource<String>, LabeledSpan)>,
}

impl Drawn {
    fn new(diagnostic: &Diagnostic, kind: Kind, width: usize) -> Self {
        let place = diagnostic.place.as_ref();
        let shown = place.filter(|place| is_on_a_short_line(place));
        let prefix = kind.prefix();
        let message = match place {
            Some(place) if shown.is_none() => {
                let Place { name, line, column, .. } = place;
                format!("{prefix}{name}:{line}:{column}: {}", diagnostic.message)
            }
            _ => format!("{prefix}{}", diagnostic.message),
        };
        Self {
            message: clean_lines(&message).into_owned(),
            help: diagnostic.help.as_ref().map(|help| clean_lines(help).into_owned()),
            severity: match kind {
                Kind::Fault => Severity::Error,
                Kind::Warning => Severity::Warning,
            },
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
