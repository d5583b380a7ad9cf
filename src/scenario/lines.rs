//! Lines and their indentation.

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
