//! What stands still in every picture of a scenario.

use crate::geometry::Vec2;
use crate::motion::ArenaConfig;

/// What stands still in every picture of a scenario.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Name of the scenario, for titles.
    pub name: String,
    /// The arena and its obstacles.
    pub arena: ArenaConfig,
    /// Places of the mission's targets, metres from the centre.
    pub targets: Vec<Vec2>,
    /// Names of the roles, in the order of their numbers.
    pub roles: &'static [&'static str],
}

impl Scene {
    /// Name of a role.
    #[cfg(feature = "command")]
    pub(super) fn role(&self, number: u8) -> &'static str {
        self.roles.get(usize::from(number)).copied().unwrap_or("unknown")
    }
}
