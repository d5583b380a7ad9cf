//! Motion for protocols that have none of their own: robots that stand still, or wander whatever they hear.

use std::f64::consts::TAU;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::control::{PhaseConfig, Phases, Rhythm};
use crate::engine::{ActorId, KeyedStreams, Purpose, SimTime, Span, Streams};
use crate::geometry::{Vec2, direction, unit};
use crate::quantity::{NonNegative, Positive};

/// Where a robot goes next, by robot and leg: two words each.
const LEG: Purpose = Purpose::new("wander.leg");

/// A waypoint is reached from this near, metres.
const REACH: f64 = 0.05;

/// A robot that is not at its waypoint after this many times the way's time is blocked, and takes another one.
const PATIENCE: f64 = 2.0;

/// How robots move whose protocol does not say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum WanderConfig {
    /// Not at all.
    #[default]
    Still,
    /// Straight on, in a direction drawn anew for each leg.
    RandomWalk {
        /// Speed, m/s, at most `motion.max_speed`.
        speed: Positive,
        /// Seconds between changes of direction.
        leg: Positive,
    },
    /// Straight to a place drawn uniformly in the arena, then to another one.
    RandomWaypoint {
        /// Speed, m/s, at most `motion.max_speed`.
        speed: Positive,
        /// Seconds of rest at each place.
        #[serde(default = "no_rest")]
        pause: NonNegative,
    },
}

fn no_rest() -> NonNegative {
    NonNegative::new(0.0)
}

impl WanderConfig {
    /// How fast robots go, m/s.
    #[must_use]
    pub fn speed(&self) -> f64 {
        match self {
            Self::Still => 0.0,
            Self::RandomWalk { speed, .. } | Self::RandomWaypoint { speed, .. } => speed.get(),
        }
    }
}

/// What all robots of a trial share.
#[derive(Clone, Copy, Debug)]
pub struct Ground {
    config: WanderConfig,
    /// Half the width and height within which waypoints lie, metres.
    half: Vec2,
    phases: Phases,
    draws: KeyedStreams,
}

impl Ground {
    /// Robots move as `config` says, between waypoints at most `half` from the arena's centre in each axis, metres.
    #[must_use]
    pub fn new(config: WanderConfig, half: Vec2, phases: Phases, streams: Streams) -> Self {
        Self {
            config,
            half,
            phases,
            draws: streams.keyed(LEG),
        }
    }

    /// Robots that stand still.
    #[must_use]
    pub fn still() -> Self {
        let streams = Streams::new(0, 0);
        let phases = Phases::new(PhaseConfig::Together, streams);
        Self::new(WanderConfig::Still, Vec2::zeros(), phases, streams)
    }
}

/// One robot's way.
#[derive(Debug, Default)]
pub struct Wander {
    /// Legs begun so far.
    legs: u32,
    /// Where it goes on this leg, as a direction or a place.
    aim: Vec2,
    /// When this leg ends, if it does not end earlier.
    until: SimTime,
    resting: bool,
}

impl Wander {
    /// The velocity that `robot` wants at `now`, being at `position`; `None` if it never moves.
    pub fn velocity(&mut self, ground: &Ground, robot: ActorId, now: SimTime, position: Vec2) -> Option<Vec2> {
        match ground.config {
            WanderConfig::Still => None,
            WanderConfig::RandomWalk { speed, leg } => {
                if now >= self.until {
                    self.until = self.end_of_leg(ground, robot, now, Span::from_secs(leg.get()));
                    let [angle, _] = self.draw(ground, robot);
                    self.aim = unit(angle * TAU);
                }
                Some(self.aim * speed.get())
            }
            WanderConfig::RandomWaypoint { speed, pause } => {
                let arrived = self.legs > 0 && !self.resting && (self.aim - position).norm() <= REACH;
                if arrived {
                    self.resting = true;
                    self.until = now + Span::from_secs(pause.get());
                }
                if now >= self.until {
                    self.resting = false;
                    let [x, y] = self.draw(ground, robot);
                    let [x, y] = [x, y].map(|share| 2.0 * share - 1.0);
                    self.aim = Vec2::new(x * ground.half.x, y * ground.half.y);
                    let time = (self.aim - position).norm() / speed.get();
                    self.until = now + Span::from_secs(PATIENCE * time);
                }
                let moving = f64::from(u8::from(!self.resting));
                Some(direction(self.aim - position) * speed.get() * moving)
            }
        }
    }

    /// The end of the leg that begins at `now`: the first one ends early by the robot's phase, later ones are as long on average
    /// as they are asked to be, though robots turn at control steps alone.
    fn end_of_leg(&self, ground: &Ground, robot: ActorId, now: SimTime, leg: Span) -> SimTime {
        let leg = Span::from_nanos(leg.as_nanos().max(1));
        if self.legs == 0 {
            return now + leg - ground.phases.span(robot, Rhythm::Leg, leg);
        }
        let missed = now.since(self.until).as_nanos() / leg.as_nanos();
        self.until + leg * (missed + 1)
    }

    /// Two numbers in [0, 1) for the next leg.
    fn draw(&mut self, ground: &Ground, robot: ActorId) -> [f64; 2] {
        let words = ground.draws.first_two(robot.0, 0, self.legs);
        self.legs += 1;
        words.map(|word| (word >> 11) as f64 / (1_u64 << 53) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ground(config: WanderConfig) -> Ground {
        let streams = Streams::new(5, 0);
        let phases = Phases::new(PhaseConfig::Together, streams);
        Ground::new(config, Vec2::new(4.0, 3.0), phases, streams)
    }

    /// Places of a robot at every 0.1 s.
    fn walk(config: WanderConfig, robot: u32, seconds: u32) -> Vec<Vec2> {
        let ground = ground(config);
        let mut wander = Wander::default();
        let mut position = Vec2::zeros();
        let step = |step| {
            let now = SimTime::from_secs(f64::from(step) / 10.0);
            let velocity = wander.velocity(&ground, ActorId(robot), now, position).unwrap();
            position += velocity * 0.1;
            position
        };
        (0..10 * seconds).map(step).collect()
    }

    fn waypoint(pause: f64) -> WanderConfig {
        WanderConfig::RandomWaypoint {
            speed: Positive::new(0.2),
            pause: NonNegative::new(pause),
        }
    }

    #[test]
    fn a_still_robot_commands_nothing() {
        let mut wander = Wander::default();
        let none = wander.velocity(&Ground::still(), ActorId(0), SimTime::ZERO, Vec2::zeros());
        assert_eq!((none, wander.legs), (None, 0));
    }

    #[test]
    fn a_walker_turns_once_a_leg_and_keeps_its_speed() {
        let config = WanderConfig::RandomWalk {
            speed: Positive::new(0.2),
            leg: Positive::new(1.0),
        };
        let places = walk(config, 3, 20);
        let steps: Vec<Vec2> = places.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(steps.iter().all(|step| (step.norm() - 0.02).abs() < 1e-9));
        let turns = steps
            .windows(2)
            .filter(|pair| (pair[1] - pair[0]).norm() > 1e-6)
            .count();
        assert_eq!(turns, 19);
    }

    #[test]
    fn a_robot_between_waypoints_stays_in_its_ground_and_others_go_elsewhere() {
        let places = walk(waypoint(0.0), 3, 400);
        assert!(places.iter().all(|place| place.x.abs() <= 4.0 && place.y.abs() <= 3.0));
        assert_ne!(places.last(), walk(waypoint(0.0), 4, 400).last());
        let widest = places.iter().map(Vec2::norm).fold(0.0, f64::max);
        assert!(widest > 2.0, "{widest}");
    }

    #[test]
    fn a_robot_rests_at_each_waypoint_and_one_that_is_blocked_takes_another() {
        let places = walk(waypoint(5.0), 3, 200);
        let rests = places.windows(2).filter(|pair| pair[0] == pair[1]).count();
        assert!(rests > 40, "{rests} steps of rest");
        let mut wander = Wander::default();
        let ground = ground(waypoint(0.0));
        for second in 0..200 {
            let now = SimTime::from_secs(f64::from(second));
            wander.velocity(&ground, ActorId(3), now, Vec2::zeros());
        }
        assert!(wander.legs > 2, "{} legs of a robot that cannot move", wander.legs);
    }
}
