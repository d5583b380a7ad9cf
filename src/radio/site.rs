//! Where a radio is used: what is known of a run before it starts, and where everybody is while it lasts.

use crate::engine::{ActorId, SimTime, Streams};
use crate::geometry::{Vec2, at_most};

/// What a radio is told of a run before it starts.
#[derive(Clone, Debug)]
pub struct RadioSite {
    /// The random streams of the trial.
    pub streams: Streams,
    /// Robots 0 to this number − 1 take part.
    pub robots: usize,
    /// Radius of a robot's body, metres.
    pub body_radius: f64,
    /// By how much the clock of each robot is fast, as a share; empty where all are right.
    pub skews: Vec<f64>,
    /// The obstacles of the arena, in the order of the scenario.
    pub obstacles: Vec<Obstacle>,
}

/// A fixed body that signals may have to pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacle {
    /// Where it is.
    pub shape: Shape,
    /// What a signal loses on its way through it, dB, from 0 on, where the arena says so.
    pub attenuation: Option<f64>,
}

/// The ground that an obstacle covers, metres, arena axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A thin straight wall between two ends.
    Segment(Vec2, Vec2),
    /// A disc.
    Disc {
        /// Its centre.
        centre: Vec2,
        /// Its radius, above 0.
        radius: f64,
    },
}

impl RadioSite {
    /// A site without obstacles, for so many robots with the bodies of Khepera IV (0.07 m), drawing from `streams`.
    #[must_use]
    pub fn open(streams: Streams, robots: usize) -> Self {
        Self {
            streams,
            robots,
            body_radius: 0.07,
            skews: Vec::new(),
            obstacles: Vec::new(),
        }
    }
}

/// Where everybody is, as a medium may ask at its own events. Exact at every instant from the last motion tick to the next, which the
/// instant of the event always is; for earlier instants the answer is that of the last tick.
pub trait Places {
    /// Where `robot` is at `at`, metres, arena axes.
    fn position(&self, robot: ActorId, at: SimTime) -> Vec2;

    /// Calls `visit` once for each robot within `range` metres of the place `centre` at `at`, the rim included, with where it is then.
    /// The order is the same in every run, and follows no rule that callers should rely on.
    fn for_each_within(&self, centre: Vec2, at: SimTime, range: f64, visit: &mut dyn FnMut(ActorId, Vec2));

    /// While nobody moves, a number that is another after anybody has: as long as the answer is the same, everybody is where they were. A medium
    /// may keep what follows from that.
    fn standing(&self) -> Option<u32> {
        None
    }
}

/// Robots that stand still, in order of their numbers: to try a radio out without a run.
impl Places for Vec<Vec2> {
    fn position(&self, robot: ActorId, _: SimTime) -> Vec2 {
        self[robot.index()]
    }

    fn for_each_within(&self, centre: Vec2, _: SimTime, range: f64, visit: &mut dyn FnMut(ActorId, Vec2)) {
        for (robot, place) in (0..).map(ActorId).zip(self) {
            if (place - centre).norm_squared() <= at_most(range).powi(2) {
                visit(robot, *place);
            }
        }
    }
}
