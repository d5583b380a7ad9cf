//! Standard output and standard error. What they do not take is dropped: the exit status says what became of the command, whether
//! anybody reads or not.

use std::io::{self, IsTerminal, Write};
use std::os::fd::AsFd;

use terminal_size::{Width, terminal_size_of};

use crate::report::message;
use crate::text::{Style, clean_lines};

/// The least and the most columns that text is laid out for: beyond, lines are too long to read.
const WIDTHS: [usize; 2] = [20, 160];

/// One of the two streams; writing to it does not fail.
pub struct Output<S: Write> {
    stream: S,
    is_broken: bool,
}

/// Standard output. One line on standard error says if it cannot be written, unless because nobody reads it any more.
#[must_use]
pub fn stdout() -> Output<io::Stdout> {
    Output::to(io::stdout())
}

/// Standard error.
#[must_use]
pub fn stderr() -> Output<io::Stderr> {
    Output::to(io::stderr())
}

/// Says something on standard error: as it is, or within the width of a terminal.
pub fn say(words: &str) {
    let mut out = stderr();
    let _ = out.write_all(message(words, columns(&io::stderr())).as_bytes());
}

/// Colours where `stream` is a terminal, unless the user has switched them off; its width.
pub fn style(stream: &(impl IsTerminal + AsFd)) -> Style {
    Style {
        colour: stream.is_terminal() && std::env::var_os("NO_COLOR").is_none(),
        width: columns(stream).unwrap_or(Style::PLAIN.width),
    }
}

/// The columns to lay text out for, where that is known: what `COLUMNS` in the environment says, else what the terminal has.
pub fn columns(stream: &(impl IsTerminal + AsFd)) -> Option<usize> {
    let asked = std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    let terminal = || terminal_size_of(stream).map(|(Width(columns), _)| columns.into());
    let known = asked.filter(|columns| *columns > 0).or_else(terminal);
    let [least, most] = WIDTHS;
    known
        .filter(|columns| *columns > 0)
        .map(|columns: usize| columns.clamp(least, most))
}

impl<S: Write> Output<S> {
    fn to(stream: S) -> Self {
        Self {
            stream,
            is_broken: false,
        }
    }

    fn attempt(&mut self, write: impl FnOnce(&mut S) -> io::Result<()>) {
        if self.is_broken {
            return;
        }
        if let Err(error) = write(&mut self.stream) {
            self.is_broken = true;
            if error.kind() != io::ErrorKind::BrokenPipe {
                let _ = writeln!(io::stderr(), "cannot write all of the output: {error}");
            }
        }
    }
}

impl<S: Write> Write for Output<S> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.attempt(|stream| stream.write_all(bytes));
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.attempt(Write::flush);
        Ok(())
    }
}

impl<S: Write> Drop for Output<S> {
    fn drop(&mut self) {
        self.attempt(Write::flush);
    }
}

/// Lines of the log on standard error, safe to show.
pub struct Log;

impl Write for Log {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let _ = stderr().write_all(clean_lines(&String::from_utf8_lossy(bytes)).as_bytes());
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
