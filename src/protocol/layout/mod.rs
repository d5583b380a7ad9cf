//! How a protocol's messages lie in their bytes, for those who look at frames: [`Layout`].

mod content;
mod part;

pub use content::{Content, Value};
pub use part::{Field, Form, Meaning, Part};

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
        let read = |form: Form, bytes: &[u8]| Value::read(form, bytes).map(|(value, _)| value);
        assert_eq!(read(Form::Little(3), &[1, 2, 3]), Some(Value::Number(0x03_0201)));
        assert_eq!(read(Form::Big(3), &[1, 2, 3]), Some(Value::Number(0x01_0203)));
        assert_eq!(read(Form::Rest, &[1, 2, 3]), Some(Value::Bytes(3)));
        assert_eq!(read(Form::Varint, &[0xff; 11]), None);
        assert_eq!(read(Form::Text, &[2, b'a']), None);
    }
}
