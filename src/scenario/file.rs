//! Scenario files as a whole: reading one from disk, and the question that it answers.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use super::diagnostic::{Diagnostic, Place};
use super::overrides::Override;
use super::read::parse;
use super::report::Report;
use super::{Scenario, limits};

/// Reads the scenario file at `path`, with `overrides` worked in, in order.
///
/// # Errors
/// If the file cannot be read, or everything that is wrong with the scenario.
pub fn load(path: &Path, overrides: &[Override]) -> Result<Scenario, Report> {
    parse(&path.display().to_string(), &contents(path)?, overrides)
}

/// The text of the scenario file at `path`, without a byte order mark.
///
/// # Errors
/// If it cannot be read, is too large to be a scenario, or is not UTF-8.
pub fn contents(path: &Path) -> Result<String, Report> {
    let refused = |message: String, help: &str| Diagnostic {
        message: format!("{}: {message}", path.display()),
        help: Some(help.into()),
        path: None,
        place: None,
    };
    let bytes = bytes(path).map_err(|error| {
        let help = "give the path of a scenario file, such as scenarios/quickstart.ron";
        refused(format!("cannot be read: {error}"), help)
    })?;
    if bytes.len() as u64 > limits::FILE {
        let help = format!("a scenario file has at most {} MiB", limits::FILE >> 20);
        return Err(refused("too large".into(), &help).into());
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let text = String::from_utf8_lossy(error.as_bytes()).into();
        Diagnostic {
            place: Some(Place::new(
                &path.display().to_string(),
                &text,
                at..at + char::REPLACEMENT_CHARACTER.len_utf8(),
                "this byte",
            )),
            ..refused("not UTF-8 text".into(), "save the file as UTF-8")
        }
    })?;
    Ok(match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.into(),
        None => text,
    })
}

fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(limits::FILE + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The question that a scenario file answers: the comment it begins with, up to the first line that is none.
#[must_use]
pub fn question(text: &str) -> Option<String> {
    let lines = text.trim_start().lines().map(str::trim);
    let comment = lines.map_while(|line| line.strip_prefix("//"));
    let words: Vec<_> = comment.map(str::trim).take_while(|line| !line.is_empty()).collect();
    (!words.is_empty()).then(|| words.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_question_is_the_first_comment_joined_to_one_line() {
        assert_eq!(
            question("// Does it\n// work?\n//\n// Notes.\nScenario()").as_deref(),
            Some("Does it work?")
        );
        assert_eq!(question("Scenario() // no"), None);
        assert_eq!(question(""), None);
    }
}
