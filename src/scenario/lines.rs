//! Lines and their indentation.

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

/// The innermost bracket within `group` that holds a line which by its indentation belongs outside, and where that is.
pub fn swallows(text: &str, group: &Group) -> Option<(Span, usize)> {
    let mut inner = group.items.iter().filter_map(|item| item.value.group.as_ref());
    inner.find_map(|inner| swallows(text, inner)).or_else(|| {
        let opening = &group.opening;
        let depth = indentation(text, opening.start);
        let mut starts = group.items.iter().map(Item::start);
        let outside = starts.find(|start| {
            let line = line_start(text, *start);
            let begins_it = text[line..*start].trim().is_empty();
            line > opening.start && begins_it && *start - line <= depth
        });
        outside.map(|start| (opening.clone(), start))
    })
}

/// How far in the line of a byte begins.
fn indentation(text: &str, at: usize) -> usize {
    let line = &text[line_start(text, at)..];
    line.len() - line.trim_start().len()
}
