//! The part of a list that is in a file.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Bytes that are copied at a time.
const BLOCK: usize = 1 << 16;

/// A file, and where in it something begins.
#[derive(Clone, Debug)]
pub struct Section {
    file: Arc<Mutex<File>>,
    start: u64,
}

impl Section {
    /// What begins at byte `start` of `file`.
    #[must_use]
    pub fn of(file: File, start: u64) -> Self {
        Self {
            file: Arc::new(Mutex::new(file)),
            start,
        }
    }

    /// What begins so many bytes later.
    #[must_use]
    pub fn after(&self, bytes: usize) -> Self {
        Self {
            file: Arc::clone(&self.file),
            start: self.start + bytes as u64,
        }
    }

    /// How many bytes there are up to the end of the file.
    ///
    /// # Errors
    /// If the file system does not say so.
    pub fn length(&self) -> io::Result<u64> {
        Ok(self.file().metadata()?.len().saturating_sub(self.start))
    }

    /// Reads bytes from byte `place` on, and says how many, as [`Read::read`] does. Whoever else reads the file meanwhile is not disturbed.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn read(&self, place: u64, into: &mut [u8]) -> io::Result<usize> {
        self.at(place)?.read(into)
    }

    fn at(&self, place: u64) -> io::Result<MutexGuard<'_, File>> {
        let mut file = self.file();
        file.seek(SeekFrom::Start(self.start + place))?;
        Ok(file)
    }

    fn file(&self) -> MutexGuard<'_, File> {
        self.file.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Bytes in a file: of this list alone, or those of another that it was copied from, or of a finished trial.
#[derive(Clone, Debug)]
pub struct Spilled {
    section: Section,
    len: usize,
    /// Whether the file was made for it.
    is_own: bool,
}

impl Spilled {
    /// A file of its own in `folder`, or among the system's temporary files, that holds `bytes`.
    pub fn of(bytes: &[u8], folder: Option<&Path>) -> io::Result<Self> {
        let mut file = match folder {
            Some(folder) => tempfile::tempfile_in(folder)?,
            None => tempfile::tempfile()?,
        };
        file.write_all(bytes)?;
        Ok(Self {
            section: Section::of(file, 0),
            len: bytes.len(),
            is_own: true,
        })
    }

    /// So many bytes of a file that is not to be written.
    pub fn from_section(section: Section, len: usize) -> Self {
        Self {
            section,
            len,
            is_own: false,
        }
    }

    /// How many bytes there are.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Adds `bytes`. If that fails, there is what there was.
    pub fn append(&mut self, bytes: &[u8], folder: Option<&Path>) -> io::Result<()> {
        self.make_own(folder)?;
        self.section.at(self.len as u64)?.write_all(bytes)?;
        self.len += bytes.len();
        Ok(())
    }

    /// Writes `bytes` over those at `place`.
    pub fn write(&mut self, place: usize, bytes: &[u8], folder: Option<&Path>) -> io::Result<()> {
        self.make_own(folder)?;
        self.section.at(place as u64)?.write_all(bytes)
    }

    /// `len` bytes from `place` on.
    pub fn read(&self, place: usize, len: usize) -> io::Result<Vec<u8>> {
        let mut bytes = vec![0; len];
        self.section.at(place as u64)?.read_exact(&mut bytes)?;
        Ok(bytes)
    }

    /// Writes all bytes.
    pub fn write_to(&self, into: &mut dyn Write) -> io::Result<()> {
        for place in (0..self.len).step_by(BLOCK) {
            into.write_all(&self.read(place, BLOCK.min(self.len - place))?)?;
        }
        Ok(())
    }

    /// Moves the bytes into a file of their own, if others read the one that they are in.
    fn make_own(&mut self, folder: Option<&Path>) -> io::Result<()> {
        if self.is_own && Arc::strong_count(&self.section.file) == 1 {
            return Ok(());
        }
        let copy = Self::of(&[], folder)?;
        self.write_to(&mut &*copy.section.at(0)?)?;
        *self = Self { len: self.len, ..copy };
        Ok(())
    }
}
