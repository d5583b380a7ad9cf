//! A value in RON that is not yet made sense of.

use std::borrow::Cow;

use ron::value::RawValue;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize};

/// Any value in RON, as it is written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RonText(pub String);

impl<'de> Deserialize<'de> for RonText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let raw = Box::<RawValue>::deserialize(deserializer)?;
        Ok(Self(raw.get_ron().trim().to_owned()))
    }
}

impl JsonSchema for RonText {
    fn schema_name() -> Cow<'static, str> {
        "RonText".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "description": "Any value, as it would stand in the scenario." })
    }
}
