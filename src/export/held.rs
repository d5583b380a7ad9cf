//! Files held against what was written of them: lengths before contents, so that nothing is read that cannot be right; and documents
//! that hold a hash of themselves.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Read, Seek};
use std::path::{Component, Path};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::{Xxh3, xxh3_128};

use super::place::{FolderError, failed, json};

/// Longest document that holds a hash of itself, bytes: a million trials take less.
const LONGEST: u64 = 1 << 30;
/// What the line begins with in which a document holds its hash: a key of the outermost object, with which no other line begins.
const SEAL: &str = "  \"xxh3_128\": \"";

/// What is known of a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileEntry {
    /// Its length.
    pub bytes: u64,
    /// Its XXH3 hash of 128 bits, 32 hexadecimal digits.
    pub xxh3_128: String,
}

impl FileEntry {
    /// Of a file with this content.
    #[must_use]
    pub fn of(content: &[u8]) -> Self {
        Self {
            bytes: content.len() as u64,
            xxh3_128: hex(xxh3_128(content)),
        }
    }
}

fn hex(hash: u128) -> String {
    format!("{hash:032x}")
}

/// A value, which JSON writes as an object, as a document that holds the XXH3-128 hash of itself without the line of the hash.
///
/// # Panics
/// Never, for the types of this module: their keys are text.
pub fn sealed(value: &impl Serialize) -> Vec<u8> {
    let mut document = json(value);
    let seal = format!("{SEAL}{}\",\n", hex(xxh3_128(&document)));
    let first_line = document.iter().position(|byte| *byte == b'\n').map_or(0, |at| at + 1);
    document.splice(first_line..first_line, seal.into_bytes());
    document
}

/// The value in the document `name` of `dir`, which must be as it was [`sealed`].
pub fn unseal<T: DeserializeOwned>(dir: &Path, name: &str) -> Result<T, FolderError> {
    let path = dir.join(name);
    let altered = |wrong: String| FolderError::Altered {
        path: path.clone(),
        wrong,
    };
    let length = length(&path)?;
    if length > LONGEST {
        return Err(altered(format!("is too large for what it is ({length} bytes)")));
    }
    let mut document = read(&path, length)?;
    let starts = document.iter().enumerate().filter(|(_, byte)| **byte == b'\n');
    let mut starts = starts.map(|(at, _)| at + 1);
    let Some(start) = starts.find(|at| document[*at..].starts_with(SEAL.as_bytes())) else {
        return Err(altered(unsealed(&document)));
    };
    let end = starts.next().unwrap_or(document.len());
    let seal: Vec<u8> = document.splice(start..end, []).collect();
    if seal != format!("{SEAL}{}\",\n", hex(xxh3_128(&document))).as_bytes() {
        return Err(altered(
            "is not as desim wrote it (it does not fit its own hash)".to_owned(),
        ));
    }
    serde_json::from_slice(&document).map_err(|error| FolderError::version(&path, &error, "another"))
}

/// What is wrong with a document without a hash.
fn unsealed(document: &[u8]) -> String {
    match serde_json::from_slice::<serde_json::Value>(document) {
        Err(error) => format!("is damaged ({error})"),
        Ok(value) => format!(
            "holds no hash of itself: it has been edited, or written before desim kept one (by desim {}), and nothing vouches for the results",
            value["version"].as_str().unwrap_or("of an unknown version")
        ),
    }
}

/// Holds `files` of `dir` against what is known of them, all lengths before any content, and answers those that are `wanted`, open at
/// their beginning: they may be larger than the memory.
pub fn held(
    dir: &Path,
    files: &BTreeMap<String, FileEntry>,
    wanted: &[&str],
) -> Result<BTreeMap<String, File>, FolderError> {
    if let Some(name) = wanted.iter().find(|name| !files.contains_key(**name)) {
        return Err(FolderError::Altered {
            path: dir.join(name),
            wrong: "is not among the files of its manifest".to_owned(),
        });
    }
    for (name, entry) in files {
        let path = dir.join(name);
        let wrong = if is_inside(name) {
            wrong_length(length(&path)?, entry.bytes)
        } else {
            Some("leads out of the folder".to_owned())
        };
        if let Some(wrong) = wrong {
            return Err(FolderError::Altered { path, wrong });
        }
    }
    let mut kept = BTreeMap::new();
    for (name, entry) in files {
        let path = dir.join(name);
        let measured = File::open(&path).and_then(|mut file| {
            let there = measure_open(&mut file)?;
            file.rewind()?;
            Ok((there, file))
        });
        let (there, file) = measured.map_err(failed("read", &path))?;
        if wanted.contains(&name.as_str()) {
            kept.insert(name.clone(), file);
        }
        if there != *entry {
            let wrong = wrong_length(there.bytes, entry.bytes);
            let wrong = wrong.unwrap_or_else(|| {
                "is another file than desim wrote (its length is right, its hash is not)".to_owned()
            });
            return Err(FolderError::Altered { path, wrong });
        }
    }
    Ok(kept)
}

/// The value in the JSON document `name` of `dir`, one of `files`, which desim of this `version` wrote.
pub fn document<T: DeserializeOwned>(
    dir: &Path,
    name: &str,
    files: &mut BTreeMap<String, File>,
    version: &str,
) -> Result<T, FolderError> {
    let path = dir.join(name);
    let mut document = String::new();
    if let Some(mut file) = files.remove(name) {
        file.read_to_string(&mut document).map_err(failed("read", &path))?;
    }
    serde_json::from_str(&document).map_err(|error| FolderError::version(&path, &error, version))
}

/// Whether a file of this name is in the folder or below: desim writes no other, and whoever did must not lead out of it.
pub fn is_inside(name: &str) -> bool {
    let mut parts = Path::new(name).components();
    !name.is_empty() && !name.contains('\\') && parts.all(|part| matches!(part, Component::Normal(_)))
}

fn wrong_length(there: u64, right: u64) -> Option<String> {
    match () {
        () if there < right => Some(format!("is truncated, or another file ({there} of {right} bytes)")),
        () if there > right => Some(format!("is another file than desim wrote ({there} bytes, not {right})")),
        () => None,
    }
}

/// The length of a file that can be read to its end: no folder, no pipe, no device.
fn length(path: &Path) -> Result<u64, FolderError> {
    let altered = |wrong: &str| {
        Err(FolderError::Altered {
            path: path.to_owned(),
            wrong: wrong.to_owned(),
        })
    };
    match fs::metadata(path) {
        Ok(there) if there.is_file() => Ok(there.len()),
        Ok(there) if there.is_dir() => altered("is a folder, and no file"),
        Ok(_) => altered("is no file with an end"),
        Err(error) if error.kind() == io::ErrorKind::NotFound => altered("is missing"),
        Err(error) => Err(failed("read", path)(error)),
    }
}

/// The content of a file of this length; a byte more, should it have grown meanwhile.
fn read(path: &Path, length: u64) -> Result<Vec<u8>, FolderError> {
    let mut content = Vec::new();
    File::open(path)
        .and_then(|file| file.take(length + 1).read_to_end(&mut content))
        .map_err(failed("read", path))?;
    Ok(content)
}

/// Length and hash of a file, however large.
pub fn measure(path: &Path) -> io::Result<FileEntry> {
    measure_open(&mut File::open(path)?)
}

fn measure_open(file: &mut File) -> io::Result<FileEntry> {
    let (mut hash, mut bytes, mut chunk) = (Xxh3::new(), 0, vec![0; 1 << 16]);
    loop {
        let read = file.read(&mut chunk)?;
        if read == 0 {
            return Ok(FileEntry {
                bytes,
                xxh3_128: hex(hash.digest128()),
            });
        }
        hash.update(&chunk[..read]);
        bytes += read as u64;
    }
}
