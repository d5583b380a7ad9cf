//! Words on a terminal.

/// Columns that every line keeps within.
pub const WIDTH: usize = 80;

/// Breaks `words` at blanks into lines of at most `width` characters; a longer word stands alone.
pub fn wrap(words: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words.split(' ').filter(|word| !word.is_empty()) {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
