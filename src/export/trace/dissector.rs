//! The dissector for Wireshark: names the fields of what desim captures.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::link::{ETHER_TYPE, PAN};
use crate::kinds;
use crate::protocol::{Field, Form, Meaning, Part};
use crate::radio::LossCause;

/// All but what kinds of protocols say of themselves.
const SCRIPT: &str = include_str!("dissector.lua");

/// A script for Wireshark and tshark that knows the kinds of protocols that scenarios may name: those whose layouts are described field by field, the others' topics and
/// payloads.
#[must_use]
pub fn dissector() -> String {
    let mut kinds = String::new();
    let mut fields = Fields::default();
    for kind in kinds::all() {
        let layout = (kind.layout)();
        let prefix = abbreviation(kind.name);
        fields.gather(&prefix, &layout.fields());
        let _ = write!(kinds, "  [{}] = ", quoted(kind.name));
        put_parts(&prefix, layout.parts(), 1, &mut kinds);
        kinds.push_str(",\n");
    }
    let causes: Vec<String> = (0..)
        .zip(LossCause::ALL)
        .map(|(number, cause)| format!("[{number}] = {}", quoted(&cause.name().replace('_', " "))))
        .collect();
    SCRIPT
        .replace("{{version}}", env!("CARGO_PKG_VERSION"))
        .replace("{{pan}}", &format!("0x{PAN:04x}"))
        .replace("{{ether_type}}", &format!("0x{ETHER_TYPE:04x}"))
        .replace("{{causes}}", &causes.join(", "))
        .replace("{{fields}}", &fields.lua())
        .replace("{{kinds}}", &kinds)
}

/// The fields that filters can name. Two of one name are one, which takes the greater values and has the names of both.
#[derive(Default)]
struct Fields(BTreeMap<String, Declared>);

struct Declared {
    name: &'static str,
    kind: &'static str,
    names: BTreeMap<u64, &'static str>,
}

impl Fields {
    fn gather(&mut self, prefix: &str, fields: &[Field]) {
        for field in fields {
            let declared = self
                .0
                .entry(format!("desim.{prefix}.{}", abbreviation(field.name)))
                .or_insert(Declared {
                    name: field.name,
                    kind: kind(field),
                    names: BTreeMap::new(),
                });
            if declared.kind != kind(field) {
                declared.kind = "uint64";
            }
            if let Meaning::OneOf(names) = field.meaning {
                declared.names.extend(names.iter().copied());
            }
        }
    }

    fn lua(&self) -> String {
        let mut text = String::new();
        for (abbreviation, Declared { name, kind, names }) in &self.0 {
            let names: Vec<String> = names
                .iter()
                .map(|(value, name)| format!("[{value}] = {}", quoted(name)))
                .collect();
            let more = match (*kind, names.is_empty()) {
                ("uint32" | "uint64", true) => ", base.DEC".to_owned(),
                ("uint32" | "uint64", false) => format!(", base.DEC, {{{}}}", names.join(", ")),
                ("bits", _) => ", base.HEX".to_owned(),
                _ => String::new(),
            };
            let kind = if *kind == "bits" { "uint32" } else { kind };
            let _ = writeln!(
                text,
                "  [{0}] = ProtoField.{kind}({0}, {1}{more}),",
                quoted(abbreviation),
                quoted(name)
            );
        }
        text
    }
}

/// The kind of a field, as Wireshark's Lua calls it; `bits` is a number that is shown bit by bit.
fn kind(field: &Field) -> &'static str {
    match (field.form, field.meaning) {
        (_, Meaning::YesNo) => "bool",
        (Form::Big(1..=4) | Form::Little(1..=4), Meaning::Bits) => "bits",
        (Form::Big(1..=4) | Form::Little(1..=4), _) => "uint32",
        (Form::Big(_) | Form::Little(_) | Form::Varint, _) => "uint64",
        (Form::Signed, _) => "int64",
        (Form::Float(4), _) => "float",
        (Form::Float(_), _) => "double",
        (Form::Text, _) => "string",
        (Form::Rest, _) => "bytes",
    }
}

fn put_parts(prefix: &str, parts: &[Part], depth: usize, into: &mut String) {
    let indent = "  ".repeat(depth + 1);
    into.push_str("{\n");
    for part in parts {
        into.push_str(&indent);
        match part {
            Part::Field(field) => put_field(prefix, field, into),
            Part::OneOf(cases) => {
                into.push_str("{ cases = {\n");
                for (range, parts) in cases {
                    let _ = write!(
                        into,
                        "{indent}  {{ first = {}, last = {}, parts = ",
                        range.start(),
                        range.end()
                    );
                    put_parts(prefix, parts, depth + 2, into);
                    into.push_str(" },\n");
                }
                let _ = write!(into, "{indent}}} }}");
            }
            Part::List { count, each } => {
                into.push_str("{ count = ");
                put_field(prefix, count, into);
                into.push_str(", each = ");
                put_parts(prefix, each, depth + 1, into);
                into.push_str(" }");
            }
        }
        into.push_str(",\n");
    }
    into.push_str(&indent[2..]);
    into.push('}');
}

fn put_field(prefix: &str, field: &Field, into: &mut String) {
    let (form, bytes) = match field.form {
        Form::Big(bytes) => ("big", bytes),
        Form::Little(bytes) => ("little", bytes),
        Form::Varint => ("varint", 0),
        Form::Signed => ("signed", 0),
        Form::Float(bytes) => ("float", bytes),
        Form::Text => ("text", 0),
        Form::Rest => ("rest", 0),
    };
    let _ = write!(
        into,
        "{{ field = {}, form = {}, bytes = {bytes} }}",
        quoted(&format!("desim.{prefix}.{}", abbreviation(field.name))),
        quoted(form)
    );
}

/// A name as filters write it.
fn abbreviation(name: &str) -> String {
    let letter = |letter: char| {
        if letter.is_ascii_alphanumeric() {
            letter.to_ascii_lowercase()
        } else {
            '_'
        }
    };
    name.chars().map(letter).collect()
}

/// Text as Lua writes it.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for byte in text.bytes() {
        match byte {
            b'"' | b'\\' => quoted.extend(['\\', char::from(byte)]),
            b' '..=b'~' => quoted.push(char::from(byte)),
            _ => {
                let _ = write!(quoted, "\\{byte:03}");
            }
        }
    }
    quoted.push('"');
    quoted
}
