//! What the reader needs to know of a kind of file: it reads scenarios and studies alike.

use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::checks::problems;
use super::shape::Shape;
use super::typed::Failure;
use super::{Scenario, Study, protocol, to_ron};
use crate::kind::Problem;
use crate::kinds;

/// A kind of file: RON with one named struct in it.
pub trait Document: DeserializeOwned + Serialize + JsonSchema {
    /// Name of the struct.
    const KIND: &'static str;

    /// A field that every such file must have, as it is read on where it is missing: nothing is reported of it.
    fn stand_in(field: &str) -> Option<String>;

    /// The same failure to read `text`, or what is nearer to its cause.
    fn nearer(failure: Box<Failure>, text: &str) -> Box<Failure> {
        let _ = text;
        failure
    }

    /// What it may hold, field by field.
    fn shape() -> Shape<'static>;

    /// What no field shows on its own.
    fn problems(&self) -> Vec<Problem>;

    /// The same, with what it says in an older way said as of now.
    fn settled(self) -> Self {
        self
    }

    /// What is allowed and hardly meant, of one that has no problem.
    fn warnings(&self) -> Vec<Problem> {
        Vec::new()
    }

    /// The whole of it as text, defaults included.
    fn to_ron(&self) -> String;
}

impl Document for Scenario {
    const KIND: &'static str = "Scenario";

    fn stand_in(field: &str) -> Option<String> {
        let value = match field {
            "name" => "\"scenario\"",
            "time_limit" => "100.0",
            "swarm" => "(robots: 10, deploy: Uniform)",
            // One that is named without brackets is whole.
            "protocol" => kinds::all().into_iter().find(|kind| kind.is_unit)?.name,
            _ => return None,
        };
        Some(format!("{field}: {value}"))
    }

    fn nearer(failure: Box<Failure>, text: &str) -> Box<Failure> {
        protocol::nearer(failure, text)
    }

    fn shape() -> Shape<'static> {
        Shape::scenario()
    }

    fn problems(&self) -> Vec<Problem> {
        problems(self)
    }

    fn settled(self) -> Self {
        self.settled()
    }

    fn warnings(&self) -> Vec<Problem> {
        super::warnings::warnings(self)
    }

    fn to_ron(&self) -> String {
        to_ron(self)
    }
}

impl Document for Study {
    const KIND: &'static str = "Study";

    fn stand_in(field: &str) -> Option<String> {
        let value = match field {
            "name" => "\"study\"",
            "base" => "\"\"",
            "factors" => "[(name: \"factor\", paths: [\"a\"], levels: [(values: [0]), (values: [1])])]",
            "figure" => "\"delivery_ratio\"",
            _ => return None,
        };
        Some(format!("{field}: {value}"))
    }

    fn shape() -> Shape<'static> {
        Shape::study()
    }

    fn problems(&self) -> Vec<Problem> {
        super::study::problems(self)
    }

    fn to_ron(&self) -> String {
        // No override reaches into a study, which is all that this text is for.
        String::new()
    }
}
