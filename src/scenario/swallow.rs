//! Brackets that were not closed: what looks to stand outside of one, by its indentation, and is inside.

use std::cell::OnceCell;

use super::lines::line_start;
use super::node::{Group, Item};
use super::token::Span;

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
