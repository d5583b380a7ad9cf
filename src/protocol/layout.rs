//! How a protocol's messages lie in their bytes, for those who look at frames: [`Layout`].

use std::fmt;
use std::ops::RangeInclusive;

/// How the payloads of a protocol's messages are laid out. It describes what the codec does and takes no part in a run: frame logs,
/// `desim explain --frame` and the dissector for Wireshark name fields by it.
///
/// ```
/// use desim::protocol::{Layout, Part};
///
/// // A beacon: 1, a robot in two bytes, hops; a farewell: 2.
/// let kind = Part::named("message", &[(1, "beacon"), (2, "bye")]);
/// let beacon = vec![kind.clone(), Part::robot("leader", 2), Part::number("hops", 1)];
/// let layout = Layout::new(vec![Part::OneOf(vec![(1..=1, beacon), (2..=2, vec![kind])])]);
///
/// assert_eq!(layout.read(&[1, 0, 7, 3]).to_string(), "message beacon, leader 7, hops 3");
/// assert_eq!(layout.read(&[2]).to_string(), "message bye");
/// assert_eq!(layout.read(&[9, 9]).to_string(), "2 bytes that are not described");
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    parts: Vec<Part>,
}

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

/// A value as it was read.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A whole number.
    Number(u64),
    /// A whole number that may be below zero.
    Signed(i64),
    /// A floating-point number.
    Float(f64),
    /// Text.
    Text(String),
    /// Bytes that mean nothing more.
    Bytes(usize),
}

/// What was read of a payload.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Content {
    /// The fields, in the order of their bytes.
    pub fields: Vec<(Field, Value)>,
    /// How many bytes remain that the layout says nothing of.
    pub left: usize,
}

impl Layout {
    /// Of these parts, one after the other.
    #[must_use]
    pub const fn new(parts: Vec<Part>) -> Self {
        Self { parts }
    }

    /// Whether nothing is described.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// Its parts.
    #[must_use]
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// The fields of a payload. Reading ends where the bytes do not go on as they should.
    #[must_use]
    pub fn read(&self, payload: &[u8]) -> Content {
        let mut content = Content {
            fields: Vec::new(),
            left: payload.len(),
        };
        content.read(&self.parts, payload);
        content
    }

    /// Every field that there can be, once each, in the order in which they are described.
    #[must_use]
    pub fn fields(&self) -> Vec<Field> {
        fn gather(parts: &[Part], into: &mut Vec<Field>) {
            for part in parts {
                match part {
                    Part::Field(field) if into.contains(field) => {}
                    Part::Field(field) => into.push(*field),
                    Part::OneOf(cases) => cases.iter().for_each(|(_, parts)| gather(parts, into)),
                    Part::List { count, each } => {
                        gather(&[Part::Field(*count)], into);
                        gather(each, into);
                    }
                }
            }
        }
        let mut fields = Vec::new();
        gather(&self.parts, &mut fields);
        fields
    }
}

impl Part {
    const fn field(name: &'static str, form: Form, meaning: Meaning) -> Self {
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

impl Content {
    /// Reads `parts` off the end of `payload` that is left; `None` as soon as that cannot be.
    fn read(&mut self, parts: &[Part], payload: &[u8]) -> Option<()> {
        for part in parts {
            match part {
                Part::Field(field) => {
                    self.take(*field, payload)?;
                }
                Part::OneOf(cases) => {
                    let next = payload.get(payload.len() - self.left)?;
                    let (_, parts) = cases.iter().find(|(range, _)| range.contains(next))?;
                    self.read(parts, payload)?;
                }
                Part::List { count, each } => {
                    let count = self.take(*count, payload)?;
                    for _ in 0..count {
                        // What claims to be long and is not ends with the bytes; entries of none would not.
                        let before = self.left;
                        self.read(each, payload)?;
                        if self.left == before {
                            break;
                        }
                    }
                }
            }
        }
        Some(())
    }

    /// Reads a field, and answers it as a number.
    fn take(&mut self, field: Field, payload: &[u8]) -> Option<u64> {
        let bytes = &payload[payload.len() - self.left..];
        let (value, length) = field.form.read(bytes)?;
        self.left -= length;
        let number = match &value {
            Value::Number(number) => *number,
            _ => 0,
        };
        if value != Value::Bytes(0) {
            self.fields.push((field, value));
        }
        Some(number)
    }
}

impl Form {
    /// The value at the beginning of `bytes`, and how many it takes; `None` if they are too few or make no sense.
    fn read(self, bytes: &[u8]) -> Option<(Value, usize)> {
        let fold = |so_far: u64, byte: &u8| so_far << 8 | u64::from(*byte);
        match self {
            Self::Big(length) => {
                let read = bytes.get(..length.into())?;
                Some((Value::Number(read.iter().fold(0, fold)), length.into()))
            }
            Self::Little(length) => {
                let read = bytes.get(..length.into())?;
                Some((Value::Number(read.iter().rev().fold(0, fold)), length.into()))
            }
            Self::Varint => varint(bytes).map(|(number, length)| (Value::Number(number), length)),
            Self::Signed => varint(bytes).map(|(number, length)| {
                let value = (number >> 1).cast_signed() ^ -(number & 1).cast_signed();
                (Value::Signed(value), length)
            }),
            Self::Float(4) => {
                let read: [u8; 4] = bytes.get(..4)?.try_into().ok()?;
                Some((Value::Float(f32::from_le_bytes(read).into()), 4))
            }
            Self::Float(_) => {
                let read: [u8; 8] = bytes.get(..8)?.try_into().ok()?;
                Some((Value::Float(f64::from_le_bytes(read)), 8))
            }
            Self::Text => {
                let (length, before) = varint(bytes)?;
                let end = before.checked_add(usize::try_from(length).ok()?)?;
                let text = std::str::from_utf8(bytes.get(before..end)?).ok()?;
                Some((Value::Text(text.to_owned()), end))
            }
            Self::Rest => Some((Value::Bytes(bytes.len()), bytes.len())),
        }
    }
}

fn varint(bytes: &[u8]) -> Option<(u64, usize)> {
    let mut number = 0;
    for (place, byte) in bytes.iter().enumerate().take(10) {
        number |= u64::from(byte & 0x7f) << (7 * place);
        if byte & 0x80 == 0 {
            return Some((number, place + 1));
        }
    }
    None
}

impl fmt::Display for Content {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut between = "";
        for (field, value) in &self.fields {
            write!(f, "{between}{} ", field.name)?;
            between = ", ";
            match (value, field.meaning) {
                (Value::Number(0), Meaning::YesNo) => f.write_str("no"),
                (Value::Number(_), Meaning::YesNo) => f.write_str("yes"),
                (Value::Number(number), Meaning::Bits) => write!(f, "{number:#010b}"),
                (Value::Number(number), Meaning::OneOf(names)) => {
                    match names.iter().find(|(value, _)| value == number) {
                        Some((_, name)) => f.write_str(name),
                        None => write!(f, "{number}"),
                    }
                }
                (Value::Number(number), Meaning::Number | Meaning::Robot) => write!(f, "{number}"),
                (Value::Signed(number), _) => write!(f, "{number}"),
                (Value::Float(number), _) => write!(f, "{number}"),
                (Value::Text(text), _) => write!(f, "{text:?}"),
                (Value::Bytes(1), _) => f.write_str("(1 byte)"),
                (Value::Bytes(length), _) => write!(f, "({length} bytes)"),
            }?;
        }
        if self.left > 0 {
            let bytes = if self.left == 1 { "byte" } else { "bytes" };
            let are = if self.left == 1 { "is" } else { "are" };
            write!(f, "{between}{} {bytes} that {are} not described", self.left)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use serde::Serialize;

    use super::*;

    #[derive(Serialize)]
    struct Message {
        hops: u32,
        offset: i16,
        at: (f32, f64),
        name: &'static str,
        alive: bool,
        others: Vec<u64>,
    }

    fn layout() -> Layout {
        let field = |name, form| Part::field(name, form, Meaning::Number);
        Layout::new(vec![
            Part::varint("hops"),
            field("offset", Form::Signed),
            Part::float("x", 4),
            Part::float("y", 8),
            field("name", Form::Text),
            Part::flag("alive"),
            Part::List {
                count: Field {
                    name: "number of others",
                    form: Form::Varint,
                    meaning: Meaning::Number,
                },
                each: vec![Part::robot_varint("other")],
            },
        ])
    }

    #[test]
    fn what_postcard_writes_is_read_whole() {
        let message = Message {
            hops: 300,
            offset: -3,
            at: (0.5, -2.25),
            name: "hé",
            alive: true,
            others: vec![1, u64::MAX],
        };
        let bytes = postcard::to_stdvec(&message).unwrap();
        let words = "hops 300, offset -3, x 0.5, y -2.25, name \"hé\", alive yes, number of others 2, other 1, other 18446744073709551615";
        assert_eq!(layout().read(&bytes).to_string(), words);
        assert_eq!(layout().fields().len(), 8);
    }

    #[test]
    fn bytes_cut_short_are_read_as_far_as_they_go() {
        let layout = Layout::new(vec![
            Part::number("first", 2),
            Part::list("count", vec![Part::number("entry", 1)]),
        ]);
        assert_eq!(layout.read(&[1, 2, 3, 7]).to_string(), "first 258, count 3, entry 7");
        assert_eq!(layout.read(&[1]).to_string(), "1 byte that is not described");
        assert_eq!(
            layout.read(&[0, 1, 0, 5, 5]).to_string(),
            "first 1, count 0, 2 bytes that are not described"
        );
        let endless = Layout::new(vec![Part::List {
            count: Field {
                name: "count",
                form: Form::Varint,
                meaning: Meaning::Number,
            },
            each: Vec::new(),
        }]);
        assert_eq!(endless.read(&[0xff, 0xff, 0xff, 0x7f]).left, 0);
    }

    #[test]
    fn forms_read_their_bytes() {
        let read = |form: Form, bytes: &[u8]| form.read(bytes).map(|(value, _)| value);
        assert_eq!(read(Form::Little(3), &[1, 2, 3]), Some(Value::Number(0x03_0201)));
        assert_eq!(read(Form::Big(3), &[1, 2, 3]), Some(Value::Number(0x01_0203)));
        assert_eq!(read(Form::Rest, &[1, 2, 3]), Some(Value::Bytes(3)));
        assert_eq!(read(Form::Varint, &[0xff; 11]), None);
        assert_eq!(read(Form::Text, &[2, b'a']), None);
    }
}
