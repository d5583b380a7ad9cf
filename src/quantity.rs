//! Numbers that carry their range: a scenario that holds one holds a valid one, and a bad one is reported where it
//! stands in the file.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

/// A number is outside the range that its place allows.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{found} is out of range: expected {expected}")]
pub struct OutOfRange {
    found: f64,
    expected: &'static str,
}

/// Declares a newtype of `f64` with one accepted range, checked on reading and stated in the schema.
macro_rules! quantity {
    ($(#[$docs:meta])* $name:ident, $expected:literal, $accepts:expr, $schema:tt) => {
        $(#[$docs])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
        #[serde(try_from = "f64", into = "f64")]
        pub struct $name(f64);

        impl $name {
            /// The number itself.
            #[must_use]
            pub const fn get(self) -> f64 {
                self.0
            }

            /// `value`, for constants in code.
            ///
            /// # Panics
            /// If `value` is out of range.
            #[must_use]
            pub fn new(value: f64) -> Self {
                match Self::try_from(value) {
                    Ok(quantity) => quantity,
                    Err(error) => panic!("{error}"),
                }
            }
        }

        impl TryFrom<f64> for $name {
            type Error = OutOfRange;
            fn try_from(value: f64) -> Result<Self, OutOfRange> {
                let accepts: fn(f64) -> bool = $accepts;
                if accepts(value) {
                    Ok(Self(value))
                } else {
                    Err(OutOfRange { found: value, expected: $expected })
                }
            }
        }

        impl From<$name> for f64 {
            fn from(quantity: $name) -> f64 {
                quantity.0
            }
        }

        impl JsonSchema for $name {
            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                json_schema!($schema)
            }
        }
    };
}

quantity!(
    /// A probability, from 0 to 1.
    Probability,
    "a probability from 0 to 1",
    |value| (0.0..=1.0).contains(&value),
    { "type": "number", "minimum": 0.0, "maximum": 1.0 }
);
quantity!(
    /// A finite number above 0.
    Positive,
    "a finite number above 0",
    |value| value > 0.0 && value.is_finite(),
    { "type": "number", "exclusiveMinimum": 0.0 }
);
quantity!(
    /// A finite number, 0 or above.
    NonNegative,
    "a finite number, 0 or above",
    |value| value >= 0.0 && value.is_finite(),
    { "type": "number", "minimum": 0.0 }
);
quantity!(
    /// Any finite number.
    Finite,
    "a finite number",
    f64::is_finite,
    { "type": "number" }
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_range_accepts_its_ends_and_refuses_what_lies_beyond() {
        assert!(Probability::try_from(0.0).is_ok() && Probability::try_from(1.0).is_ok());
        assert!(Probability::try_from(-0.01).is_err() && Probability::try_from(1.01).is_err());
        assert!(Positive::try_from(0.0).is_err() && NonNegative::try_from(0.0).is_ok());
        for bad in [f64::NAN, f64::INFINITY] {
            assert!(Probability::try_from(bad).is_err());
            assert!(Positive::try_from(bad).is_err());
            assert!(NonNegative::try_from(bad).is_err());
            assert!(Finite::try_from(bad).is_err());
        }
    }

    #[test]
    fn the_message_says_what_was_found_and_what_would_be_right() {
        let message = Probability::try_from(1.5).map_err(|error| error.to_string());
        assert_eq!(
            message,
            Err("1.5 is out of range: expected a probability from 0 to 1".into())
        );
    }
}
