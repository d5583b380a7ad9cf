//! Scenarios made up from the schema, so that every field and variant is written and read back, also those to come.

use proptest::prelude::*;
use rand::{Rng, RngExt};
use rand_philox::Philox;
use serde_json::{Map, Value, json};

use super::read::typed;
use super::{Scenario, json_schema, to_ron};
use crate::engine::{Purpose, Streams};

/// Makes up a value that `schema`, a part of `root`, accepts.
fn value(schema: &Value, root: &Value, random: &mut impl Rng) -> Value {
    if let Some(name) = schema["$ref"].as_str() {
        let target = root.pointer(name.trim_start_matches('#'));
        return value(target.expect("the schema has what it refers to"), root, random);
    }
    if let Some(choices) = schema["oneOf"].as_array() {
        return value(&choices[random.random_range(0..choices.len())], root, random);
    }
    if schema.get("properties").is_none()
        && let Some(choices) = schema["anyOf"].as_array()
    {
        return value(&choices[random.random_range(0..choices.len())], root, random);
    }
    if let Some(types) = schema["type"].as_array() {
        let mut one = schema.clone();
        one["type"] = types[random.random_range(0..types.len())].clone();
        return value(&one, root, random);
    }
    if let Some(constant) = schema.get("const") {
        return constant.clone();
    }
    if let Some(names) = schema["enum"].as_array() {
        return names[random.random_range(0..names.len())].clone();
    }
    match schema["type"].as_str() {
        Some("number") => number(schema, random),
        Some("integer") => integer(schema, random),
        Some("null") => Value::Null,
        Some("boolean") => random.random::<bool>().into(),
        Some("string") => "a-Name_9".into(),
        Some("array") => array(schema, root, random),
        Some("object") => object(schema, root, random),
        other => panic!("no values for the schema type {other:?}"),
    }
}

/// Any magnitude within the bounds, whole numbers and bounds themselves included.
fn number(schema: &Value, random: &mut impl Rng) -> Value {
    let low = schema["minimum"]
        .as_f64()
        .or(schema["exclusiveMinimum"].as_f64())
        .unwrap_or(f64::MIN);
    let high = schema["maximum"].as_f64().unwrap_or(f64::MAX);
    let exponent = random.random_range(-300..300);
    let drawn = match random.random_range(0..4) {
        0 => random.random_range(1.0..10.0) * 10_f64.powi(exponent),
        1 => random.random_range(1..1000).into(),
        2 => random.random(),
        _ => high,
    };
    json!(drawn.clamp(low, high))
}

fn integer(schema: &Value, random: &mut impl Rng) -> Value {
    let low = schema["minimum"].as_u64().unwrap_or(0);
    let high = schema["maximum"].as_u64().unwrap_or(match schema["format"].as_str() {
        Some("uint8") => u8::MAX.into(),
        Some("uint16") => u16::MAX.into(),
        Some("uint32") => u32::MAX.into(),
        _ => u64::MAX,
    });
    random.random_range(low..=high).into()
}

fn array(schema: &Value, root: &Value, random: &mut impl Rng) -> Value {
    if let Some(items) = schema["prefixItems"].as_array() {
        return items.iter().map(|item| value(item, root, random)).collect();
    }
    (0..random.random_range(0..4))
        .map(|_| value(&schema["items"], root, random))
        .collect()
}

/// All required fields, and each of the others as often as not. Where there are alternatives, one of them says which fields there must be and which not.
fn object(schema: &Value, root: &Value, random: &mut impl Rng) -> Value {
    let alternatives = schema["anyOf"].as_array();
    let alternative = alternatives.map_or(&Value::Null, |all| &all[random.random_range(0..all.len())]);
    let required = |name: &String| {
        let names = [schema, alternative].map(|schema| schema["required"].as_array());
        names.into_iter().flatten().flatten().any(|other| other == name)
    };
    let refused = |name: &String| alternative["properties"][name.as_str()] == Value::Bool(false);
    let fields = schema["properties"].as_object().into_iter().flatten();
    let mut object = Map::new();
    for (name, field) in fields {
        if !refused(name) && (required(name) || random.random()) {
            object.insert(name.clone(), value(field, root, random));
        }
    }
    object.into()
}

fn scenario(seed: u64) -> Scenario {
    let root = json_schema().to_value();
    let mut random: Philox = Streams::new(seed, 0)
        .keyed(Purpose::new("scenario.generated"))
        .at(0, 0, 0);
    let json = value(&root, &root, &mut random);
    serde_json::from_value(json.clone()).unwrap_or_else(|error| panic!("{error}: {json:#}"))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn whatever_the_schema_accepts_is_a_scenario_that_reads_back_from_its_resolved_text(seed: u64) {
        let scenario = scenario(seed);
        let text = to_ron(&scenario);
        let again = typed(&text).map_err(|failure| failure.error);
        prop_assert_eq!(again, Ok(scenario), "{}", text);
    }
}
