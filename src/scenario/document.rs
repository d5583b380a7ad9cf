//! What the reader needs to know of a kind of file: it reads scenarios and studies alike.

use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::checks::{Problem, problems};
use super::shape::Shape;
use super::{Scenario, Study, to_ron};

/// A kind of file: RON with one named struct in it.
pub trait Document: DeserializeOwned + Serialize + JsonSchema {
    /// Name of the struct.
    const KIND: &'static str;
    /// Fields that every such file must have, as they are read on where one is missing: nothing is reported of them.
    const STAND_INS: &'static [(&'static str, &'static str)];

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
    const STAND_INS: &'static [(&'static str, &'static str)] = &[
        ("name", "name: \"scenario\""),
        ("time_limit", "time_limit: 100.0"),
        ("swarm", "swarm: (robots: 10, deploy: Uniform)"),
        ("protocol", "protocol: Backbone(targets: Ring(count: 1, radius: 1.0))"),
    ];

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
    const STAND_INS: &'static [(&'static str, &'static str)] = &[
        ("name", "name: \"study\""),
        ("base", "base: \"\""),
        (
            "factors",
            "factors: [(name: \"factor\", paths: [\"a\"], levels: [(values: [0]), (values: [1])])]",
        ),
        ("figure", "figure: \"delivery_ratio\""),
    ];

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
