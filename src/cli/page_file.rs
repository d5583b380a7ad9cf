//! The page of charts at a place of the user's: whole or not at all, and over nothing but another page.

use std::ffi::OsString;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Read, Write};
use std::os::fd::AsFd;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use super::failure::Failure;
use super::output::{self, say};
use crate::report::PAGE_MARK;
use crate::text::shown;

/// Where a page has gone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Into a file, a pipe or a device.
    File,
    /// To standard output, which has nothing else on it then.
    Output,
}

/// Writes a page, usually called `name`, to `file`, and says what it `holds`.
///
/// A file is replaced once the page is whole; a link stays one. A pipe or a device, which has nothing to replace, is written to.
///
/// # Errors
/// If something else is there, or the file system refuses.
pub fn write(file: &Path, page: &str, name: &str, holds: &str) -> Result<Place, Failure> {
    let failed = |error: io::Error| Failure::Other(format!("error: cannot write {}: {error}", shown(file)));
    let written = match fs::metadata(file) {
        Ok(there) if is_stdout(&there) => {
            let _ = output::stdout().write_all(page.as_bytes());
            return Ok(Place::Output);
        }
        Ok(there) if there.is_dir() => {
            return Err(Failure::Input(format!(
                "error: {} is a folder: give a file, such as --out {}",
                shown(file),
                shown(&file.join(name))
            )));
        }
        Ok(there) if there.is_file() => {
            if !is_page(file).map_err(failed)? {
                return Err(Failure::Input(format!(
                    "error: {} is no page of desim: choose another file with --out",
                    shown(file)
                )));
            }
            fs::canonicalize(file).and_then(|target| replace(&target, page, Some(&there)))
        }
        Ok(_) => OpenOptions::new()
            .write(true)
            .open(file)
            .and_then(|mut stream| stream.write_all(page.as_bytes())),
        Err(error) if error.kind() == io::ErrorKind::NotFound && file.is_symlink() => {
            return Err(Failure::Input(format!(
                "error: {} is a link to nothing: give a file with --out",
                shown(file)
            )));
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => replace(file, page, None),
        Err(error) => Err(error),
    };
    written.map_err(failed)?;
    say(&format!("{} {holds}", shown(file)));
    Ok(Place::File)
}

/// Whether this is what standard output goes to.
fn is_stdout(there: &Metadata) -> bool {
    let stdout = io::stdout().as_fd().try_clone_to_owned();
    let stdout = stdout.and_then(|stdout| File::from(stdout).metadata());
    stdout.is_ok_and(|stdout| (stdout.dev(), stdout.ino()) == (there.dev(), there.ino()))
}

/// Whether a file is a page of desim's, which has its mark near its beginning.
fn is_page(file: &Path) -> io::Result<bool> {
    let mut beginning = Vec::new();
    File::open(file)?.take(1024).read_to_end(&mut beginning)?;
    Ok(String::from_utf8_lossy(&beginning).contains(PAGE_MARK))
}

/// Writes beside `file` first, under a name that a later attempt uses again.
fn replace(file: &Path, page: &str, there: Option<&Metadata>) -> io::Result<()> {
    let unfinished = beside(file)?;
    match fs::remove_file(&unfinished) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    let written = File::create_new(&unfinished)
        .and_then(|mut beside| beside.write_all(page.as_bytes()))
        .and_then(|()| there.map_or(Ok(()), |there| fs::set_permissions(&unfinished, there.permissions())))
        .and_then(|()| fs::rename(&unfinished, file));
    if written.is_err() {
        let _ = fs::remove_file(&unfinished);
    }
    written
}

fn beside(file: &Path) -> io::Result<PathBuf> {
    let name = file.file_name().ok_or(io::ErrorKind::InvalidFilename)?;
    let mut unfinished = OsString::from(".");
    unfinished.push(name);
    unfinished.push(".unfinished");
    Ok(file.with_file_name(unfinished))
}
