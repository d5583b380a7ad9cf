//! What payloads are described of.

use std::ops::RangeInclusive;

/// A part of a payload. Parts follow each other without a gap.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Part {
    /// A value.
    Field(Field),
    /// One of several sequences: that whose range has the next byte, which is its first and remains to be read.
    OneOf(Vec<(RangeInclusive<u8>, Vec<Part>)>),
    /// A number, and a sequence so many times.
    List {
        /// How many.
        count: Field,
        /// What.
        each: Vec<Part>,
    },
}

/// A value in a payload.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// What it is called, in lower case, words apart.
    pub name: &'static str,
    /// How it lies there.
    pub form: Form,
    /// What it means.
    pub meaning: Meaning,
}

/// How a value lies in its bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// So many bytes, from 1 to 8, the highest first.
    Big(u8),
    /// So many bytes, from 1 to 8, the lowest first.
    Little(u8),
    /// Seven bits a byte, the lowest first, the top bit set in all but the last: at most ten bytes.
    Varint,
    /// Such a number, of which the lowest bit is the sign: 0, −1, 1, −2, 2 …
    Signed,
    /// IEEE 754 in 4 or 8 bytes, the lowest first.
    Float(u8),
    /// A [`Varint`](Self::Varint), and so many bytes of UTF-8.
    Text,
    /// All bytes that are left; a field only if there are any.
    Rest,
}

/// What a number means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// What it is.
    Number,
    /// A robot, by its id.
    Robot,
    /// No if it is zero, else yes.
    YesNo,
    /// A set, a bit each.
    Bits,
    /// One of these; another number is itself.
    OneOf(&'static [(u64, &'static str)]),
}

impl Part {
    /// A value of any form and meaning.
    #[must_use]
    pub const fn field(name: &'static str, form: Form, meaning: Meaning) -> Self {
        Self::Field(Field { name, form, meaning })
    }

    /// A number of so many bytes, the highest first.
    #[must_use]
    pub const fn number(name: &'static str, bytes: u8) -> Self {
        Self::field(name, Form::Big(bytes), Meaning::Number)
    }

    /// A robot's id of so many bytes, the highest first.
    #[must_use]
    pub const fn robot(name: &'static str, bytes: u8) -> Self {
        Self::field(name, Form::Big(bytes), Meaning::Robot)
    }

    /// A byte that is 0 for no and 1 for yes.
    #[must_use]
    pub const fn flag(name: &'static str) -> Self {
        Self::field(name, Form::Big(1), Meaning::YesNo)
    }

    /// A byte of which a bit stands for each of up to eight.
    #[must_use]
    pub const fn bits(name: &'static str) -> Self {
        Self::field(name, Form::Big(1), Meaning::Bits)
    }

    /// A byte whose values have names.
    #[must_use]
    pub const fn named(name: &'static str, names: &'static [(u64, &'static str)]) -> Self {
        Self::field(name, Form::Big(1), Meaning::OneOf(names))
    }

    /// A number of seven bits a byte, as postcard writes `u16` to `u64`.
    #[must_use]
    pub const fn varint(name: &'static str) -> Self {
        Self::field(name, Form::Varint, Meaning::Number)
    }

    /// A robot's id of seven bits a byte.
    #[must_use]
    pub const fn robot_varint(name: &'static str) -> Self {
        Self::field(name, Form::Varint, Meaning::Robot)
    }

    /// A floating-point number of 4 or 8 bytes, as postcard writes it.
    #[must_use]
    pub const fn float(name: &'static str, bytes: u8) -> Self {
        Self::field(name, Form::Float(bytes), Meaning::Number)
    }

    /// All that is left.
    #[must_use]
    pub const fn rest(name: &'static str) -> Self {
        Self::field(name, Form::Rest, Meaning::Number)
    }

    /// A byte that says how many, and a sequence so many times.
    #[must_use]
    pub const fn list(count: &'static str, each: Vec<Self>) -> Self {
        let count = Field {
            name: count,
            form: Form::Big(1),
            meaning: Meaning::Number,
        };
        Self::List { count, each }
    }
}
