//! How many relays a chain takes.

use crate::geometry::at_least;

/// The fewest relays that bring a worker within `threshold` of a target `distance` away in hops of at most `safe`.
#[must_use]
pub fn relays_needed(distance: f64, threshold: f64, safe: f64) -> usize {
    let hops = at_least((distance - threshold) / safe).ceil();
    (hops as usize).saturating_sub(1)
}
