//! Reading a list, from either end.

use std::marker::PhantomData;
use std::ops::Range;

use super::{Entry, Spool, unreadable};

/// Bytes that are read at a time.
const BLOCK: usize = 1 << 16;

/// The entries of a [`Spool`], in order. It reads the file in blocks, so that jumping costs and going on does not.
#[derive(Clone)]
pub struct Iter<'a, T> {
    spool: &'a Spool<T>,
    left: Range<usize>,
    /// The block of the file read last, and the bytes of it.
    block: (usize, Vec<u8>),
    entries: PhantomData<T>,
}

impl<'a, T: Entry> Iter<'a, T> {
    pub(super) fn new(spool: &'a Spool<T>) -> Self {
        Self {
            spool,
            left: 0..spool.len(),
            block: (0, Vec::new()),
            entries: PhantomData,
        }
    }

    fn read(&mut self, place: usize) -> T {
        let Spool { width, tail, .. } = self.spool;
        let at = place * width;
        let bytes = match (&self.spool.spilled, at.checked_sub(self.spool.in_file())) {
            (_, Some(at)) => &tail[at..],
            (None, None) => unreachable!("what is not in memory is in a file"),
            (Some(spilled), None) => {
                let size = (BLOCK / width).max(1) * width;
                let block = at / size;
                if self.block.1.is_empty() || self.block.0 != block {
                    let start = block * size;
                    let bytes = spilled.read(start, size.min(spilled.len() - start));
                    self.block = (block, bytes.unwrap_or_else(|error| unreadable(&error)));
                }
                &self.block.1[at % size..]
            }
        };
        T::take(&mut &bytes[..*width]).unwrap_or_else(|| panic!("entry {place} of a list is none"))
    }
}

impl<T: Entry> Iterator for Iter<'_, T> {
    type Item = T;

    fn next(&mut self) -> Option<T> {
        let place = self.left.next()?;
        Some(self.read(place))
    }

    fn nth(&mut self, skip: usize) -> Option<T> {
        let place = self.left.nth(skip)?;
        Some(self.read(place))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.left.size_hint()
    }

    fn count(self) -> usize {
        self.left.len()
    }
}

impl<T: Entry> DoubleEndedIterator for Iter<'_, T> {
    fn next_back(&mut self) -> Option<T> {
        let place = self.left.next_back()?;
        Some(self.read(place))
    }
}

impl<T: Entry> ExactSizeIterator for Iter<'_, T> {}
