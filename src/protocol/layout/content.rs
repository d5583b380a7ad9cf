//! What a payload says, read by what describes it.

use std::fmt;

use super::part::{Field, Form, Meaning, Part};

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

impl Content {
    /// Reads `parts` off the end of `payload` that is left; `None` as soon as that cannot be.
    pub(super) fn read(&mut self, parts: &[Part], payload: &[u8]) -> Option<()> {
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
        let (value, length) = Value::read(field.form, bytes)?;
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

impl Value {
    /// The value at the beginning of `bytes`, and how many it takes; `None` if they are too few or make no sense.
    pub(super) fn read(form: Form, bytes: &[u8]) -> Option<(Self, usize)> {
        let fold = |so_far: u64, byte: &u8| so_far << 8 | u64::from(*byte);
        match form {
            Form::Big(length) => {
                let read = bytes.get(..length.into())?;
                Some((Value::Number(read.iter().fold(0, fold)), length.into()))
            }
            Form::Little(length) => {
                let read = bytes.get(..length.into())?;
                Some((Value::Number(read.iter().rev().fold(0, fold)), length.into()))
            }
            Form::Varint => varint(bytes).map(|(number, length)| (Value::Number(number), length)),
            Form::Signed => varint(bytes).map(|(number, length)| {
                let value = (number >> 1).cast_signed() ^ -(number & 1).cast_signed();
                (Value::Signed(value), length)
            }),
            Form::Float(4) => {
                let read: [u8; 4] = bytes.get(..4)?.try_into().ok()?;
                Some((Value::Float(f32::from_le_bytes(read).into()), 4))
            }
            Form::Float(_) => {
                let read: [u8; 8] = bytes.get(..8)?.try_into().ok()?;
                Some((Value::Float(f64::from_le_bytes(read)), 8))
            }
            Form::Text => {
                let (length, before) = varint(bytes)?;
                let end = before.checked_add(usize::try_from(length).ok()?)?;
                let text = std::str::from_utf8(bytes.get(before..end)?).ok()?;
                Some((Value::Text(text.to_owned()), end))
            }
            Form::Rest => Some((Value::Bytes(bytes.len()), bytes.len())),
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
