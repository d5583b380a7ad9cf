//! How strong a robot is at another: powers, path loss, shadowing, walls, fading; and who is in range by that.

use crate::engine::{ActorId, SimTime};
use crate::geometry::{Vec2, at_most};
use crate::radio::propagation::{Fading, PathLoss, Shadowing, Walls};
use crate::radio::reach::{Contact, Links, Placed};

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
    /// The mean power at which one in a hundred does, dBm: below it nobody out of range is thought of.
    pub faintest: f64,
    /// The power below which a burst is not even noise, dBm.
    pub floor: f64,
    /// The greatest of `sends`, and of `gains`.
    pub strongest: f64,
    pub best_gain: f64,
    /// Standard deviation of shadowing, dB.
    pub sigma: f64,
}

/// Who sends.
#[derive(Clone, Copy, Debug)]
pub(super) enum Source {
    /// A robot.
    Robot(ActorId),
    /// A sender of noise, by its place among these, and how strong it is with its antenna's gain, dBm.
    Jammer { place: u32, power: f64 },
}

impl Source {
    /// Whether it is this robot.
    pub fn is(self, robot: ActorId) -> bool {
        matches!(self, Self::Robot(sender) if sender == robot)
    }

    /// The ends of a link from `here` to `to`. It is the same both ways: it is always seen from the lower number, and from robots before jammers.
    fn ends(self, here: Vec2, to: Placed) -> [Vec2; 2] {
        match self {
            Self::Robot(from) if from <= to.0 => [here, to.1],
            Self::Robot(_) | Self::Jammer { .. } => [to.1, here],
        }
    }
}

/// A strength that everything at all hears: infrared has no other.
const PRESENT_DBM: f64 = 0.0;

/// A strength between that and nothing.
pub(super) const UNSEEN_DBM: f64 = -1.0;

impl LinkBudget {
    /// How far what a source sends is looked for, metres.
    pub fn audible(&self, source: Source) -> f64 {
        match source {
            Source::Robot(_) => self
                .infrared
                .unwrap_or_else(|| self.distance_at(self.floor.min(self.faintest))),
            Source::Jammer { power, .. } => self
                .path
                .distance_at(power + self.best_gain - self.floor + DEVIATIONS * self.sigma),
        }
    }

    /// How far the strongest robot reaches with so much power, shadowing at its best, metres.
    pub fn distance_at(&self, power_dbm: f64) -> f64 {
        self.path
            .distance_at(self.strongest + self.best_gain - power_dbm + DEVIATIONS * self.sigma)
    }

    /// The mean power of a source that is at `here` at a robot over fading, dBm; −∞ where nothing arrives.
    pub fn mean_dbm(&self, source: Source, here: Vec2, (robot, there): Placed) -> f64 {
        let ends @ [low, high] = source.ends(here, (robot, there));
        let sends = match source {
            Source::Robot(from) => {
                if let Some(range) = self.infrared {
                    let sees = (low - high).norm() <= at_most(range) && !self.is_blocked(ends);
                    return if sees { PRESENT_DBM } else { f64::NEG_INFINITY };
                }
                self.sends[from.index()]
            }
            Source::Jammer { power, .. } => power,
        };
        let mut power = sends + self.gains[robot.index()] - self.path.loss_db((low - high).norm());
        if let Some(shadowing) = &self.shadowing {
            power += shadowing.db(low, high);
        }
        if let Some(walls) = &self.walls {
            power -= walls.loss_db(low, high);
        }
        power
    }

    /// By how much fading makes it stronger at an instant, a plain ratio.
    pub fn gain(&self, source: Source, here: Vec2, to: Placed, at: SimTime) -> f64 {
        let [low, high] = source.ends(here, to);
        self.fading.gain(low, high, at.as_secs())
    }

    /// Whether a wall stands between two places.
    fn is_blocked(&self, [here, there]: [Vec2; 2]) -> bool {
        self.walls.as_ref().is_some_and(|walls| walls.blocked(here, there))
    }
}

impl Links for LinkBudget {
    fn farthest(&self) -> f64 {
        self.infrared.unwrap_or_else(|| self.distance_at(self.threshold))
    }

    fn earshot(&self) -> f64 {
        self.infrared.unwrap_or_else(|| self.distance_at(self.faintest))
    }

    fn connects(&self, from: Placed, to: Placed) -> bool {
        self.contact(from, to) == Contact::InRange
    }

    fn contact(&self, from: Placed, to: Placed) -> Contact {
        match self.mean_dbm(Source::Robot(from.0), from.1, to) {
            mean if mean >= self.threshold => Contact::InRange,
            mean if mean >= self.faintest => Contact::Beyond,
            _ => Contact::None,
        }
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
