//! The text that is read: a file with the overrides worked into it. Knows where each byte of it came from.

use super::token::Span;

/// Where a stretch of the text came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The file, from this byte on.
    File(usize),
    /// An override, from this byte of its own text on.
    Override {
        /// Which, in the order given.
        index: usize,
        /// First byte.
        start: usize,
    },
    /// Text that stands for a whole part of an override.
    Around {
        /// Which, in the order given.
        index: usize,
        /// The part.
        span: Span,
    },
}

/// A stretch of text with one origin.
#[derive(Clone, Debug)]
pub struct Piece {
    /// The text.
    pub text: String,
    /// Where it came from.
    pub origin: Origin,
}

/// A place in the file or in an override.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location {
    /// The override; `None` is the file.
    pub override_index: Option<usize>,
    /// Bytes of its text.
    pub span: Span,
}

/// The text that is read.
#[derive(Clone, Debug)]
pub struct Source {
    text: String,
    pieces: Vec<Piece>,
}

impl Source {
    /// A file without overrides.
    pub fn new(file: &str) -> Self {
        Self::of(Piece {
            text: file.into(),
            origin: Origin::File(0),
        })
    }

    /// Text of one piece.
    pub fn of(piece: Piece) -> Self {
        Self {
            text: piece.text.clone(),
            pieces: vec![piece],
        }
    }

    /// The text, overrides included.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Puts `new` in the place of the bytes in `span`.
    pub fn replace(&mut self, span: &Span, new: Vec<Piece>) {
        let mut pieces = self.cut(0..span.start);
        pieces.extend(new);
        pieces.extend(self.cut(span.end..self.text.len()));
        self.text = pieces.iter().map(|piece| piece.text.as_str()).collect();
        self.pieces = pieces;
    }

    /// The pieces of a part of the text.
    pub fn cut(&self, span: Span) -> Vec<Piece> {
        let mut found = Vec::new();
        let mut start = 0;
        for piece in &self.pieces {
            let end = start + piece.text.len();
            let from = span.start.max(start);
            let to = span.end.min(end);
            if from < to {
                found.push(Piece {
                    text: self.text[from..to].into(),
                    origin: piece.origin.advanced(from - start),
                });
            }
            start = end;
        }
        found
    }

    /// Where the text in `span` came from.
    pub fn locate(&self, span: &Span) -> Location {
        let mut start = 0;
        for piece in &self.pieces {
            let end = start + piece.text.len();
            if span.start < end {
                let length = span.end.min(end).saturating_sub(span.start);
                return piece.origin.advanced(span.start - start).location(length);
            }
            start = end;
        }
        let file = self.pieces.iter().rev().find_map(|piece| match piece.origin {
            Origin::File(at) => Some(at + piece.text.len()),
            _ => None,
        });
        let end = file.unwrap_or_default();
        Location {
            override_index: None,
            span: end..end,
        }
    }
}

impl Origin {
    fn advanced(&self, by: usize) -> Self {
        match self {
            Self::File(start) => Self::File(start + by),
            Self::Override { index, start } => Self::Override {
                index: *index,
                start: start + by,
            },
            Self::Around { .. } => self.clone(),
        }
    }

    fn location(self, length: usize) -> Location {
        match self {
            Self::File(start) => Location {
                override_index: None,
                span: start..start + length,
            },
            Self::Override { index, start } => Location {
                override_index: Some(index),
                span: start..start + length,
            },
            Self::Around { index, span } => Location {
                override_index: Some(index),
                span,
            },
        }
    }
}

/// Overwrites the bytes in `span` with spaces, so that everything else keeps its line and column.
pub fn blank(text: &mut String, span: &Span) {
    let blanked = text.bytes().enumerate().map(|(at, byte)| {
        if span.contains(&at) && byte != b'\n' {
            b' '
        } else {
            byte
        }
    });
    if let Ok(blanked) = String::from_utf8(blanked.collect()) {
        *text = blanked;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_byte_is_traced_to_the_file_or_to_its_override() {
        let mut source = Source::new("(a: 1, b: 2)");
        let value = Piece {
            text: "300".into(),
            origin: Origin::Override { index: 0, start: 2 },
        };
        source.replace(&(4..5), vec![value]);
        assert_eq!(source.text(), "(a: 300, b: 2)");
        let place = |span: Span| {
            let found = source.locate(&span);
            (found.override_index, found.span)
        };
        assert_eq!(place(4..7), (Some(0), 2..5));
        assert_eq!(place(12..13), (None, 10..11));
        assert_eq!(place(0..14), (None, 0..4));
        assert_eq!(place(14..14), (None, 12..12));
    }
}
