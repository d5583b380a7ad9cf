//! The shape of RON text: which field stands where. Errors found by `ron`, or later, are placed with it. It reads any
//! text, says all that is wrong with its form, and goes on.

use std::cell::OnceCell;

use super::lines::Lines;
pub use super::node::{Group, Item, Node};
use super::swallow::swallows;
use super::token::{Fault, Faults, Kind, Span, Token, tokens};

/// How deep values may lie in each other. No scenario needs a tenth of it.
pub const MAX_DEPTH: usize = 64;

/// Reads the shape of `text`. No node if there is no value at all.
pub fn read(text: &str) -> (Option<Node>, Faults) {
    let (tokens, faults) = tokens(text);
    let broken = !faults.is_empty();
    let mut reader = Reader {
        text,
        tokens,
        next: 0,
        open: Vec::new(),
        // What a comment or a string that never ends has swallowed is not missing.
        faults: Faults::default(),
        lines: OnceCell::new(),
    };
    let node = reader.value();
    if node.is_some() && reader.faults.is_empty() && reader.peek().is_some() {
        let span = reader.here();
        reader.fault(span, "text after the end".into(), "remove it");
    }
    (node, if broken { faults } else { reader.faults })
}

struct Reader<'t> {
    text: &'t str,
    tokens: Vec<Token>,
    next: usize,
    /// The brackets that are open.
    open: Vec<char>,
    faults: Faults,
    /// The lines of the text, once a fault names one.
    lines: OnceCell<Lines>,
}

impl Reader<'_> {
    fn peek(&self) -> Option<Kind> {
        self.tokens.get(self.next).map(|token| token.kind)
    }

    fn peek_second(&self) -> Option<Kind> {
        self.tokens.get(self.next + 1).map(|token| token.kind)
    }

    /// Where the next token stands, or the end of the text.
    fn here(&self) -> Span {
        let end = self.text.len();
        self.tokens.get(self.next).map_or(end..end, |token| token.span.clone())
    }

    fn take(&mut self) -> Span {
        let span = self.here();
        self.next += 1;
        span
    }

    /// Where the last token taken ends.
    fn end(&self) -> usize {
        let last = self.next.checked_sub(1).and_then(|index| self.tokens.get(index));
        last.map_or(self.text.len(), |token| token.span.end)
    }

    fn line_of(&self, at: usize) -> usize {
        self.lines.get_or_init(|| Lines::new(self.text)).of(at)
    }

    fn fault(&mut self, span: Span, message: String, help: &str) {
        self.faults.push(Fault {
            span,
            message,
            help: help.into(),
        });
    }

    fn value(&mut self) -> Option<Node> {
        match self.peek()? {
            Kind::Open(bracket) => Some(self.group(None, bracket)),
            Kind::Word => {
                let word = self.take();
                let named = self.text[word.clone()].starts_with(|letter: char| letter.is_alphabetic() || letter == '_');
                if named && self.peek() == Some(Kind::Open('(')) {
                    Some(self.group(Some(word), '('))
                } else {
                    Some(leaf(word))
                }
            }
            Kind::Quoted => Some(leaf(self.take())),
            Kind::Close(_) | Kind::Comma | Kind::Colon | Kind::Stray(_) => {
                let span = self.here();
                let found = self.text[span.clone()].to_owned();
                self.fault(
                    span,
                    format!("expected a value, found `{found}`"),
                    "write a value, or remove the character",
                );
                None
            }
        }
    }

    fn group(&mut self, name: Option<Span>, bracket: char) -> Node {
        let opening = self.take();
        let start = name.as_ref().map_or(opening.start, |name| name.start);
        let mut group = Group {
            opening: opening.clone(),
            inside: opening.end..self.text.len(),
            items: Vec::new(),
        };
        self.open.push(bracket);
        if self.open.len() > MAX_DEPTH {
            self.fault(
                opening,
                format!("brackets lie deeper than {MAX_DEPTH}"),
                "a scenario is at most a few levels deep",
            );
            self.next = self.tokens.len();
        } else {
            self.items(&opening, bracket, &mut group);
        }
        self.open.pop();
        Node {
            span: start..self.end().max(start),
            name,
            group: Some(group),
        }
    }

    /// Reads items up to the bracket that closes the group, and that bracket.
    fn items(&mut self, opening: &Span, bracket: char, group: &mut Group) {
        loop {
            match self.peek() {
                None => {
                    if self.faults.is_empty() {
                        self.unclosed(opening, bracket, group);
                    }
                    return;
                }
                Some(Kind::Close(found)) => {
                    group.inside.end = self.here().start;
                    if found != closing(bracket) {
                        self.wrong_close(opening, bracket, found);
                        // It may close a group further out: then this one was left open.
                        if self.open.iter().any(|outer| closing(*outer) == found) {
                            return;
                        }
                    }
                    self.take();
                    return;
                }
                Some(_) => {
                    if let Some(item) = self.item() {
                        group.items.push(item);
                    }
                }
            }
        }
    }

    /// The bracket to name is often one further in, which took a later bracket for its own: then a line within it begins
    /// no further in than the line that it opens on.
    fn unclosed(&mut self, opening: &Span, bracket: char, group: &Group) {
        let help = format!("close it with `{}`", closing(bracket));
        match swallows(self.text, group) {
            Some((opening, swallowed)) => {
                let line = self.line_of(swallowed);
                let message = format!("`{}` is not closed before line {line}", &self.text[opening.clone()]);
                self.fault(opening, message, &help);
            }
            None => self.fault(opening.clone(), format!("`{bracket}` is never closed"), &help),
        }
    }

    fn wrong_close(&mut self, opening: &Span, bracket: char, found: char) {
        let line = self.line_of(opening.start);
        let message = format!("`{found}` does not close the `{bracket}` of line {line}");
        let span = self.here();
        self.fault(span, message, &format!("close it with `{}`", closing(bracket)));
    }

    fn item(&mut self) -> Option<Item> {
        let key = self.key();
        if let (Some(key), Some(Kind::Comma | Kind::Close(_)) | None) = (&key, self.peek()) {
            let message = format!("`{}` has no value", &self.text[key.clone()]);
            self.fault(key.clone(), message, "write one after the colon, or remove the field");
            if self.peek() == Some(Kind::Comma) {
                self.take();
            }
            return None;
        }
        let at = self.next;
        let Some(value) = self.value() else {
            // Whatever could not be a value is passed over, unless it ends the group.
            if at == self.next && !matches!(self.peek(), Some(Kind::Close(_)) | None) {
                self.take();
            }
            return None;
        };
        let mut item = Item {
            key,
            end: value.span.end,
            value,
            comma: false,
        };
        match self.peek() {
            Some(Kind::Comma) => {
                item.end = self.take().end;
                item.comma = true;
            }
            Some(Kind::Close(_)) | None => {}
            Some(_) => self.missing_comma(&item.value),
        }
        Some(item)
    }

    fn missing_comma(&mut self, value: &Node) {
        let span = self.here();
        let before = self.text[span.clone()].to_owned();
        let after = &self.text[value.span.clone()];
        let comma = if after.len() <= 40 && !after.contains('\n') {
            format!("write `,` after `{after}`")
        } else {
            format!("write `,` before `{before}`")
        };
        let help = match self.peek_second() {
            Some(Kind::Colon) => comma,
            _ => format!("{comma}, or remove `{before}`; numbers have no units"),
        };
        self.fault(span, format!("missing `,` before `{before}`"), &help);
    }

    fn key(&mut self) -> Option<Span> {
        if !matches!(self.peek(), Some(Kind::Word | Kind::Quoted)) {
            return None;
        }
        match self.peek_second() {
            Some(Kind::Colon) => {
                let key = self.take();
                self.take();
                Some(key)
            }
            Some(Kind::Stray('=')) => {
                let key = self.take();
                let sign = self.take();
                self.fault(sign, "`=` between a field and its value".into(), "write `:`");
                Some(key)
            }
            _ => None,
        }
    }
}

fn leaf(span: Span) -> Node {
    Node {
        span,
        name: None,
        group: None,
    }
}

/// The bracket that closes `bracket`.
fn closing(bracket: char) -> char {
    match bracket {
        '(' => ')',
        '[' => ']',
        _ => '}',
    }
}

#[cfg(test)]
mod tests;
