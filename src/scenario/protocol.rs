//! What robots run: the kind of protocol that a scenario names, with its config.
//!
//! In a file it is an enum whose variants are the kinds in the registry. So it is read by hand: which variants there are is
//! known when the program runs, and not before.

use std::any::Any;
use std::borrow::Cow;
use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{DeserializeSeed, EnumAccess, Error as _, VariantAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

use super::path::{FieldPath, Step, follow};
use super::tree;
use super::typed::{Failure, typed_by};
use crate::kind::{AnyKind, Entry, Kind};
use crate::kinds;

/// What this field is called in a scenario.
const FIELD: &str = "protocol";

/// The protocol that robots run: a kind and its config.
#[derive(Clone, Debug)]
pub struct ProtocolConfig(Arc<dyn AnyKind>);

impl ProtocolConfig {
    /// A protocol by its config.
    #[must_use]
    pub fn of(config: impl Kind) -> Self {
        Self(Arc::new(config))
    }

    /// The config, if it is of this kind.
    #[must_use]
    pub fn as_kind<K: Kind>(&self) -> Option<&K> {
        let config: &dyn Any = &*self.0;
        config.downcast_ref()
    }
}

impl From<Arc<dyn AnyKind>> for ProtocolConfig {
    fn from(config: Arc<dyn AnyKind>) -> Self {
        Self(config)
    }
}

impl Deref for ProtocolConfig {
    type Target = dyn AnyKind;

    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}

impl PartialEq for ProtocolConfig {
    fn eq(&self, other: &Self) -> bool {
        self.0.equals(&*other.0)
    }
}

impl Serialize for ProtocolConfig {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let name = self.name();
        let place = kinds::names().iter().position(|known| *known == name).unwrap_or(0) as u32;
        if self.is_unit() {
            serializer.serialize_unit_variant("ProtocolConfig", place, name)
        } else {
            serializer.serialize_newtype_variant("ProtocolConfig", place, name, &*self.0)
        }
    }
}

impl<'de> Deserialize<'de> for ProtocolConfig {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_enum("ProtocolConfig", kinds::names(), Named)
    }
}

/// Reads a protocol: its name, then its config.
struct Named;

impl<'de> Visitor<'de> for Named {
    type Value = ProtocolConfig;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("the name of a protocol")
    }

    fn visit_enum<A: EnumAccess<'de>>(self, access: A) -> Result<ProtocolConfig, A::Error> {
        let (entry, variant) = access.variant_seed(Name)?;
        if !entry.is_unit {
            return variant.newtype_variant_seed(Config(entry)).map(ProtocolConfig);
        }
        variant.unit_variant()?;
        let mut nothing = <dyn erased_serde::Deserializer>::erase(Value::Null);
        let config = (entry.read)(&mut nothing).map_err(A::Error::custom)?;
        Ok(ProtocolConfig(config))
    }
}

/// Reads the name of a kind.
struct Name;

impl<'de> DeserializeSeed<'de> for Name {
    type Value = Entry;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Entry, D::Error> {
        deserializer.deserialize_identifier(self)
    }
}

impl Visitor<'_> for Name {
    type Value = Entry;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("the name of a protocol")
    }

    fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<Entry, E> {
        kinds::find(name).ok_or_else(|| E::unknown_variant(name, kinds::names()))
    }
}

/// Reads the config of a kind.
struct Config(Entry);

impl<'de> DeserializeSeed<'de> for Config {
    type Value = Arc<dyn AnyKind>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        let mut erased = <dyn erased_serde::Deserializer>::erase(deserializer);
        (self.0.read)(&mut erased).map_err(D::Error::custom)
    }
}

impl JsonSchema for ProtocolConfig {
    fn schema_name() -> Cow<'static, str> {
        "ProtocolConfig".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let choices: Vec<Schema> = kinds::all()
            .iter()
            .map(|kind| {
                let meaning = (kind.schema_in_place)(generator).get("description").cloned();
                let mut choice = if kind.is_unit {
                    json_schema!({"type": "string", "const": kind.name})
                } else {
                    json_schema!({
                        "type": "object",
                        "properties": {kind.name: (kind.schema)(generator)},
                        "additionalProperties": false,
                        "required": [kind.name],
                    })
                };
                if let Some(meaning) = meaning {
                    choice.insert("description".to_owned(), meaning);
                }
                choice
            })
            .collect();
        json_schema!({"description": "The protocol that robots run.", "oneOf": choices})
    }
}

/// The same failure, or if it came up within the config of a protocol, what that says of itself: on its way here an error has
/// become mere words.
pub fn nearer(failure: Box<Failure>, text: &str) -> Box<Failure> {
    within_config(&failure, text).unwrap_or(failure)
}

fn within_config(failure: &Failure, text: &str) -> Option<Box<Failure>> {
    let path = FieldPath::of(FIELD);
    let is_here = path.holds(&failure.path) || failure.path == path;
    let root = is_here.then(|| tree::read(text).0).flatten()?;
    let place = follow(&root, &path, text);
    let name = &text[place.node.name.clone()?];
    let inside = place.node.group.as_ref()?.inside.clone();
    let entry = kinds::find(name).filter(|entry| !entry.is_unit && is_struct(entry))?;
    let brackets = inside.start.checked_sub(1)?..inside.end + 1;
    let mut found = typed_by(&alone(text, &brackets), entry.read_ron).err()?;
    let mut whole = path.join(Step::Variant(name.to_owned()));
    whole.0.append(&mut found.path.0);
    found.path = whole;
    Some(found)
}

/// Whether a config's fields stand in the brackets after its name.
fn is_struct(entry: &Entry) -> bool {
    let schema = (entry.schema_in_place)(&mut SchemaGenerator::default());
    schema.get("properties").is_some()
}

/// `text` with spaces for all letters outside of `span`, so that the rest keeps its lines and columns.
fn alone(text: &str, span: &super::token::Span) -> String {
    text.char_indices()
        .map(|(at, letter)| {
            if span.contains(&at) || letter == '\n' {
                letter
            } else {
                ' '
            }
        })
        .collect()
}
