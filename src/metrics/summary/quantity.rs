//! The shapes that figures take in a summary: a value with its unit, an estimate with its unit, figures by name.

use serde::{Serialize, Serializer};

use crate::metrics::statistics::Estimate;

/// The unit of what has none: ratios, shares, λ₂.
pub(super) const DIMENSIONLESS: &str = "1";

/// A figure that is counted, not estimated.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quantity<T> {
    /// The figure.
    pub value: T,
    /// Its unit.
    pub unit: &'static str,
}

/// An estimate and its unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Measured {
    /// The estimate.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// Its unit.
    pub unit: &'static str,
}

/// Figures by name, in an order that means something; an object in JSON.
#[derive(Clone, Debug, PartialEq)]
pub struct Named<T>(pub Vec<(String, T)>);

impl<T> Named<T> {
    /// `figure` of each of `names`, by its place.
    pub(super) fn of<'a>(names: impl IntoIterator<Item = &'a str>, figure: impl Fn(usize) -> T) -> Self {
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
