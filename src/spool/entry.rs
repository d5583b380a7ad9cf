//! The bytes of entries.

use crate::engine::{ActorId, SimTime, Span};

/// What can stand in a [`Spool`](super::Spool): it is put into bytes, as many for each entry of a list, and taken out again.
///
/// A struct of such things is one by the macro `entry!`.
pub trait Entry: Sized {
    /// Adds the bytes of `self`.
    fn put(&self, into: &mut Vec<u8>);

    /// Takes an entry off the front of `from`; `None` if there is none.
    fn take(from: &mut &[u8]) -> Option<Self>;
}

/// Makes structs entries: their fields, in this order.
macro_rules! entry {
    ($($name:ident { $($field:ident),* $(,)? })*) => {
        $(impl $crate::spool::Entry for $name {
            fn put(&self, into: &mut Vec<u8>) {
                $(self.$field.put(into);)*
            }

            fn take(from: &mut &[u8]) -> Option<Self> {
                Some(Self { $($field: $crate::spool::Entry::take(from)?),* })
            }
        })*
    };
}
pub(crate) use entry;

/// Makes a number an entry.
macro_rules! numbers {
    ($($name:ty),*) => {
        $(impl Entry for $name {
            #[inline]
            fn put(&self, into: &mut Vec<u8>) {
                into.extend_from_slice(&self.to_le_bytes());
            }

            #[inline]
            fn take(from: &mut &[u8]) -> Option<Self> {
                let (bytes, rest) = from.split_first_chunk()?;
                *from = rest;
                Some(Self::from_le_bytes(*bytes))
            }
        })*
    };
}

numbers!(u8, u16, u32, u64, f32, f64);

/// Makes what is a number by another name an entry.
macro_rules! as_numbers {
    ($($name:ty: $number:ty, $out:expr, $into:expr;)*) => {
        $(impl Entry for $name {
            #[inline]
            fn put(&self, into: &mut Vec<u8>) {
                let number: fn($name) -> $number = $out;
                number(*self).put(into);
            }

            #[inline]
            fn take(from: &mut &[u8]) -> Option<Self> {
                <$number>::take(from).and_then($into)
            }
        })*
    };
}

as_numbers! {
    bool: u8, u8::from, |byte| (byte < 2).then_some(byte == 1);
    ActorId: u32, |id| id.0, |id| Some(Self(id));
    SimTime: u64, SimTime::as_nanos, |nanos| Some(Self::from_nanos(nanos));
    Span: u64, Span::as_nanos, |nanos| Some(Self::from_nanos(nanos));
}

/// What is absent takes as much room as what is there.
impl<T: Entry + Default> Entry for Option<T> {
    fn put(&self, into: &mut Vec<u8>) {
        self.is_some().put(into);
        match self {
            Some(value) => value.put(into),
            None => T::default().put(into),
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        let is_there = bool::take(from)?;
        let value = T::take(from)?;
        Some(is_there.then_some(value))
    }
}

impl<A: Entry, B: Entry> Entry for (A, B) {
    fn put(&self, into: &mut Vec<u8>) {
        self.0.put(into);
        self.1.put(into);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        Some((A::take(from)?, B::take(from)?))
    }
}

impl<T: Entry + Copy + Default, const N: usize> Entry for [T; N] {
    fn put(&self, into: &mut Vec<u8>) {
        for value in self {
            value.put(into);
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        let mut values = [T::default(); N];
        for value in &mut values {
            *value = T::take(from)?;
        }
        Some(values)
    }
}

/// As many in each entry of a list.
impl<T: Entry> Entry for Vec<T> {
    fn put(&self, into: &mut Vec<u8>) {
        (self.len() as u32).put(into);
        for value in self {
            value.put(into);
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        let count = u32::take(from)? as usize;
        // Damaged bytes are not to ask for more memory than they are worth.
        (count <= from.len()).then_some(())?;
        (0..count).map(|_| T::take(from)).collect()
    }
}
