//! The words of RON text, with where they stand. Takes any text and never fails: what it cannot make sense of becomes
//! a token or a fault.

use std::ops::Range;

use super::limits;

/// Where something stands: a range of bytes.
pub type Span = Range<usize>;

/// Something wrong with the form of the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Where.
    pub span: Span,
    /// What is wrong.
    pub message: String,
    /// What would be right.
    pub help: String,
}

/// What is wrong with the form of a text: the first of it, for more is of no help.
#[derive(Debug, Default)]
pub struct Faults {
    /// The first, in the order in which they were found.
    pub first: Vec<Fault>,
    /// How many more there are.
    pub more: usize,
}

impl Faults {
    /// Whether nothing is wrong.
    pub fn is_empty(&self) -> bool {
        self.first.is_empty()
    }

    /// Adds a fault, or counts it.
    pub fn push(&mut self, fault: Fault) {
        if self.first.len() < limits::DIAGNOSTICS {
            self.first.push(fault);
        } else {
            self.more += 1;
        }
    }
}

/// A kind of token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `(`, `[` or `{`.
    Open(char),
    /// `)`, `]` or `}`.
    Close(char),
    /// `,`
    Comma,
    /// `:`
    Colon,
    /// A name or a number.
    Word,
    /// A string or a character, quotes included.
    Quoted,
    /// A character that RON has no use for here.
    Stray(char),
}

/// A token and where it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Token {
    /// What it is.
    pub kind: Kind,
    /// Where it stands.
    pub span: Span,
}

/// Cuts `text` into tokens; comments and a leading `#![enable(...)]` are left out.
pub fn tokens(text: &str) -> (Vec<Token>, Faults) {
    let mut lexer = Lexer {
        text,
        at: 0,
        tokens: Vec::new(),
        faults: Faults::default(),
    };
    lexer.skip_attribute();
    while lexer.at < text.len() {
        lexer.step();
    }
    (lexer.tokens, lexer.faults)
}

struct Lexer<'t> {
    text: &'t str,
    at: usize,
    tokens: Vec<Token>,
    faults: Faults,
}

impl Lexer<'_> {
    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn step(&mut self) {
        let start = self.at;
        let Some(first) = self.rest().chars().next() else {
            return;
        };
        if first.is_whitespace() {
            self.at += first.len_utf8();
        } else if self.rest().starts_with("//") {
            self.at += self.rest().find('\n').unwrap_or(self.rest().len());
        } else if self.rest().starts_with("/*") {
            self.block_comment();
        } else if let Some((prefix, hashes)) = raw_string(self.rest()) {
            self.raw_string(prefix, hashes);
        } else if self.rest().starts_with("b\"") {
            self.quoted(2, '"');
        } else if first == '"' || first == '\'' {
            self.quoted(1, first);
        } else if is_word(first) {
            let raw_mark = if self.rest().starts_with("r#") { 2 } else { 0 };
            let rest = &self.rest()[raw_mark..];
            let length = rest.find(|letter| !is_word(letter)).unwrap_or(rest.len());
            self.push(Kind::Word, start + raw_mark + length);
        } else {
            let kind = match first {
                '(' | '[' | '{' => Kind::Open(first),
                ')' | ']' | '}' => Kind::Close(first),
                ',' => Kind::Comma,
                ':' => Kind::Colon,
                other => Kind::Stray(other),
            };
            self.push(kind, start + first.len_utf8());
        }
    }

    fn push(&mut self, kind: Kind, end: usize) {
        let span = self.at..end;
        self.tokens.push(Token { kind, span });
        self.at = end;
    }

    fn unclosed(&mut self, what: &str, close: &str) {
        let start = self.at;
        let line = self.rest().find('\n').unwrap_or(self.rest().len());
        self.faults.push(Fault {
            span: start..start + line,
            message: format!("{what} that begins here is never closed"),
            help: format!("close it with `{close}`"),
        });
        self.at = self.text.len();
    }

    fn skip_attribute(&mut self) {
        self.at = self.text.len() - self.text.trim_start().len();
        if self.rest().starts_with("#!") {
            self.at += self.rest().find(']').map_or(self.rest().len(), |end| end + 1);
        }
    }

    fn block_comment(&mut self) {
        let mut depth = 0_usize;
        let mut inside = 0;
        while inside < self.rest().len() {
            let here = &self.rest()[inside..];
            if here.starts_with("/*") {
                depth += 1;
                inside += 2;
            } else if here.starts_with("*/") {
                depth -= 1;
                inside += 2;
                if depth == 0 {
                    self.at += inside;
                    return;
                }
            } else {
                inside += here.chars().next().map_or(1, char::len_utf8);
            }
        }
        self.unclosed("a comment", "*/");
    }

    fn raw_string(&mut self, prefix: usize, hashes: usize) {
        let close = format!("\"{}", "#".repeat(hashes));
        let body = prefix + hashes + 1;
        match self.rest()[body..].find(&close) {
            Some(end) => self.push(Kind::Quoted, self.at + body + end + close.len()),
            None => self.unclosed("a string", &close),
        }
    }

    fn quoted(&mut self, prefix: usize, quote: char) {
        let mut escaped = false;
        for (offset, letter) in self.rest()[prefix..].char_indices() {
            if escaped {
                escaped = false;
            } else if letter == '\\' {
                escaped = true;
            } else if letter == quote {
                self.push(Kind::Quoted, self.at + prefix + offset + quote.len_utf8());
                return;
            }
        }
        self.unclosed("a string", &quote.to_string());
    }
}

fn is_word(letter: char) -> bool {
    letter.is_alphanumeric() || matches!(letter, '_' | '.' | '+' | '-')
}

/// The lengths of the prefix and of the hashes, if `text` begins with a raw string.
fn raw_string(text: &str) -> Option<(usize, usize)> {
    let prefix = if text.starts_with("br") { 2 } else { 1 };
    if prefix == 1 && !text.starts_with('r') {
        return None;
    }
    let hashes = text[prefix..].bytes().take_while(|byte| *byte == b'#').count();
    text[prefix + hashes..].starts_with('"').then_some((prefix, hashes))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn words(text: &str) -> Vec<&str> {
        tokens(text).0.into_iter().map(|token| &text[token.span]).collect()
    }

    #[test]
    fn comments_strings_and_an_attribute_are_seen_for_what_they_are() {
        assert_eq!(
            words(
                "#![enable(implicit_some)] // a ( here\n(a: \"b)//\\\"\", /* [ /* ( */ */ c: r#\"\"(\"#, d: -1.5e-3)"
            ),
            [
                "(",
                "a",
                ":",
                "\"b)//\\\"\"",
                ",",
                "c",
                ":",
                "r#\"\"(\"#",
                ",",
                "d",
                ":",
                "-1.5e-3",
                ")"
            ]
        );
    }

    #[test]
    fn what_is_never_closed_is_said_where_it_begins() {
        for (text, start) in [("(a: \"x", 4), ("( /* x", 2), ("(r#\"x\"", 1)] {
            assert_eq!(tokens(text).1.first[0].span.start, start);
        }
    }

    proptest! {
        #[test]
        fn any_text_gives_tokens_in_order_that_can_be_sliced(text in "[()\\[\\]{},:a-z0-9\"'#r/*!\\\\ \nüΩ.=-]{0,80}") {
            let mut end = 0;
            for token in tokens(&text).0 {
                prop_assert!(token.span.start >= end && !text[token.span.clone()].is_empty());
                end = token.span.end;
            }
        }
    }
}
