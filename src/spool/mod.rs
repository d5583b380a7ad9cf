//! Lists that grow with simulated time and may outgrow memory: [`Spool`]; and tables of numbers that grow with the number of trials:
//! [`Columns`].
//!
//! What a run keeps of every suspicion or sample would fill the memory of a machine on a long day. A spool keeps its latest entries in memory
//! and the earlier ones in a file without a name, which is gone with the process, whatever ends it.

mod columns;
mod entry;
mod iter;
mod spilled;

use std::fmt;
use std::io::{self, Write};
use std::marker::PhantomData;
use std::path::Path;
use std::sync::Arc;

use serde::de::{SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

pub use columns::Columns;
pub use entry::Entry;
pub(crate) use entry::entry;
pub use iter::Iter;
pub use spilled::Section;

use spilled::Spilled;

/// Bytes that a spool holds in memory before its earlier entries go to a file, and what of them stays: the latest are those that change.
const MOST: usize = 4 << 20;
const STAYS: usize = 1 << 20;

/// The folder where spools have their files; by default the system's for temporary files.
#[derive(Clone, Debug, Default)]
pub struct Scratch(Option<Arc<Path>>);

impl Scratch {
    /// The folder `dir`.
    #[must_use]
    pub fn in_folder(dir: &Path) -> Self {
        Self(Some(dir.into()))
    }

    fn folder(&self) -> Option<&Path> {
        self.0.as_deref()
    }
}

/// A list of entries that may outgrow memory. All entries are of the same length in bytes; they are read by value, in any order.
///
/// A file system that has no room for it makes a spool stay in memory: nothing is lost.
///
/// ```
/// use desim::spool::Spool;
///
/// let mut squares: Spool<u64> = (0..1_000_000_u64).map(|number| number * number).collect();
/// squares.change(3, |square| *square += 1);
/// assert_eq!((squares.len(), squares.get(3), squares.last()), (1_000_000, Some(10), Some(999_998_000_001)));
/// assert_eq!(squares.iter().rev().take(2).sum::<u64>(), 999_998_000_001 + 999_996_000_004);
/// ```
#[derive(Clone)]
pub struct Spool<T> {
    scratch: Scratch,
    /// Bytes of an entry; known from the first on.
    width: usize,
    /// The earlier entries, if there are so many.
    spilled: Option<Spilled>,
    /// The later ones.
    tail: Vec<u8>,
    /// Whether the file system refused.
    stays: bool,
    entries: PhantomData<T>,
}

impl<T> Default for Spool<T> {
    fn default() -> Self {
        Self::new(&Scratch::default())
    }
}

impl<T> Spool<T> {
    /// An empty list.
    #[must_use]
    pub fn new(scratch: &Scratch) -> Self {
        Self {
            scratch: scratch.clone(),
            width: 0,
            spilled: None,
            tail: Vec::new(),
            stays: false,
            entries: PhantomData,
        }
    }

    /// How many entries there are.
    #[must_use]
    pub fn len(&self) -> usize {
        (self.in_file() + self.tail.len()).checked_div(self.width).unwrap_or(0)
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bytes that are in the file.
    fn in_file(&self) -> usize {
        self.spilled.as_ref().map_or(0, Spilled::len)
    }
}

impl<T: Entry> Spool<T> {
    /// Adds an entry.
    ///
    /// # Panics
    /// If it is not as long as those before.
    pub fn push(&mut self, entry: &T) {
        let before = self.tail.len();
        entry.put(&mut self.tail);
        let width = self.tail.len() - before;
        if self.width == 0 {
            self.width = width;
        }
        assert!(
            width == self.width && width > 0,
            "entries of one list are of one length"
        );
        if self.tail.len() >= MOST && !self.stays {
            self.spill();
        }
    }

    /// Entry number `place`, from 0.
    ///
    /// # Panics
    /// If the file cannot be read.
    #[must_use]
    pub fn get(&self, place: usize) -> Option<T> {
        self.iter().nth(place)
    }

    /// The first entry.
    ///
    /// # Panics
    /// If the file cannot be read.
    #[must_use]
    pub fn first(&self) -> Option<T> {
        self.get(0)
    }

    /// The last entry.
    ///
    /// # Panics
    /// If the file cannot be read.
    #[must_use]
    pub fn last(&self) -> Option<T> {
        self.iter().next_back()
    }

    /// Changes entry number `place`, and answers how it is then.
    ///
    /// # Panics
    /// If there is no such entry, or it is of another length then, or the file cannot be read or written.
    pub fn change(&mut self, place: usize, change: impl FnOnce(&mut T)) -> T {
        let entry = self.get(place);
        let mut entry = entry.unwrap_or_else(|| panic!("of {} entries none is number {place}", self.len()));
        change(&mut entry);
        self.set(place, &entry);
        entry
    }

    fn set(&mut self, place: usize, entry: &T) {
        let mut bytes = Vec::with_capacity(self.width);
        entry.put(&mut bytes);
        assert_eq!(bytes.len(), self.width, "entries of one list are of one length");
        let at = place * self.width;
        let (in_file, scratch) = (self.in_file(), &self.scratch);
        match &mut self.spilled {
            Some(spilled) if at < in_file => spilled
                .write(at, &bytes, scratch.folder())
                .unwrap_or_else(|error| unreadable(&error)),
            _ => self.tail[at - in_file..][..self.width].copy_from_slice(&bytes),
        }
    }

    /// The entries, in order.
    #[must_use]
    pub fn iter(&self) -> Iter<'_, T> {
        Iter::new(self)
    }

    /// Moves the earlier entries of those in memory into the file.
    fn spill(&mut self) {
        let stays = STAYS / self.width * self.width;
        let goes = self.tail.len() - stays;
        let spilled = match &mut self.spilled {
            Some(spilled) => spilled.append(&self.tail[..goes], self.scratch.folder()),
            none => Spilled::of(&self.tail[..goes], self.scratch.folder()).map(|spilled| *none = Some(spilled)),
        };
        match spilled {
            Ok(()) => drop(self.tail.drain(..goes)),
            Err(error) => {
                tracing::warn!(%error, "no room for a file: what a run keeps stays in memory");
                self.stays = true;
            }
        }
    }
}

/// A list of whatever entries, as whoever keeps it in a file sees it.
pub trait Spooled {
    /// How many entries there are, and how many bytes each takes.
    fn shape(&self) -> Shape;

    /// Writes the bytes of all entries.
    ///
    /// # Errors
    /// If they cannot be written, or read.
    fn write_to(&self, into: &mut dyn Write) -> io::Result<()>;

    /// Makes it the list of this shape whose bytes are those of `section`: in memory if it is short, else in the file.
    ///
    /// # Errors
    /// If the file cannot be read, or holds something else.
    fn restore(&mut self, shape: Shape, section: Section) -> io::Result<()>;
}

/// A file of one's own that cannot be read or written is no input to complain about: the machine fails.
fn unreadable<T>(error: &io::Error) -> T {
    panic!("what a run has kept in a file cannot be read again: {error}")
}

/// How long a list is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shape {
    /// Entries.
    pub entries: usize,
    /// Bytes of an entry.
    pub width: usize,
}

impl Shape {
    /// Bytes of all entries.
    #[must_use]
    pub fn bytes(self) -> usize {
        self.entries.saturating_mul(self.width)
    }
}

impl<T: Entry> Spooled for Spool<T> {
    fn shape(&self) -> Shape {
        Shape {
            entries: self.len(),
            width: self.width,
        }
    }

    fn write_to(&self, into: &mut dyn Write) -> io::Result<()> {
        if let Some(spilled) = &self.spilled {
            spilled.write_to(into)?;
        }
        into.write_all(&self.tail)
    }

    fn restore(&mut self, shape: Shape, section: Section) -> io::Result<()> {
        let spilled = Spilled::from_section(section, shape.bytes());
        let first = spilled.read(0, shape.width.min(shape.bytes()))?;
        if shape.entries > 0 && !is_entry::<T>(&first) {
            return Err(io::Error::other("an entry is not what it should be"));
        }
        self.width = shape.width;
        (self.spilled, self.tail) = if shape.bytes() < MOST {
            (None, spilled.read(0, shape.bytes())?)
        } else {
            (Some(spilled), Vec::new())
        };
        Ok(())
    }
}

/// Whether `bytes` are those of an entry, all of them.
fn is_entry<T: Entry>(mut bytes: &[u8]) -> bool {
    !bytes.is_empty() && T::take(&mut bytes).is_some() && bytes.is_empty()
}

impl<T: Entry + fmt::Debug> fmt::Debug for Spool<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self).finish()
    }
}

impl<T: Entry + PartialEq> PartialEq for Spool<T> {
    fn eq(&self, other: &Self) -> bool {
        self.len() == other.len() && self.iter().eq(other)
    }
}

impl<T: Entry> FromIterator<T> for Spool<T> {
    fn from_iter<I: IntoIterator<Item = T>>(entries: I) -> Self {
        let mut spool = Self::default();
        spool.extend(entries);
        spool
    }
}

impl<T: Entry> Extend<T> for Spool<T> {
    fn extend<I: IntoIterator<Item = T>>(&mut self, entries: I) {
        entries.into_iter().for_each(|entry| self.push(&entry));
    }
}

impl<'a, T: Entry> IntoIterator for &'a Spool<T> {
    type Item = T;
    type IntoIter = Iter<'a, T>;

    fn into_iter(self) -> Iter<'a, T> {
        self.iter()
    }
}

impl<T: Entry + Serialize> Serialize for Spool<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self)
    }
}

impl<'de, T: Entry + Deserialize<'de>> Deserialize<'de> for Spool<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(One(PhantomData))
    }
}

/// Reads a list entry by entry.
struct One<T>(PhantomData<T>);

impl<'de, T: Entry + Deserialize<'de>> Visitor<'de> for One<T> {
    type Value = Spool<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Spool<T>, A::Error> {
        let mut spool = Spool::default();
        while let Some(entry) = list.next_element()? {
            spool.push(&entry);
        }
        Ok(spool)
    }
}

#[cfg(test)]
mod tests;
