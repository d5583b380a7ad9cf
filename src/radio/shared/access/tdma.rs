//! Time division: every robot sends in its own slot.

use super::{Next, Outcome, Scheme, Station, Step};
use crate::engine::{ActorId, SimTime, Span};

/// One frame a slot, in the middle of it but for the error of the sender's clock.
pub(super) struct Tdma {
    /// Slots a frame; robot i has number i modulo these.
    slots: u64,
    slot: Span,
    /// From the beginning of one frame of slots to that of the next.
    frame: Span,
    guard: Span,
    /// How often clocks are set right; zero: always.
    resync: Span,
    /// The turn that each waits for.
    turn: Vec<Option<SimTime>>,
}

impl Tdma {
    pub fn new(slots: u64, slot: Span, frame: Span, guard: Span, resync: Span, robots: usize) -> Self {
        Self {
            slots,
            slot,
            frame,
            guard,
            resync,
            turn: vec![None; robots],
        }
    }

    /// When the robot believes that it is its turn in frame `number`: half a guard into its slot, by its clock.
    fn turn(&self, number: u64, robot: ActorId, skew: f64) -> SimTime {
        let ideal =
            SimTime::ZERO + self.frame * number + self.slot * (u64::from(robot.0) % self.slots) + self.guard / 2;
        if self.resync == Span::ZERO || skew == 0.0 {
            return ideal;
        }
        let since = Span::from_nanos(ideal.as_nanos() % self.resync.as_nanos()).as_secs();
        // A fast clock comes too early.
        let early = skew * since;
        if early > 0.0 {
            ideal - Span::from_secs(early)
        } else {
            ideal + Span::from_secs(-early)
        }
    }
}

impl Scheme for Tdma {
    fn step(&mut self, now: SimTime, station: &mut Station<'_>) -> Step {
        let robot = station.robot;
        if station.head.is_none() {
            return Step::Rest;
        }
        if self.turn[robot.index()].take() == Some(now) {
            return Step::Send(now);
        }
        let mut number = now.as_nanos() / self.frame.as_nanos();
        number = number.saturating_sub(1);
        let turn = loop {
            let turn = self.turn(number, robot, station.skew);
            if turn >= now {
                break turn;
            }
            number += 1;
        };
        if turn == now {
            return Step::Send(now);
        }
        self.turn[robot.index()] = Some(turn);
        Step::Wait(turn)
    }

    /// The next frame has to wait for the next turn, though this one may not be over.
    fn after(&mut self, now: SimTime, _: Outcome, _: &mut Station<'_>) -> Next {
        Next::Done(now + Span::from_nanos(1))
    }

    fn reset(&mut self, robot: ActorId) {
        self.turn[robot.index()] = None;
    }
}
