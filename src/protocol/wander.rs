//! Motion for protocols that have none of their own: robots that stand still, or wander whatever they hear.

use std::f64::consts::TAU;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::control::{ControlConfig, Phases, Rhythm};
use crate::engine::{ActorId, KeyedStreams, Purpose, SimTime, Span, Streams};
use crate::geometry::{Vec2, clamp_length, direction, unit};
use crate::quantity::{NonNegative, Positive};

/// Where a robot goes next, by robot and leg: two words each.
const LEG: Purpose = Purpose::new("wander.leg");

/// A robot that is not at its waypoint after this many times the way's time, and a control step, is blocked, and takes another one.
const PATIENCE: f64 = 2.0;
/// A robot that comes this much nearer in the control step in which it was to arrive has arrived, as well as its drive allows.
const ARRIVED: f64 = 0.5;

/// How robots move whose protocol does not say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum WanderConfig {
    /// Not at all.
    #[default]
    Still,
    /// Straight on, in a direction drawn anew for each leg, and reflected by the arena's walls: in the long run a robot is anywhere
    /// with the same probability.
    RandomWalk {
        /// Speed, m/s, at most `motion.max_speed`.
        speed: Positive,
        /// Seconds between changes of direction.
        leg: Positive,
    },
    /// Straight to a place drawn uniformly in the arena, a body's width from its walls, then to another one: in the long run a
    /// robot is more often in the middle than near walls.
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
    /// Half the width and height that a robot's centre can reach, metres.
    room: Vec2,
    /// The same for waypoints.
    half: Vec2,
    /// From one control step to the next, seconds.
    period: f64,
    phases: Phases,
    draws: KeyedStreams,
}

impl Ground {
    /// Robots of `body_radius` metres move as `config` says in an empty arena of `size` metres, with control steps as `control`
    /// has them. Waypoints leave a body's width to the walls.
    #[must_use]
    pub fn new(config: WanderConfig, size: Vec2, body_radius: f64, control: &ControlConfig, streams: Streams) -> Self {
        let leaving = |margin: f64| (size / 2.0).add_scalar(-margin).sup(&Vec2::zeros());
        Self {
            config,
            room: leaving(body_radius),
            half: leaving(2.0 * body_radius),
            period: control.period.get(),
            phases: Phases::new(control.phase, streams),
            draws: streams.keyed(LEG),
        }
    }

    /// Robots that stand still.
    #[must_use]
    pub fn still() -> Self {
        let control = ControlConfig::default();
        Self::new(WanderConfig::Still, Vec2::zeros(), 0.0, &control, Streams::new(0, 0))
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
    doing: Doing,
}

/// What a robot between waypoints does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Doing {
    #[default]
    Driving,
    /// This was its way at the last control step, short enough to arrive by this one.
    Arriving(Vec2),
    Resting,
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
                Some(self.stride(ground, position, speed.get()))
            }
            WanderConfig::RandomWaypoint { speed, pause } => {
                let speed = speed.get();
                if self.has_arrived(position) {
                    self.doing = Doing::Resting;
                    self.until = now + Span::from_secs(pause.get());
                }
                if now >= self.until {
                    self.doing = Doing::Driving;
                    let [x, y] = self.draw(ground, robot);
                    let [x, y] = [x, y].map(|share| 2.0 * share - 1.0);
                    self.aim = Vec2::new(x * ground.half.x, y * ground.half.y);
                    let time = (self.aim - position).norm() / speed + ground.period;
                    self.until = now + Span::from_secs(PATIENCE * time);
                }
                Some(self.approach(ground, position, speed))
            }
        }
    }

    /// The velocity of a walker at `position`. The walls reflect it: where it would cross one before the next control step, it makes
    /// for the place where a ball would be by then.
    fn stride(&mut self, ground: &Ground, position: Vec2, speed: f64) -> Vec2 {
        let mut velocity = self.aim * speed;
        for axis in [0, 1] {
            let (place, room) = (position[axis], ground.room[axis]);
            let end = place + velocity[axis] * ground.period;
            if end.abs() > room && end * velocity[axis] > 0.0 {
                self.aim[axis] = -self.aim[axis];
                let mirrored = end.signum() * 2.0 * room - end;
                velocity[axis] = (mirrored.clamp(-room, room) - place) / ground.period;
            }
        }
        clamp_length(velocity, speed)
    }

    /// The velocity towards the waypoint, from a place near enough such that the next control step finds it there.
    fn approach(&mut self, ground: &Ground, position: Vec2, speed: f64) -> Vec2 {
        if self.doing == Doing::Resting {
            return Vec2::zeros();
        }
        let way = self.aim - position;
        if way.norm() > speed * ground.period {
            self.doing = Doing::Driving;
            return direction(way) * speed;
        }
        self.doing = Doing::Arriving(way);
        way / ground.period
    }

    /// Whether it is at its waypoint, or has just passed it. One that was still turning goes on.
    fn has_arrived(&self, position: Vec2) -> bool {
        let Doing::Arriving(way) = self.doing else { return false };
        let left = self.aim - position;
        left.dot(&way) <= 0.0 || left.norm() <= ARRIVED * way.norm()
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
mod tests;
