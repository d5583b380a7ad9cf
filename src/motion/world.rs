//! The world of a run: every robot's body and drive, advanced in ticks.

use super::arena::Arena;
use super::config::{ArenaConfig, MotionConfig};
use super::contact::Contacts;
use super::drive::{Chassis, Drive};
use super::grid::Grid;
use crate::engine::{ActorId, SimTime, Span, prefetch};
use crate::geometry::{Pose, Vec2, at_most};

/// The least distance that proximity reports, in metres, for a body of this radius: what touches still has a direction.
const TOUCH: f64 = 1e-6;
const OF_RADIUS: f64 = 0.07;

/// All robots in the arena, at the last tick and on their way to the next.
///
/// Between two ticks every robot moves in a straight line at constant velocity, so where it is at any instant up to
/// the next tick is known exactly. A command is taken up at the next tick.
pub struct World {
    now: SimTime,
    tick: Span,
    max_travel: f64,
    body_radius: f64,
    proximity_range: f64,
    arena: Arena,
    chassis: Chassis,
    positions: Vec<Vec2>,
    velocities: Vec<Vec2>,
    drives: Vec<Drive>,
    /// Whether a robot changes place on the way to the next tick.
    moving: bool,
    /// In how many ticks any robot has changed place.
    moves: u32,
    /// Whether a drive does anything at all, or will at the next tick.
    stirring: bool,
    movers: Vec<u32>,
    contacts: Contacts,
    /// For the radio: coarse.
    neighbours: Grid,
    /// For contacts and proximity: fine.
    bodies: Grid,
    #[cfg(test)]
    rebuilds: u32,
}

impl World {
    /// A world at the start of a run, with robots at `poses` (as [`deploy`](super::deploy) gives them: bodies do not
    /// overlap), all standing. `neighbour_range`, in metres, is the range that
    /// [`for_each_within`](Self::for_each_within) will mostly be asked about; it decides speed only.
    #[must_use]
    pub fn new(config: &MotionConfig, arena: &ArenaConfig, poses: Vec<Pose>, neighbour_range: f64) -> Self {
        let tick = Span::from_secs(config.tick.get());
        let body_radius = config.body_radius.get();
        let max_speed = config.max_speed.get();
        let proximity_range = config.proximity_range.get();
        let body_reach = 2.0 * body_radius + proximity_range.max(2.0 * max_speed * tick.as_secs());
        let robots = poses.len();
        let (positions, drives) = poses
            .into_iter()
            .map(|pose| (pose.position, Drive::new(pose.heading)))
            .unzip();
        let mut world = Self {
            now: SimTime::ZERO,
            tick,
            max_travel: max_speed * tick.as_secs(),
            body_radius,
            proximity_range,
            arena: Arena::new(arena),
            chassis: Chassis::new(config, tick.as_secs()),
            positions,
            velocities: vec![Vec2::zeros(); robots],
            drives,
            moving: false,
            moves: 0,
            stirring: false,
            movers: Vec::new(),
            contacts: Contacts::new(robots, body_radius, tick.as_secs(), max_speed),
            // Half the range: a search then looks at five rows of cells and at a third fewer robots than with three.
            neighbours: Grid::new((neighbour_range / 2.0).max(body_reach)),
            bodies: Grid::new(body_reach),
            #[cfg(test)]
            rebuilds: 0,
        };
        world.index();
        world
    }

    /// Time of the last tick.
    #[must_use]
    pub fn now(&self) -> SimTime {
        self.now
    }

    /// From one tick to the next.
    #[must_use]
    pub fn tick(&self) -> Span {
        self.tick
    }

    /// Sets the velocity that robot `id` is to reach, in the arena's axes, m/s. It is shortened to the largest speed,
    /// taken up at the next tick, and kept until replaced. Below the largest speed over 26,000, or if it is not finite,
    /// the robot is to stand and keeps its heading.
    pub fn command(&mut self, id: ActorId, velocity: Vec2) {
        let drive = &mut self.drives[id.index()];
        drive.command(&self.chassis, velocity);
        self.stirring |= !drive.rests();
    }

    /// Goes on to the next tick: every robot arrives where [`position`](Self::position) said it would be, and drives
    /// and contacts decide how it moves from there.
    pub fn advance(&mut self) {
        self.now += self.tick;
        if !self.stirring && !self.moving {
            return;
        }
        let moved = self.travel();
        self.steer();
        let Self {
            contacts,
            movers,
            positions,
            velocities,
            bodies,
            arena,
            ..
        } = self;
        contacts.settle(movers, positions, velocities, bodies, arena);
        self.moving = self.velocities.iter().any(|velocity| *velocity != Vec2::zeros());
        if moved || self.moving {
            self.index();
        }
    }

    /// Whether any robot changes place on the way to the next tick.
    #[must_use]
    pub fn is_moving(&self) -> bool {
        self.moving
    }

    /// While nobody moves, a number that is another after anybody has: as long as it is the same, everybody is where they were.
    #[must_use]
    pub fn standing(&self) -> Option<u32> {
        (!self.moving).then_some(self.moves)
    }

    /// How far a robot gets from one tick to the next at most, metres.
    #[must_use]
    pub fn max_travel(&self) -> f64 {
        self.max_travel
    }

    /// Where robot `id` was at the last tick, metres from the arena's centre, and its velocity until the next one, m/s.
    #[must_use]
    pub fn course(&self, id: ActorId) -> (Vec2, Vec2) {
        (self.positions[id.index()], self.velocities[id.index()])
    }

    /// Asks for where robot `id` is.
    pub fn prefetch_row(&self, id: ActorId) {
        prefetch(&self.positions[id.index()]);
        prefetch(&self.drives[id.index()]);
    }

    /// Asks for what a search within `range` metres of robot `id` will read.
    pub fn prefetch_neighbours(&self, id: ActorId, range: f64) {
        self.neighbours.prefetch(self.positions[id.index()], range);
    }

    /// Where robot `id` is at instant `at`, from the last tick to the next; metres from the arena's centre.
    #[inline]
    #[must_use]
    pub fn position(&self, id: ActorId, at: SimTime) -> Vec2 {
        let position = self.positions[id.index()];
        // In a swarm at rest velocities are not even looked at.
        if self.moving {
            position + self.velocities[id.index()] * self.elapsed(at)
        } else {
            position
        }
    }

    /// Where robot `id` is at instant `at`, from the last tick to the next, and which way it faces.
    #[must_use]
    pub fn pose(&self, id: ActorId, at: SimTime) -> Pose {
        Pose {
            position: self.position(id, at),
            heading: self.drives[id.index()].heading(self.elapsed(at)),
        }
    }

    /// Where all robots were at the last tick, in order of their ids; metres from the arena's centre.
    #[must_use]
    pub fn positions(&self) -> &[Vec2] {
        &self.positions
    }

    /// Calls `visit` once for each other robot whose centre is within `range` metres of that of robot `id` at instant
    /// `at` (from the last tick to the next), the rim included: with its id and its position relative to robot `id`, in
    /// the arena's axes. The order is the same in every run, and follows no rule that callers should rely on.
    #[inline]
    pub fn for_each_within(&self, id: ActorId, at: SimTime, range: f64, mut visit: impl FnMut(ActorId, Vec2)) {
        let centre = self.position(id, at);
        self.for_each_around(centre, at, range, |other, place| {
            if other != id {
                visit(other, place - centre);
            }
        });
    }

    /// Calls `visit` once for each robot whose centre is within `range` metres of the place `centre` at instant `at` (from the last tick
    /// to the next), the rim included: with its id and where it is, metres from the arena's centre. The order is as in
    /// [`for_each_within`](Self::for_each_within).
    #[inline]
    pub fn for_each_around(&self, centre: Vec2, at: SimTime, range: f64, mut visit: impl FnMut(ActorId, Vec2)) {
        self.neighbours
            .for_each_within(centre, self.elapsed(at), range, |robot, place| {
                visit(ActorId(robot), place);
            });
    }

    /// Adds to `out` what the proximity sensors of robot `id` see at instant `at` (from the last tick to the next): the
    /// vector from its edge to the nearest point of each body within the proximity range, in the arena's axes, metres.
    /// Other robots come first, then the arena's walls, then obstacles. What touches is reported 1/70,000 of a radius away, so that it
    /// has a direction.
    pub fn proximity(&self, id: ActorId, at: SimTime, out: &mut Vec<Vec2>) {
        let centre = self.position(id, at);
        let robot_reach = 2.0 * self.body_radius + self.proximity_range;
        let touch = self.body_radius / OF_RADIUS * TOUCH;
        self.bodies
            .for_each_within(centre, self.elapsed(at), robot_reach, |other, place| {
                let offset = place - centre;
                let distance = offset.norm();
                if other != id.0 && distance > 0.0 {
                    out.push(offset * ((distance - 2.0 * self.body_radius).max(touch) / distance));
                }
            });
        let fixed_reach = self.body_radius + self.proximity_range;
        let fixed = self
            .arena
            .nearest(centre)
            .filter(|nearest| nearest.distance <= at_most(fixed_reach));
        out.extend(fixed.map(|nearest| nearest.towards * (nearest.distance - self.body_radius).max(touch)));
    }

    #[cfg(test)]
    pub(super) fn rebuilds(&self) -> u32 {
        self.rebuilds
    }

    #[inline]
    fn elapsed(&self, at: SimTime) -> f64 {
        at.since(self.now).as_secs()
    }

    /// Carries every robot to the end of the tick. Whether any changed place.
    fn travel(&mut self) -> bool {
        if self.moving {
            self.moves += 1;
            let tick = self.tick.as_secs();
            for (position, velocity) in self.positions.iter_mut().zip(&self.velocities) {
                *position += velocity * tick;
            }
        }
        self.moving
    }

    /// Lets every drive choose the velocity that it wants for the coming tick.
    fn steer(&mut self) {
        self.movers.clear();
        self.stirring = false;
        for (id, (drive, velocity)) in self.drives.iter_mut().zip(&mut self.velocities).enumerate() {
            *velocity = Vec2::zeros();
            if drive.rests() {
                continue;
            }
            drive.turn(&self.chassis);
            *velocity = drive.steer(&self.chassis);
            self.stirring |= !drive.rests();
            if *velocity != Vec2::zeros() {
                self.movers.push(id as u32);
            }
        }
    }

    fn index(&mut self) {
        #[cfg(test)]
        {
            self.rebuilds += 1;
        }
        self.neighbours.rebuild(&self.positions, &self.velocities);
        self.bodies.rebuild(&self.positions, &self.velocities);
    }
}
