//! The file of a finished trial: a line of JSON whose numbers read back bit for bit, then the entries of the record's long lists, then a line with
//! the XXH3-128 hash of both.

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Read, Seek, Write};

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3;

use crate::metrics::{Lists, TrialRecord};
use crate::spool::{Section, Shape};

/// A trial and what it took.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FinishedTrial {
    /// Wall time that its thread spent on it, seconds. Depends on the machine: for the manifest only.
    pub wall_s: f64,
    /// What it left behind.
    pub record: TrialRecord,
}

/// What a finished trial is of: a hash of everything that its result depends on, but its number. Trials of another key are other trials.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Key(#[serde(with = "hexadecimal")] pub u128);

/// JSON has no numbers of 128 bits.
mod hexadecimal {
    use serde::{Deserialize, Deserializer, Serializer, de};

    #[allow(clippy::trivially_copy_pass_by_ref)] // As serde calls it.
    pub fn serialize<S: Serializer>(hash: &u128, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(&format_args!("{hash:032x}"))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u128, D::Error> {
        let text = String::deserialize(deserializer)?;
        u128::from_str_radix(&text, 16).map_err(de::Error::custom)
    }
}

/// The first line of a file.
#[derive(Serialize, Deserialize)]
struct Head<P> {
    /// What the trial is of.
    of: Key,
    /// The trial without its long lists.
    part: P,
    /// How long these are, in the order in which their entries follow.
    lists: Vec<Shape>,
}

/// What a file says of itself without being read whole.
#[derive(Deserialize)]
pub struct Label {
    /// What the trial is of.
    pub of: Key,
    part: NumberedPart,
}

#[derive(Deserialize)]
struct NumberedPart {
    record: Numbered,
}

#[derive(Deserialize)]
struct Numbered {
    trial: u32,
}

impl Label {
    /// Number of the trial.
    pub fn trial(&self) -> u32 {
        self.part.record.trial
    }
}

/// Writes a trial of `key`.
pub fn write(file: &File, key: Key, part: &mut FinishedTrial) -> io::Result<()> {
    let mut lists = Lists::default();
    part.record.exchange(&mut lists);
    let written = write_apart(file, key, part, &mut lists);
    part.record.exchange(&mut lists);
    written
}

fn write_apart(file: &File, key: Key, part: &FinishedTrial, lists: &mut Lists) -> io::Result<()> {
    let mut file = Hashing::new(BufWriter::new(file));
    let lists = lists.all();
    let head = Head {
        of: key,
        part,
        lists: lists.iter().map(|list| list.shape()).collect(),
    };
    serde_json::to_writer(&mut file, &head)?;
    file.write_all(b"\n")?;
    for list in lists {
        list.write_to(&mut file)?;
    }
    let Hashing { mut inner, hash } = file;
    inner.write_all(&hash_line(&hash))?;
    inner.flush()
}

/// Holds the whole file against its hash, and leaves it at its beginning.
pub fn verify(mut file: &File) -> io::Result<()> {
    let length = file.metadata()?.len();
    let Some(end) = length.checked_sub(HASH_LINE) else {
        return Err(io::Error::other("it has no hash"));
    };
    let mut whole = Hashing::new(io::sink());
    io::copy(&mut file.take(end), &mut whole)?;
    let mut kept = Vec::new();
    file.read_to_end(&mut kept)?;
    if kept != hash_line(&whole.hash) {
        return Err(io::Error::other("it does not fit its hash"));
    }
    file.rewind()
}

/// What a file says of itself that has been [verified](verify).
pub fn label(file: &File) -> io::Result<Label> {
    Ok(serde_json::from_slice(&head(file)?)?)
}

/// Reads a file that has been [verified](verify): a trial, and what it is of.
pub fn read(file: File) -> io::Result<(Key, FinishedTrial)> {
    let line = head(&file)?;
    let Head {
        of,
        mut part,
        lists: shapes,
    } = serde_json::from_slice::<Head<FinishedTrial>>(&line)?;
    let mut lists = Lists::default();
    let mut section = Section::of(file, line.len() as u64);
    if shapes.len() != lists.all().len() {
        return Err(io::Error::other("it holds other lists than a trial has"));
    }
    for (list, shape) in lists.all().into_iter().zip(shapes) {
        list.restore(shape, section.clone())?;
        section = section.after(shape.bytes());
    }
    part.record.exchange(&mut lists);
    Ok((of, part))
}

/// The first line of a file at its beginning.
fn head(file: &File) -> io::Result<Vec<u8>> {
    let mut line = Vec::new();
    BufReader::new(file).read_until(b'\n', &mut line)?;
    Ok(line)
}

/// Bytes of [`hash_line`].
const HASH_LINE: u64 = 33;

/// The last line of a file.
fn hash_line(hash: &Xxh3) -> Vec<u8> {
    format!("{:032x}\n", hash.digest128()).into_bytes()
}

/// Hashes what goes through it.
struct Hashing<W> {
    inner: W,
    hash: Xxh3,
}

impl<W> Hashing<W> {
    fn new(inner: W) -> Self {
        Self {
            inner,
            hash: Xxh3::new(),
        }
    }
}

impl<W: Write> Write for Hashing<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.hash.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}
