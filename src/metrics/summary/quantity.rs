//! The shapes that figures take in a summary: a value with its unit, an estimate with its unit, figures by name.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::metrics::unit::Unit;
use crate::statistics::Estimate;

/// A figure that is counted, not estimated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quantity<T> {
    /// The figure.
    pub value: T,
    /// Its unit.
    pub unit: Unit,
}

/// An estimate and its unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// The estimate.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// Its unit.
    pub unit: Unit,
}

/// The mean of times of which some were cut off: of mistakes by the end of the run, say. Those count as having lasted at least so long
/// (the restricted mean, the area under the Kaplan–Meier curve).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lasted {
    /// The estimate; absent where nothing was over before it was cut off.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// How many were cut off.
    pub cut_off: u64,
    /// The longest time, if it was cut off: the mean is restricted to it, longer times counting as no longer. Absent where the longest was
    /// over by itself, and the mean is the whole mean.
    pub restricted_to: Option<f64>,
    /// Its unit.
    pub unit: Unit,
}

/// Figures by name, in an order that means something; an object in JSON.
#[derive(Clone, Debug, PartialEq)]
pub struct Named<T>(pub Vec<(String, T)>);

impl<T> Default for Named<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T> Named<T> {
    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The figure called `name`.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&T> {
        self.0.iter().find(|(own, _)| own == name).map(|(_, figure)| figure)
    }

    /// `figure` of each of `names`, by its place.
    pub(in crate::metrics) fn of<'a>(names: impl IntoIterator<Item = &'a str>, figure: impl Fn(usize) -> T) -> Self {
        Self(
            names
                .into_iter()
                .enumerate()
                .map(|(i, name)| (name.to_owned(), figure(i)))
                .collect(),
        )
    }
}

impl<T: Serialize> Serialize for Named<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, figure)| (name, figure)))
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(InOrder(PhantomData))
    }
}

/// Reads an object's figures in the order in which they stand.
struct InOrder<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for InOrder<T> {
    type Value = Named<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("figures by name")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Named<T>, A::Error> {
        let mut figures = Vec::new();
        while let Some(figure) = map.next_entry()? {
            figures.push(figure);
        }
        Ok(Named(figures))
    }
}
