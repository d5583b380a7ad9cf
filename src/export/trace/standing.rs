//! How robots stand while a run is traced: the role of each, and whether a fault ails it.

use crate::engine::ActorId;
use crate::happenings::log::{Event, What};

/// How robots stand.
#[derive(Debug, Default)]
pub struct Standing {
    roles: Vec<u8>,
    /// How many faults ail each.
    ailments: Vec<u32>,
}

impl Standing {
    /// So many robots, all well and of the first role.
    pub fn of(robots: usize) -> Self {
        Self {
            roles: vec![0; robots],
            ailments: vec![0; robots],
        }
    }

    /// Takes in what happened.
    pub fn take(&mut self, event: &Event) {
        let Some(robot) = event.robot.map(ActorId::index) else {
            return;
        };
        match event.what {
            What::Enters(role) => self.roles[robot] = role,
            What::Fails(_) => self.ailments[robot] += 1,
            What::Recovers(_) => self.ailments[robot] = self.ailments[robot].saturating_sub(1),
            _ => {}
        }
    }

    /// How many robots there are.
    pub fn robots(&self) -> usize {
        self.roles.len()
    }

    /// The number of a robot's role.
    pub fn role(&self, robot: usize) -> u8 {
        self.roles[robot]
    }

    /// Whether no fault ails a robot.
    pub fn is_well(&self, robot: usize) -> bool {
        self.ailments[robot] == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::SimTime;
    use crate::faults::Effect;

    #[test]
    fn a_robot_is_well_again_once_nothing_ails_it() {
        let mut standing = Standing::of(2);
        let mut happens = |what| {
            standing.take(&Event {
                at: SimTime::ZERO,
                robot: Some(ActorId(1)),
                what,
            });
            (standing.role(1), standing.is_well(1))
        };
        assert_eq!(happens(What::Enters(3)), (3, true));
        assert_eq!(happens(What::Fails(Effect::Mute)), (3, false));
        assert_eq!(happens(What::Fails(Effect::Deaf)), (3, false));
        assert_eq!(happens(What::Recovers(Effect::Mute)), (3, false));
        assert_eq!(happens(What::Recovers(Effect::Deaf)), (3, true));
        assert_eq!((standing.role(0), standing.is_well(0)), (0, true));
    }
}
