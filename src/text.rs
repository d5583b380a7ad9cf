//! Text on its way to a reader: what others wrote made safe to show, and the columns that it takes.
//!
//! Names, questions, labels and paths come from files and from the command line. A control character among them could move the
//! cursor, colour what follows or forge a line; a mark of writing direction could reorder it; a letter without width could hide
//! in it. [`clean`] shows each of them as a sign.

use std::borrow::Cow;
use std::path::Path;

use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// How text is laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// Whether to use colours.
    pub colour: bool,
    /// Columns that lines keep within.
    pub width: usize,
}

impl Style {
    /// No colour, 80 columns.
    pub const PLAIN: Self = Self {
        colour: false,
        width: 80,
    };
}

/// `text` with a sign for each character that a reader could not see, or that a terminal would obey.
#[must_use]
pub fn clean(text: &str) -> Cow<'_, str> {
    clean_but(text, &[])
}

/// As [`clean`], for text of several lines: line feeds and tabs stay.
#[must_use]
pub fn clean_lines(text: &str) -> Cow<'_, str> {
    clean_but(text, &['\n', '\t'])
}

/// A path as it is shown.
#[must_use]
pub fn shown(path: &Path) -> String {
    clean(&path.display().to_string()).into_owned()
}

/// Whether [`clean`] has a sign for `letter`.
#[must_use]
pub fn is_unsafe(letter: char) -> bool {
    sign(letter).is_some()
}

/// Columns that `text` takes on a terminal.
#[must_use]
pub fn columns(text: &str) -> usize {
    text.width()
}

/// Breaks `words` at blanks, but not before a percent sign, and between letters of double width, into lines of at most `width`
/// columns; a longer word stands alone.
#[must_use]
pub fn wrap(words: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let mut room = 0;
    for word in bound(words) {
        let mut blank = " ";
        for piece in pieces(word) {
            let taken = columns(piece) + blank.len();
            match lines.last_mut() {
                Some(line) if taken <= room => {
                    line.push_str(blank);
                    line.push_str(piece);
                    room -= taken;
                }
                _ => {
                    lines.push(piece.to_owned());
                    room = width.saturating_sub(columns(piece));
                }
            }
            blank = "";
        }
    }
    lines
}

/// The words, a number and its percent sign being one.
fn bound(words: &str) -> Vec<&str> {
    let mut bound: Vec<&str> = Vec::new();
    let mut start = 0;
    for word in words.split(' ') {
        let end = start + word.len();
        match bound.last_mut() {
            Some(last) if word.starts_with('%') => {
                let begin = start - 1 - last.len();
                *last = &words[begin..end];
            }
            _ => bound.push(word),
        }
        start = end + 1;
    }
    bound.retain(|word| !word.is_empty());
    bound
}

fn clean_but<'a>(text: &'a str, kept: &[char]) -> Cow<'a, str> {
    let sign = |letter: char| sign(letter).filter(|_| !kept.contains(&letter));
    if text.chars().all(|letter| sign(letter).is_none()) {
        return Cow::Borrowed(text);
    }
    Cow::Owned(text.chars().map(|letter| sign(letter).unwrap_or(letter)).collect())
}

/// What is shown in the place of a character that is not: a control character's picture, or the sign for what cannot be shown.
fn sign(letter: char) -> Option<char> {
    match letter {
        '\0'..='\u{1f}' => char::from_u32(0x2400 + u32::from(letter)),
        '\u{7f}' => Some('\u{2421}'),
        _ if is_unseen(letter) => Some(char::REPLACEMENT_CHARACTER),
        _ => None,
    }
}

/// Controls beyond ASCII, marks of direction, separators of lines, fillers, and letters without width that join nothing visible.
fn is_unseen(letter: char) -> bool {
    matches!(letter,
        '\u{80}'..='\u{9f}' | '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}'
        | '\u{180b}'..='\u{180f}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{3164}'
        | '\u{feff}' | '\u{ffa0}' | '\u{fff0}'..='\u{fffb}' | '\u{1bca0}'..='\u{1bca3}' | '\u{1d173}'..='\u{1d17a}'
        | '\u{e0000}'..='\u{e0fff}')
}

/// A word cut where a line may break within it: before and after letters of double width.
fn pieces(word: &str) -> Vec<&str> {
    let mut pieces = Vec::new();
    let (mut start, mut after_wide) = (0, false);
    for (at, letter) in word.char_indices() {
        let width = letter.width().unwrap_or(0);
        if at > start && (width > 1 || after_wide && width > 0) {
            pieces.push(&word[start..at]);
            start = at;
        }
        // A mark without width belongs to the letter before it.
        after_wide = width > 1 || after_wide && width == 0;
    }
    pieces.push(&word[start..]);
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_a_terminal_would_obey_is_shown_as_a_sign() {
        assert_eq!(clean("a\u{1b}[31mred\u{7}\r\n\tb"), "a␛[31mred␇␍␊␉b");
        assert_eq!(clean("\u{9b}2J\u{202e}gpj.exe\u{200b}\u{feff}x"), "�2J�gpj.exe��x");
        assert_eq!(clean_lines("one\n\ttwo\u{8}"), "one\n\ttwo␈");
        assert!(matches!(clean("Größe λ₂ 漢字 é 🤖"), Cow::Borrowed(_)));
    }

    #[test]
    fn words_are_counted_by_the_columns_that_they_take() {
        assert_eq!(wrap("漢字 ab cd", 7), ["漢字 ab", "cd"]);
        assert_eq!(wrap("漢字漢字漢字", 5), ["漢字", "漢字", "漢字"]);
        // Combining accents take none.
        assert_eq!(wrap("e\u{301}e\u{301} e\u{301}", 4), ["e\u{301}e\u{301} e\u{301}"]);
        assert_eq!(wrap("a-word-that-is-long x", 5), ["a-word-that-is-long", "x"]);
        assert_eq!(wrap("about 5.00 %, or", 10), ["about", "5.00 %, or"]);
    }

    proptest! {
        #[test]
        fn nothing_clean_holds_a_control_character(text in any::<String>()) {
            prop_assert!(!clean(&text).chars().any(|letter| letter.is_control() || is_unsafe(letter)));
        }

        #[test]
        fn lines_keep_within_their_width_and_lose_no_word(words in "([a-zé漢字]{1,9} ){0,30}", width in 18_usize..60) {
            let lines = wrap(&words, width);
            prop_assert!(lines.iter().all(|line| columns(line) <= width), "{lines:?}");
            let letters = |text: &str| text.replace(' ', "");
            prop_assert_eq!(letters(&lines.concat()), letters(&words));
        }
    }
}
