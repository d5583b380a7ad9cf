//! What closed forms say of a run before it is run.

use serde::Serialize;

/// A figure expected of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Prediction {
    /// Its stable name, in the manner of `summary.json`.
    pub name: &'static str,
    /// What it is, in a few words.
    pub what: &'static str,
    /// The figure.
    pub value: f64,
    /// Its unit; `"1"` where it has none.
    pub unit: &'static str,
    /// How far off the closed form may be of what it describes, in the same unit: end effects of a run as long as the time limit,
    /// what a formula leaves out. 0 where it is exact.
    pub accuracy: f64,
    /// Of what part of a run it is true.
    pub holds: Holds,
    /// The formula.
    pub formula: &'static str,
    /// What it takes for granted.
    pub assumes: String,
}

/// Of what part of a run a prediction is true.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Holds {
    /// Of all of it.
    Throughout,
    /// Of its beginning, before robots have moved.
    AtStart,
    /// Of robots that stay in range of each other.
    InRange,
    /// Of the formation that the mission ends in.
    AtEnd,
}

/// A figure that no closed form here covers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Unpredicted {
    /// Its stable name.
    pub name: &'static str,
    /// What it is, in a few words.
    pub what: &'static str,
    /// Why not.
    pub why: String,
}

/// What a protocol's own closed forms say.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Expected {
    /// What they say.
    pub predictions: Vec<Prediction>,
    /// What they do not.
    pub unpredicted: Vec<Unpredicted>,
}

impl Expected {
    /// The same, without a closed form for a figure.
    #[must_use]
    pub fn without(mut self, name: &'static str, what: &'static str, why: impl Into<String>) -> Self {
        let why = why.into();
        self.unpredicted.push(Unpredicted { name, what, why });
        self
    }
}

/// Broadcasts of one length that robots send at one rate, and nothing else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Broadcasts {
    /// The share of robots that send.
    pub sending: f64,
    /// Messages a second of each of them.
    pub per_second: f64,
    /// Payload bytes of a message.
    pub payload: f64,
    /// Whether their instants are independent of each other's.
    pub scattered: bool,
}
