//! Contacts: corrects the velocities of a tick so that no bodies overlap at its end.
//!
//! Momentum-free and position-based: places that the velocities lead to are pushed apart, half each between robots,
//! wholly off walls and obstacles, for a few rounds. No robot is pushed further than it could have driven. Robots still
//! in an overlap after that are jammed: they are drawn half-way back to where they stand, which was free, and pushing
//! apart goes on from there, so that a packed crowd creeps into place. Whoever is jammed to the last stands still for
//! the tick. So the promise of [`OVERLAP_TOLERANCE`] is kept whatever the crowd.

use super::arena::Arena;
use super::grid::Grid;
use crate::geometry::{Vec2, clamp_length};

/// By how much bodies may overlap at a tick, as a share of a robot's radius.
pub const OVERLAP_TOLERANCE: f64 = 0.01;

/// Rounds of pushing apart before robots that still overlap count as jammed.
const ROUNDS: u32 = 8;
/// Times that the jammed are drawn half-way back before they are held.
const ATTEMPTS: u32 = 8;
/// Rounds end when no overlap is deeper than this share of the tolerance.
const SETTLED: f64 = 0.5;

/// Finds and settles contacts; keeps its buffers from tick to tick.
pub(super) struct Contacts {
    radius: f64,
    tick: f64,
    /// How far a robot can drive in a tick, metres.
    max_travel: f64,
    /// The robots that move, and those that they could touch directly or through others.
    group: Vec<Member>,
    /// Each robot's place in `group`, or `ABSENT`.
    place_in_group: Vec<u32>,
    /// Members that could touch each other, each pair once.
    pairs: Vec<(u32, u32)>,
}

/// A robot as contacts see it.
struct Member {
    robot: u32,
    start: Vec2,
    end: Vec2,
    jammed: bool,
}

const ABSENT: u32 = u32::MAX;

impl Contacts {
    /// Contacts between `robots` bodies of `radius`, in ticks of `tick` seconds at up to `max_speed`.
    pub(super) fn new(robots: usize, radius: f64, tick: f64, max_speed: f64) -> Self {
        Self {
            radius,
            tick,
            max_travel: max_speed * tick,
            group: Vec::new(),
            place_in_group: vec![ABSENT; robots],
            pairs: Vec::new(),
        }
    }

    /// Corrects `velocities` for the coming tick. `movers` are the robots that want to move; `grid` is as it was a
    /// tick ago, when it was told how robots would move until now.
    pub(super) fn settle(
        &mut self,
        movers: &[u32],
        positions: &[Vec2],
        velocities: &mut [Vec2],
        grid: &Grid,
        arena: &Arena,
    ) {
        self.gather(movers, positions, velocities, grid);
        self.resolve(arena);
        for member in self.group.drain(..) {
            let robot = member.robot as usize;
            self.place_in_group[robot] = ABSENT;
            if member.end != member.start + velocities[robot] * self.tick {
                velocities[robot] = (member.end - member.start) / self.tick;
            }
        }
        self.pairs.clear();
    }

    /// Collects the group and its pairs, from the movers outwards.
    fn gather(&mut self, movers: &[u32], positions: &[Vec2], velocities: &[Vec2], grid: &Grid) {
        let Self {
            radius,
            tick,
            max_travel,
            group,
            place_in_group,
            pairs,
        } = self;
        let mut admit = |group: &mut Vec<Member>, robot: u32| {
            let place = &mut place_in_group[robot as usize];
            if *place == ABSENT {
                *place = group.len() as u32;
                let start = positions[robot as usize];
                let end = start + velocities[robot as usize] * *tick;
                group.push(Member {
                    robot,
                    start,
                    end,
                    jammed: false,
                });
            }
            *place
        };
        for &robot in movers {
            admit(group, robot);
        }
        let reach = 2.0 * (*radius + *max_travel);
        let mut place = 0;
        while let Some(member) = group.get(place) {
            grid.for_each_within(member.start, *tick, reach, |other, _| {
                let other = admit(group, other);
                if other as usize > place {
                    pairs.push((place as u32, other));
                }
            });
            place += 1;
        }
    }

    /// Looks for places without overlap, drawing the jammed back each time that rounds run out.
    fn resolve(&mut self, arena: &Arena) {
        for _ in 0..ATTEMPTS {
            self.push_apart(arena);
            self.mark_jammed(arena);
            let mut jammed = false;
            for member in &mut self.group {
                if std::mem::take(&mut member.jammed) {
                    member.end = (member.start + member.end) / 2.0;
                    jammed = true;
                }
            }
            if !jammed {
                return;
            }
        }
        self.hold_the_jammed(arena);
    }

    /// Pushes apart what overlaps, in the order of pairs, then of members.
    fn push_apart(&mut self, arena: &Arena) {
        for _ in 0..ROUNDS {
            let mut deepest = 0.0_f64;
            for &(a, b) in &self.pairs {
                deepest = deepest.max(separate(&mut self.group, a, b, 2.0 * self.radius));
            }
            for member in &mut self.group {
                deepest = deepest.max(arena.push_out(&mut member.end, self.radius));
                member.end = member.start + clamp_length(member.end - member.start, self.max_travel);
            }
            if deepest <= SETTLED * OVERLAP_TOLERANCE * self.radius {
                return;
            }
        }
    }

    /// Stops the jammed until there are none. It ends: each pass stops one more, and nothing overlaps more than before
    /// when all stand.
    fn hold_the_jammed(&mut self, arena: &Arena) {
        loop {
            self.mark_jammed(arena);
            let mut held = false;
            for member in &mut self.group {
                if std::mem::take(&mut member.jammed) {
                    held |= member.end != member.start;
                    member.end = member.start;
                }
            }
            if !held {
                return;
            }
        }
    }

    /// Marks the members that overlap something by more than they may and more than before.
    fn mark_jammed(&mut self, arena: &Arena) {
        let slack = OVERLAP_TOLERANCE * self.radius;
        for &(a, b) in &self.pairs {
            let (first, second) = (&self.group[a as usize], &self.group[b as usize]);
            let before = (second.start - first.start).norm();
            if (second.end - first.end).norm() < before.min(2.0 * self.radius - slack) {
                self.group[a as usize].jammed = true;
                self.group[b as usize].jammed = true;
            }
        }
        for member in &mut self.group {
            let clearance = arena.clearance(member.end);
            member.jammed |= clearance < self.radius - slack && clearance < arena.clearance(member.start);
        }
    }
}

/// Moves members `a` and `b` apart to `distance`, half each. Returns how deep they overlapped.
fn separate(group: &mut [Member], a: u32, b: u32, distance: f64) -> f64 {
    let offset = group[b as usize].end - group[a as usize].end;
    let apart_squared = offset.norm_squared();
    if apart_squared >= distance * distance {
        return 0.0;
    }
    let apart = apart_squared.sqrt();
    let depth = distance - apart;
    let towards = if apart > 0.0 { offset / apart } else { Vec2::x() };
    group[a as usize].end -= towards * (depth / 2.0);
    group[b as usize].end += towards * (depth / 2.0);
    depth
}
