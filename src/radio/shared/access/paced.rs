//! Radios of small boards: they send at a pace of their own, some listen first, and try again after a while if somebody sends.
//!
//! BLE advertising (Bluetooth Core 5.4, vol 6 part B, 4.4.2.2): events at an interval and a random delay, no carrier sense. The kilobot: half
//! a second from one message to the next, not while it receives. The e-puck's range-and-bearing board: at once if nothing is heard, else after a short random wait.

use super::{Next, Outcome, Scheme, Station, Step};
use crate::engine::{ActorId, SimTime, Span};

/// What distinguishes them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    /// From one turn to the next; zero: it is always its turn.
    pub interval: Span,
    /// What is added to each interval, uniform.
    pub jitter: Span,
    /// For how long it listens before it sends, if it does.
    pub listens: Option<Span>,
    /// If somebody sends it tries again after a random wait: a number of units of 0 to `most`.
    pub unit: Span,
    pub most: u32,
}

/// All robots' turns.
pub(super) struct Paced {
    pace: Pace,
    /// The next turn of each, once it has had one.
    turn: Vec<Option<SimTime>>,
    /// When each listens next.
    listens: Vec<Option<SimTime>>,
}

impl Paced {
    pub fn new(pace: Pace, robots: usize) -> Self {
        Self {
            pace,
            turn: vec![None; robots],
            listens: vec![None; robots],
        }
    }

    /// Its first turn from `now` on.
    fn turn(&mut self, now: SimTime, station: &mut Station<'_>) -> SimTime {
        let Pace { interval, jitter, .. } = self.pace;
        if interval == Span::ZERO {
            return now;
        }
        let mut turn = self.turn[station.robot.index()].unwrap_or_else(|| {
            // The pace of each began before the run.
            let phase = (interval + jitter).as_secs() * station.uniform();
            SimTime::ZERO + Span::from_secs(phase)
        });
        while turn < now {
            turn = turn + interval + Span::from_secs(jitter.as_secs() * station.uniform());
        }
        self.turn[station.robot.index()] = Some(turn);
        turn
    }
}

impl Scheme for Paced {
    fn step(&mut self, now: SimTime, station: &mut Station<'_>) -> Step {
        let robot = station.robot.index();
        if station.head.is_none() {
            return Step::Rest;
        }
        let Pace {
            listens, unit, most, ..
        } = self.pace;
        let due = self.listens[robot].take();
        let Some(listening) = listens else {
            let turn = self.turn(now, station);
            return if turn == now { Step::Send(now) } else { Step::Wait(turn) };
        };
        if due == Some(now) {
            if !station.receiver.senses(station.ear, now) {
                return Step::Send(now);
            }
            let wait = Span::from_secs(unit.as_secs() * f64::from(station.count(most)));
            let next = now + wait + listening.max(Span::from_nanos(1));
            self.listens[robot] = Some(next);
            return Step::Wait(next);
        }
        let next = self.turn(now, station) + listening;
        self.listens[robot] = Some(next);
        Step::Wait(next)
    }

    /// The next turn is behind this one.
    fn after(&mut self, now: SimTime, _: Outcome, station: &mut Station<'_>) -> Next {
        if self.pace.interval == Span::ZERO {
            return Next::Done(now);
        }
        let turn = self.turn[station.robot.index()].take().unwrap_or(now);
        let jitter = Span::from_secs(self.pace.jitter.as_secs() * station.uniform());
        self.turn[station.robot.index()] = Some(turn + self.pace.interval + jitter);
        Next::Done(now)
    }

    fn least_delay(&self) -> Span {
        self.pace.listens.unwrap_or(Span::ZERO)
    }

    fn memory(&self) -> Span {
        self.least_delay()
    }

    fn reset(&mut self, robot: ActorId) {
        self.listens[robot.index()] = None;
    }
}
