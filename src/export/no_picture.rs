//! In place of pictures, in a build without the `command` feature: nothing is drawn.

use super::scene::Scene;
use crate::metrics::TrialRecord;
use crate::metrics::comparison::Comparison;
use crate::radio::Reach;

impl Scene {
    /// No pictures.
    #[must_use]
    pub fn draw(&self, _: &TrialRecord, _: &Reach) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

/// No picture.
pub fn pareto(_: &Comparison) -> Option<String> {
    None
}
