//! What robots have reported of themselves: role, target, parents.

use crate::engine::ActorId;
use crate::protocol::{Note, Role};

/// The latest reports of every robot, by id.
#[derive(Debug)]
pub(super) struct Reports {
    pub(super) roles: Vec<Role>,
    pub(super) targets: Vec<Option<u16>>,
    pub(super) parents: Vec<Vec<ActorId>>,
}

impl Reports {
    /// No reports: every robot in the first role, without target and parents.
    pub(super) fn new(robots: usize) -> Self {
        Self {
            roles: vec![Role::default(); robots],
            targets: vec![None; robots],
            parents: vec![Vec::new(); robots],
        }
    }

    /// Takes in a report.
    ///
    /// # Panics
    /// If it names a parent that is no robot of this run.
    pub(super) fn note(&mut self, robot: ActorId, note: &Note) {
        match note {
            Note::Role(role) => self.roles[robot.index()] = *role,
            Note::Target(target) => self.targets[robot.index()] = *target,
            Note::Parents(parents) => {
                let robots = self.parents.len();
                for parent in parents {
                    assert!(
                        parent.index() < robots,
                        "robot {robot} reported parent {parent}, one of {robots} robots"
                    );
                }
                self.parents[robot.index()].clone_from(parents);
            }
            // Beliefs about failures change nothing of the traffic, the graph or the mission; what was heard twice, who
            // knows what, and what robots count and measure are kept elsewhere.
            Note::Watches(_)
            | Note::Suspects { .. }
            | Note::Trusts(_)
            | Note::Duplicate { .. }
            | Note::Informed { .. }
            | Note::Count { .. }
            | Note::Value { .. } => {}
        }
    }

    /// The robots in role `role`, by id.
    pub(super) fn in_role(&self, role: Role) -> impl Iterator<Item = ActorId> {
        let roles = self.roles.iter().zip(0..);
        roles
            .filter(move |(its_role, _)| **its_role == role)
            .map(|(_, id)| ActorId(id))
    }

    /// The robots in role `role` that work for `target`, by id.
    pub(super) fn working_for(&self, target: usize, role: Role) -> impl Iterator<Item = ActorId> {
        let wanted = u16::try_from(target).ok();
        let states = self.roles.iter().zip(&self.targets).zip(0..);
        states
            .filter(move |&((its_role, its_target), _)| {
                *its_role == role && its_target.is_some() && *its_target == wanted
            })
            .map(|(_, id)| ActorId(id))
    }

    /// Robots in each of `roles` roles.
    pub(super) fn count_roles(&self, roles: usize) -> Vec<u32> {
        let mut counts = vec![0; roles];
        for role in &self.roles {
            counts[usize::from(role.0)] += 1;
        }
        counts
    }
}
