//! ALOHA: who has something to send does, whatever is on air (Abramson, 1970); in slots (Roberts, 1975); with pauses that a duty cycle asks for.

use super::{Next, Outcome, Scheme, Station, Step};
use crate::engine::{ActorId, SimTime, Span};

/// Sends when there is something to send, as soon as it may.
pub(super) struct Aloha {
    /// The share of the time that a robot may send, at most.
    duty_cycle: f64,
    /// When each may send again.
    free_from: Vec<SimTime>,
}

impl Aloha {
    pub fn new(duty_cycle: Option<f64>, robots: usize) -> Self {
        Self {
            duty_cycle: duty_cycle.unwrap_or(1.0),
            free_from: vec![SimTime::ZERO; robots],
        }
    }
}

impl Scheme for Aloha {
    fn step(&mut self, now: SimTime, station: &mut Station<'_>) -> Step {
        let robot = station.robot.index();
        match station.head {
            None => Step::Rest,
            Some(_) if self.free_from[robot] > now => Step::Wait(self.free_from[robot]),
            Some(_) => Step::Send(now),
        }
    }

    /// A frame of T seconds at a duty cycle d is followed by a pause of T (1/d − 1) (ETSI EN 300 220).
    fn after(&mut self, now: SimTime, _: Outcome, station: &mut Station<'_>) -> Next {
        let airtime = station.head.map_or(Span::ZERO, |head| head.airtime).as_secs();
        let pause = Span::from_secs(airtime * (1.0 / self.duty_cycle - 1.0));
        self.free_from[station.robot.index()] = now + pause;
        Next::Done(now)
    }

    fn restrained(&self, now: SimTime, robot: ActorId) -> bool {
        self.free_from[robot.index()] > now
    }

    fn reset(&mut self, _: ActorId) {}
}

/// Sends at the beginning of a slot, of each next one with the same probability.
pub(super) struct Slotted {
    slot: Span,
    probability: f64,
    /// The slot that each has chosen.
    chosen: Vec<Option<SimTime>>,
}

impl Slotted {
    pub fn new(slot: Span, probability: f64, robots: usize) -> Self {
        Self {
            slot,
            probability,
            chosen: vec![None; robots],
        }
    }
}

impl Scheme for Slotted {
    fn step(&mut self, now: SimTime, station: &mut Station<'_>) -> Step {
        let robot = station.robot.index();
        if station.head.is_none() {
            return Step::Rest;
        }
        match self.chosen[robot].take() {
            Some(chosen) if chosen == now => Step::Send(now),
            _ => {
                let mut slot = now.since(SimTime::ZERO).as_nanos().div_ceil(self.slot.as_nanos());
                // How many it lets pass is geometric.
                if self.probability < 1.0 {
                    let passes = libm::log1p(-station.uniform()) / libm::log1p(-self.probability);
                    slot += passes as u64;
                }
                let chosen = SimTime::ZERO + self.slot * slot;
                if chosen == now {
                    return Step::Send(now);
                }
                self.chosen[robot] = Some(chosen);
                Step::Wait(chosen)
            }
        }
    }

    fn after(&mut self, now: SimTime, _: Outcome, _: &mut Station<'_>) -> Next {
        Next::Done(now)
    }

    fn reset(&mut self, robot: ActorId) {
        self.chosen[robot.index()] = None;
    }
}
