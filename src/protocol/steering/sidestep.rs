//! Stepping aside: what a robot does that wants to move and does not (ours; robots wall each other in otherwise).

use std::f64::consts::TAU;

use rand::RngExt as _;
use rand_philox::Philox;

use crate::geometry::{Vec2, unit};

/// Share of the stall time for which a robot steps aside.
const DURATION: f64 = 0.33;

/// When a robot is stuck: after so many control steps in which it came less than `progress` metres farther.
#[derive(Clone, Copy, Debug)]
pub struct Patience {
    /// Control steps without progress after which a robot steps aside.
    pub stall_steps: u64,
    /// Metres that count as progress.
    pub progress: f64,
}

/// Watches one robot's progress.
#[derive(Debug, Default)]
pub struct Sidestep {
    /// Where it last made progress, and at which control step.
    anchor: Vec2,
    since: u64,
    /// The way aside, until this control step.
    aside: Vec2,
    until: u64,
}

impl Sidestep {
    /// The velocity to command when `desired` is wanted at `position` on control step `step`: another one while the
    /// robot steps aside, after `patience` without progress.
    pub fn adjust(
        &mut self,
        desired: Vec2,
        position: Vec2,
        step: u64,
        patience: Patience,
        random: &mut Philox,
    ) -> Vec2 {
        let Patience { stall_steps, progress } = patience;
        if step < self.until {
            return self.aside * desired.norm();
        }
        let progressed = (position - self.anchor).norm() >= progress;
        if progressed || desired == Vec2::zeros() {
            self.anchor = position;
            self.since = step;
        } else if step - self.since >= stall_steps {
            self.aside = unit(random.random_range(0.0..TAU));
            self.until = step + (stall_steps as f64 * DURATION).ceil() as u64;
            self.since = self.until;
        }
        desired
    }
}

impl Sidestep {
    /// Takes note that the robot is at `position` on control step `step` and has no reason to step aside.
    pub fn rest(&mut self, position: Vec2, step: u64) {
        self.anchor = position;
        self.since = step;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PATIENCE: Patience = Patience {
        stall_steps: 30,
        progress: 0.01,
    };

    #[test]
    fn a_robot_that_wants_to_move_and_does_not_steps_aside_for_a_while() {
        let mut sidestep = Sidestep::default();
        let mut random = Philox::from_u64_seed(1);
        let desired = Vec2::new(0.02, 0.0);
        let commands: Vec<Vec2> = (0..60)
            .map(|step| sidestep.adjust(desired, Vec2::zeros(), step, PATIENCE, &mut random))
            .collect();
        let aside = commands.iter().filter(|command| **command != desired).count();
        assert_eq!(aside, 9);
        assert!(commands.iter().all(|command| (command.norm() - 0.02).abs() < 1e-12));
    }

    #[test]
    fn a_robot_that_rested_gets_its_full_time_before_it_steps_aside() {
        let mut sidestep = Sidestep::default();
        let mut random = Philox::from_u64_seed(1);
        let desired = Vec2::new(0.02, 0.0);
        sidestep.rest(Vec2::zeros(), 100);
        for step in 101..=130 {
            assert_eq!(
                sidestep.adjust(desired, Vec2::zeros(), step, PATIENCE, &mut random),
                desired
            );
        }
        assert_ne!(
            sidestep.adjust(desired, Vec2::zeros(), 131, PATIENCE, &mut random),
            desired
        );
    }

    #[test]
    fn a_robot_that_moves_or_rests_never_steps_aside() {
        let mut sidestep = Sidestep::default();
        let mut random = Philox::from_u64_seed(1);
        for step in 0..200 {
            let (desired, position) = if step < 100 {
                (Vec2::new(0.02, 0.0), Vec2::new(0.002 * step as f64, 0.0))
            } else {
                (Vec2::zeros(), Vec2::new(0.2, 0.0))
            };
            assert_eq!(sidestep.adjust(desired, position, step, PATIENCE, &mut random), desired);
        }
    }
}
