//! Scenarios as text, and the schema of that.

use ron::ser::PrettyConfig;
use schemars::{Schema, SchemaGenerator, generate::SchemaSettings};

use super::Scenario;
use super::typed::options;

/// The whole scenario as the text of a scenario file, defaults included. [`parse`](super::parse) reads it back to an equal one.
///
/// # Panics
/// Never: every value of a scenario has a form in RON.
#[must_use]
pub fn to_ron(scenario: &Scenario) -> String {
    let layout = PrettyConfig::new().compact_arrays(true);
    let body = options().to_string_pretty(scenario, layout);
    format!("Scenario{}\n", body.expect("a scenario holds only what RON can write"))
}

/// The JSON Schema of scenario files, for editors and other tools. RON's structs are objects, its variants objects with
/// one key, those without fields strings, its tuples arrays.
#[must_use]
pub fn json_schema() -> Schema {
    let generator: SchemaGenerator = SchemaSettings::draft2020_12().into_generator();
    generator.into_root_schema_for::<Scenario>()
}
