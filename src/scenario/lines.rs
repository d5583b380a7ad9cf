//! Lines and their indentation.

use std::cell::OnceCell;

use super::token::Span;
use super::tree::{Group, Item};

/// The line of a byte, from 1.
pub fn line_of(text: &str, at: usize) -> usize {
    1 + text[..at].matches('\n').count()
}

/// Where the line of a byte begins.
pub fn line_start(text: &str, at: usize) -> usize {
    text[..at].rfind('\n').map_or(0, |newline| newline + 1)
}

/// The line of a byte, from 1, for many bytes of one text: the text is looked through once.
pub struct Lines {
    newlines: Vec<usize>,
}

impl Lines {
    /// The lines of `text`.
    pub fn new(text: &str) -> Self {
        let newlines = text.match_indices('\n').map(|(at, _)| at).collect();
        Self { newlines }
    }

    /// The line of a byte, from 1.
    pub fn of(&self, at: usize) -> usize {
        1 + self.newlines.partition_point(|newline| *newline < at)
    }
}

/// The innermost bracket within `group` that holds a line which by its indentation belongs outside, and where that is.
pub fn swallows(text: &str, group: &Group) -> Option<(Span, usize)> {
    let mut inner = group.items.iter().filter_map(|item| item.value.group.as_ref());
    inner.find_map(|inner| swallows(text, inner)).or_else(|| {
        let opening = &group.opening;
        // Looked up where a line begins within the bracket: else a long line would be gone through for each bracket on it.
        let depth = OnceCell::new();
        let mut starts = group.items.iter().map(Item::start);
        let outside = starts.find(|start| {
            let Some(line) = line_begun_by(text, *start) else {
                return false;
            };
            let depth = depth.get_or_init(|| indentation(text, opening.start));
            line > opening.start && *start - line <= *depth
        });
        outside.map(|start| (opening.clone(), start))
    })
}

/// Where the line of a byte begins, if nothing but space stands before it. Only that space is looked at.
fn line_begun_by(text: &str, at: usize) -> Option<usize> {
    let before = text[..at].trim_end_matches(|letter: char| letter.is_whitespace() && letter != '\n');
    (before.is_empty() || before.ends_with('\n')).then_some(before.len())
}

/// How far in the line of a byte begins.
fn indentation(text: &str, at: usize) -> usize {
    let line = &text[line_start(text, at)..];
    line.len() - line.trim_start().len()
}
