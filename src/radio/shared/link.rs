//! How strong a robot is at another: powers, path loss, shadowing, walls, fading; and who is in range by that.

use crate::engine::{ActorId, SimTime};
use crate::geometry::{Vec2, at_most};
use crate::radio::propagation::{Fading, PathLoss, Shadowing, Walls};
use crate::radio::reach::{Links, Placed};

/// How many standard deviations of shadowing are looked beyond the mean for robots that it brings near: one link in 700 is stronger.
const DEVIATIONS: f64 = 3.0;

/// The links of a run. Places decide all of it, and robots' own powers: there is no state.
#[derive(Debug)]
pub(super) struct LinkBudget {
    pub path: PathLoss,
    pub shadowing: Option<Shadowing>,
    pub fading: Fading,
    pub walls: Option<Walls>,
    /// What each robot sends in the direction of others, its antenna's gain included, dBm.
    pub sends: Vec<f64>,
    /// The gain of each robot's antenna as it receives, dB.
    pub gains: Vec<f64>,
    /// Over infrared there are no powers: robots hear each other up to so many metres.
    pub infrared: Option<f64>,
    /// The mean power at which a lone frame comes through half of the time, dBm.
    pub threshold: f64,
    /// The power below which a burst is not even noise, dBm.
    pub floor: f64,
    /// The greatest of `sends`, and of `gains`.
    pub strongest: f64,
    pub best_gain: f64,
    /// Standard deviation of shadowing, dB.
    pub sigma: f64,
}

/// A strength that everything at all hears: infrared has no other.
const PRESENT_DBM: f64 = 0.0;

/// A strength between that and nothing.
pub(super) const UNSEEN_DBM: f64 = -1.0;

impl LinkBudget {
    /// How far a burst is looked for, metres.
    pub fn audible(&self) -> f64 {
        self.infrared
            .unwrap_or_else(|| self.distance_at(self.floor.min(self.threshold)))
    }

    /// How far the strongest robot reaches with so much power, shadowing at its best, metres.
    fn distance_at(&self, power_dbm: f64) -> f64 {
        self.path
            .distance_at(self.strongest + self.best_gain - power_dbm + DEVIATIONS * self.sigma)
    }

    /// The mean power of `from` at `to` over fading, dBm; −∞ where nothing arrives.
    pub fn mean_dbm(&self, from: Placed, to: Placed) -> f64 {
        // A link is the same both ways: it is always seen from the lower number.
        let [low, high] = if from.0 <= to.0 { [from.1, to.1] } else { [to.1, from.1] };
        if let Some(range) = self.infrared {
            let sees = (low - high).norm() <= at_most(range) && !self.is_blocked(low, high);
            return if sees { PRESENT_DBM } else { f64::NEG_INFINITY };
        }
        let mut power = self.sends[from.0.index()] + self.gains[to.0.index()] - self.path.loss_db((low - high).norm());
        if let Some(shadowing) = &self.shadowing {
            power += shadowing.db(low, high);
        }
        if let Some(walls) = &self.walls {
            power -= walls.loss_db(low, high);
        }
        power
    }

    /// The power of `from` at `to` at an instant, milliwatts.
    pub fn milliwatts(&self, from: Placed, to: Placed, at: SimTime) -> f64 {
        let mean = self.mean_dbm(from, to);
        if mean < self.floor {
            return 0.0;
        }
        let [low, high] = if from.0 <= to.0 { [from.1, to.1] } else { [to.1, from.1] };
        super::receiver::milliwatts(mean) * self.fading.gain(low, high, at.as_secs())
    }

    /// How far noise of so much power is looked for, metres.
    pub fn audible_from(&self, power: f64) -> f64 {
        self.path
            .distance_at(power + self.best_gain - self.floor + DEVIATIONS * self.sigma)
    }

    /// The power of a sender of noise at a robot, milliwatts.
    pub fn noise_milliwatts(&self, power: f64, from: Vec2, (robot, to): Placed, at: SimTime) -> f64 {
        let mut mean = power + self.gains[robot.index()] - self.path.loss_db((to - from).norm());
        // Nobody has the highest number: a link is always seen from the robot.
        if let Some(shadowing) = &self.shadowing {
            mean += shadowing.db(to, from);
        }
        if let Some(walls) = &self.walls {
            mean -= walls.loss_db(to, from);
        }
        if mean < self.floor {
            return 0.0;
        }
        super::receiver::milliwatts(mean) * self.fading.gain(to, from, at.as_secs())
    }

    /// Whether a wall stands between two places.
    fn is_blocked(&self, here: Vec2, there: Vec2) -> bool {
        self.walls.as_ref().is_some_and(|walls| walls.blocked(here, there))
    }
}

impl Links for LinkBudget {
    fn farthest(&self) -> f64 {
        self.infrared.unwrap_or_else(|| self.distance_at(self.threshold))
    }

    fn connects(&self, from: Placed, to: Placed) -> bool {
        self.mean_dbm(from, to) >= self.threshold
    }
}

/// Which of the bodies between two robots is in the way of light: a disc of so much `radius` whose centre is nearer to the line than that.
pub(super) fn hides(body: Vec2, radius: f64, here: Vec2, there: Vec2) -> bool {
    let along = there - here;
    let length = along.norm_squared();
    if length == 0.0 {
        return false;
    }
    let share = along.dot(&(body - here)) / length;
    (0.0..=1.0).contains(&share) && (here + along * share - body).norm_squared() < radius * radius
}

/// A place that belongs to no robot, such as a jammer's, to be seen from robots.
pub(super) const NOBODY: ActorId = ActorId(u32::MAX);
