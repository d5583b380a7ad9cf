//! In place of pictures, in a build without the `command` feature: nothing is drawn.

use crate::geometry::Vec2;
use crate::metrics::TrialRecord;
use crate::metrics::comparison::Comparison;
use crate::motion::ArenaConfig;

/// What stands still in every picture of a scenario.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Name of the scenario, for titles.
    pub name: String,
    /// The arena and its obstacles.
    pub arena: ArenaConfig,
    /// Communication range, metres.
    pub range: f64,
    /// Places of the mission's targets, metres from the centre.
    pub targets: Vec<Vec2>,
    /// Names of the roles, in the order of their numbers.
    pub roles: &'static [&'static str],
}

impl Scene {
    /// No pictures.
    #[must_use]
    pub fn draw(&self, _: &TrialRecord) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

/// No picture.
pub fn pareto(_: &Comparison) -> Option<String> {
    None
}
