//! When a robot wakes next: its control step, its timers, and arrivals where the scenario wakes it for them.

use crate::engine::{SimTime, Span};
use crate::protocol::{TimerId, Wake};

/// One robot's alarm clock.
#[derive(Debug)]
pub struct WakeClock {
    control_step: SimTime,
    timers: Vec<(TimerId, SimTime)>,
    arrival: SimTime,
    /// Whether it is asleep: nothing wakes it.
    asleep: bool,
    /// Number of the last batch of wakes that the robot was part of.
    batch: u64,
}

impl WakeClock {
    /// A clock whose first control step is at `first_step`.
    pub fn new(first_step: SimTime) -> Self {
        Self {
            control_step: first_step,
            timers: Vec::new(),
            arrival: SimTime::NEVER,
            asleep: false,
            batch: 0,
        }
    }

    /// Joins the batch of wakes number `batch`, from 1; says whether the robot was not part of it already.
    pub fn join(&mut self, batch: u64) -> bool {
        std::mem::replace(&mut self.batch, batch) != batch
    }

    /// The next instant at which the robot wakes; `NEVER` while it is asleep.
    pub fn next(&self) -> SimTime {
        if self.asleep {
            return SimTime::NEVER;
        }
        let timer = self.timers.iter().map(|timer| timer.1).min();
        self.control_step.min(self.arrival).min(timer.unwrap_or(SimTime::NEVER))
    }

    /// Takes the reason for which the robot wakes at `now`: a timer before the control step, an arrival last. A control
    /// step is followed by the next one, a `period` later.
    pub fn take_due(&mut self, now: SimTime, period: Span) -> Wake {
        if let Some(due) = self.timers.iter().position(|timer| timer.1 <= now) {
            return Wake::Timer(self.timers.swap_remove(due).0);
        }
        if self.control_step <= now {
            self.control_step += period;
            return Wake::ControlStep;
        }
        Wake::Reception
    }

    /// Puts the robot to sleep until it is [resumed](Self::resume).
    pub fn sleep(&mut self) {
        self.asleep = true;
    }

    /// Ends a sleep at `now`: control steps go on in their rhythm, the next one at `now` at the earliest. Timers that ran out
    /// meanwhile are due at once. Changes nothing for a robot that is not asleep.
    pub fn resume(&mut self, now: SimTime, period: Span) {
        if !std::mem::take(&mut self.asleep) {
            return;
        }
        let missed = now.since(self.control_step).as_nanos().div_ceil(period.as_nanos());
        self.control_step += period * missed;
        for (_, due) in &mut self.timers {
            *due = now.max(*due);
        }
    }

    /// Sets, moves (`Some`) or cancels (`None`) a timer. One that is due already fires at `now`.
    pub fn set_timer(&mut self, id: TimerId, due: Option<SimTime>, now: SimTime) {
        self.timers.retain(|timer| timer.0 != id);
        if let Some(due) = due {
            self.timers.push((id, due.max(now)));
        }
    }

    /// Wakes the robot at the arrival `at`, if that is its next; `NEVER` for none.
    pub fn set_arrival(&mut self, at: SimTime) {
        self.arrival = at;
    }

    /// The arrival for which the robot will wake.
    pub fn arrival(&self) -> SimTime {
        self.arrival
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD: Span = Span::from_nanos(100);

    fn at(nanos: u64) -> SimTime {
        SimTime::from_nanos(nanos)
    }

    #[test]
    fn a_timer_wakes_the_robot_at_its_exact_time_between_control_steps() {
        let mut clock = WakeClock::new(at(0));
        assert_eq!(clock.take_due(at(0), PERIOD), Wake::ControlStep);
        clock.set_timer(TimerId(7), Some(at(42)), at(0));
        assert_eq!(clock.next(), at(42));
        assert_eq!(clock.take_due(at(42), PERIOD), Wake::Timer(TimerId(7)));
        assert_eq!(clock.next(), at(100));
    }

    #[test]
    fn a_timer_goes_before_a_control_step_at_the_same_instant_and_both_happen() {
        let mut clock = WakeClock::new(at(100));
        clock.set_timer(TimerId(1), Some(at(100)), at(0));
        assert_eq!(clock.take_due(at(100), PERIOD), Wake::Timer(TimerId(1)));
        assert_eq!(clock.next(), at(100));
        assert_eq!(clock.take_due(at(100), PERIOD), Wake::ControlStep);
    }

    #[test]
    fn setting_a_timer_again_moves_it_and_a_cancelled_one_never_fires() {
        let mut clock = WakeClock::new(at(100));
        clock.set_timer(TimerId(1), Some(at(10)), at(0));
        clock.set_timer(TimerId(1), Some(at(50)), at(0));
        assert_eq!(clock.next(), at(50));
        clock.set_timer(TimerId(1), None, at(0));
        assert_eq!(clock.next(), at(100));
    }

    #[test]
    fn a_robot_that_slept_keeps_its_rhythm_and_fires_at_once_what_ran_out_meanwhile() {
        let mut clock = WakeClock::new(at(30));
        clock.set_timer(TimerId(1), Some(at(50)), at(0));
        clock.set_timer(TimerId(2), Some(at(500)), at(0));
        clock.sleep();
        assert_eq!(clock.next(), SimTime::NEVER);
        clock.resume(at(231), PERIOD);
        assert_eq!(clock.next(), at(231));
        assert_eq!(clock.take_due(at(231), PERIOD), Wake::Timer(TimerId(1)));
        assert_eq!(clock.next(), at(330));
        clock.sleep();
        clock.resume(at(330), PERIOD);
        assert_eq!(clock.take_due(at(330), PERIOD), Wake::ControlStep);
    }

    #[test]
    fn an_arrival_wakes_the_robot_when_nothing_else_is_due() {
        let mut clock = WakeClock::new(at(100));
        clock.set_arrival(at(30));
        assert_eq!(clock.next(), at(30));
        assert_eq!(clock.take_due(at(30), PERIOD), Wake::Reception);
    }
}
