//! Shadowing and fading against the laws that they are made to follow.
//!
//! One field is one draw of many waves, and its values at different places hang together. So what is measured is measured in many fields that are independent of each other, and its standard error is that of their
//! mean: of the closed form's variance where that is known, else of the fields' own spread.

mod degree;
mod fading;
mod shadowing;

use desim::engine::Streams;

use super::statistics::{assert_near, mean, variance};

/// The streams of field number `field`.
fn streams(field: u32) -> Streams {
    Streams::new(20_260_101, field)
}

/// What `measure` gives in each of so many fields.
fn in_fields(fields: u32, measure: impl Fn(&Streams) -> f64) -> Vec<f64> {
    (0..fields).map(|field| measure(&streams(field))).collect()
}

/// Asserts that the mean of what was measured in independent fields is as `expected`, by their own spread.
#[track_caller]
fn assert_mean(what: &str, measured: &[f64], expected: f64) {
    let standard_error = (variance(measured) / measured.len() as f64).sqrt();
    assert_near(what, mean(measured), expected, standard_error);
}
