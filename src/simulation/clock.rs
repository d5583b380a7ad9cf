//! When robots wake: the control steps of all, and each robot's own timers and arrivals.

use crate::engine::{ActorId, Clocks, SimTime, Span};
use crate::protocol::{TimerId, Wake};

/// The control steps of all robots. Each robot has a phase of its own and all have one period, so the order in which they
/// take their steps hardly ever changes: a ring, sorted once, where a queue would sort anew at every step. Where clocks are not right, a robot moves past
/// another now and then.
#[derive(Debug)]
pub struct ControlSteps {
    /// Each robot with its step of this round or, behind `next`, of the last one; in order of time, then of id.
    ring: Vec<(SimTime, ActorId)>,
    next: usize,
    period: Span,
    clocks: Clocks,
    /// When each robot takes its next step by its own clock; empty where clocks are right.
    readings: Vec<SimTime>,
}

impl ControlSteps {
    /// Control steps every `period`, that of robot i first at `first_steps[i]`, which is less than a period: both by its clock.
    pub fn new(first_steps: &[SimTime], period: Span, clocks: Clocks) -> Self {
        let robots = (0..).map(ActorId);
        let first = |(reading, robot): (&SimTime, ActorId)| (clocks.when(robot, *reading), robot);
        let mut ring: Vec<_> = first_steps.iter().zip(robots).map(first).collect();
        ring.sort_unstable();
        debug_assert!(first_steps.iter().all(|first| *first < SimTime::ZERO + period));
        Self {
            ring,
            next: 0,
            period,
            readings: if clocks.are_right() {
                Vec::new()
            } else {
                first_steps.to_vec()
            },
            clocks,
        }
    }

    /// How many robots there are.
    pub fn robots(&self) -> usize {
        self.ring.len()
    }

    /// No robot takes two steps within this.
    pub fn shortest_period(&self) -> Span {
        let fastest = self.clocks.skews().iter().copied().fold(0.0, f64::max);
        if fastest == 0.0 {
            return self.period;
        }
        // Instants are whole nanoseconds, so that one step may be late and the next early by one.
        Span::from_nanos((self.period.as_nanos() as f64 / (1.0 + fastest)) as u64).less(Span::from_nanos(2))
    }

    /// When the next control step is due; `NEVER` in an empty swarm.
    pub fn upcoming(&self) -> SimTime {
        self.ring.get(self.next).map_or(SimTime::NEVER, |step| step.0)
    }

    /// The robot whose control step comes `steps` after the next one.
    pub fn ahead(&self, steps: usize) -> ActorId {
        self.ring[(self.next + steps) % self.ring.len()].1
    }

    /// How many control steps each robot has had by `end`, that instant included, in order of ids.
    pub fn due_by(&self, end: SimTime) -> Vec<u64> {
        let period = self.period.as_nanos();
        let mut steps = vec![0; self.ring.len()];
        for &(next, robot) in &self.ring {
            let reading = self.readings.get(robot.index()).unwrap_or(&next);
            let first = reading.as_nanos() % period;
            let end = self.clocks.reading(robot, end);
            steps[robot.index()] = end.as_nanos().checked_sub(first).map_or(0, |since| since / period + 1);
        }
        steps
    }

    /// Takes the next control step if it is due at `now`: the robot whose it is.
    pub fn take_due(&mut self, now: SimTime) -> Option<ActorId> {
        let step = self.ring.get_mut(self.next).filter(|step| step.0 <= now)?;
        let robot = step.1;
        step.0 += self.period;
        if !self.readings.is_empty() {
            self.plan_by_clock(robot);
        }
        self.next = (self.next + 1) % self.ring.len();
        Some(robot)
    }

    /// Plans the next step of the robot at `next`, which has just taken one, and moves it to its place among those that wait longest.
    fn plan_by_clock(&mut self, robot: ActorId) {
        let reading = &mut self.readings[robot.index()];
        *reading += self.period;
        self.ring[self.next].0 = self.clocks.when(robot, *reading);
        let robots = self.ring.len();
        let mut place = self.next;
        for _ in 1..robots {
            let before = (place + robots - 1) % robots;
            if self.ring[before] <= self.ring[place] {
                return;
            }
            self.ring.swap(before, place);
            place = before;
        }
    }
}

/// One robot's alarms: its timers, and arrivals where the scenario wakes it for them.
#[derive(Debug)]
pub struct Alarms {
    timers: Vec<(TimerId, SimTime)>,
    arrival: SimTime,
    /// Since when there is something for it to learn of its own frames; `NEVER` if there is not.
    told: SimTime,
    asleep: bool,
}

impl Default for Alarms {
    fn default() -> Self {
        Self {
            timers: Vec::new(),
            arrival: SimTime::NEVER,
            told: SimTime::NEVER,
            asleep: false,
        }
    }
}

impl Alarms {
    /// The instant of the first alarm; `NEVER` for none, and while the robot is asleep.
    pub fn next(&self) -> SimTime {
        if self.asleep {
            return SimTime::NEVER;
        }
        let timer = self.timers.iter().map(|timer| timer.1).min();
        let told = self.told.min(self.arrival);
        told.min(timer.unwrap_or(SimTime::NEVER))
    }

    /// Takes the alarm for which the robot wakes at `now`: a timer before what became of its frames, and that before an arrival.
    pub fn take_due(&mut self, now: SimTime) -> Wake {
        match self.timers.iter().position(|timer| timer.1 <= now) {
            Some(due) => Wake::Timer(self.timers.swap_remove(due).0),
            None if self.told <= now => Wake::Sent,
            None => Wake::Reception,
        }
    }

    /// Puts the robot to sleep until it is [resumed](Self::resume).
    pub fn sleep(&mut self) {
        self.asleep = true;
    }

    /// Ends a sleep at `now`, if there is one. Timers that ran out meanwhile are due at once.
    pub fn resume(&mut self, now: SimTime) {
        if std::mem::take(&mut self.asleep) {
            for (_, due) in &mut self.timers {
                *due = now.max(*due);
            }
        }
    }

    /// Sets, moves (`Some`) or cancels (`None`) a timer. One that is due already fires at `now`.
    pub fn set_timer(&mut self, id: TimerId, due: Option<SimTime>, now: SimTime) {
        self.timers.retain(|timer| timer.0 != id);
        if let Some(due) = due {
            if self.timers.is_empty() {
                // Most robots never have more than one.
                self.timers.reserve_exact(1);
            }
            self.timers.push((id, due.max(now)));
        }
    }

    /// Wakes the robot at the arrival `at`, if that is its next; `NEVER` for none.
    pub fn set_arrival(&mut self, at: SimTime) {
        self.arrival = at;
    }

    /// There is something for the robot to learn of its own frames, from `at` on.
    pub fn tell(&mut self, at: SimTime) {
        self.told = self.told.min(at);
    }

    /// It has learnt all.
    pub fn learn(&mut self) {
        self.told = SimTime::NEVER;
    }

    /// The arrival for which the robot will wake.
    pub fn arrival(&self) -> SimTime {
        self.arrival
    }
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;

    use proptest::prelude::*;

    use super::*;

    fn at(nanos: u64) -> SimTime {
        SimTime::from_nanos(nanos)
    }

    #[test]
    fn a_timer_wakes_the_robot_at_its_exact_time() {
        let mut alarms = Alarms::default();
        alarms.set_timer(TimerId(7), Some(at(42)), at(0));
        assert_eq!(alarms.next(), at(42));
        assert_eq!(alarms.take_due(at(42)), Wake::Timer(TimerId(7)));
        assert_eq!(alarms.next(), SimTime::NEVER);
    }

    #[test]
    fn setting_a_timer_again_moves_it_and_a_cancelled_one_never_fires() {
        let mut alarms = Alarms::default();
        alarms.set_timer(TimerId(1), Some(at(10)), at(0));
        alarms.set_timer(TimerId(1), Some(at(50)), at(0));
        assert_eq!(alarms.next(), at(50));
        alarms.set_timer(TimerId(1), None, at(0));
        assert_eq!(alarms.next(), SimTime::NEVER);
    }

    #[test]
    fn a_timer_goes_before_an_arrival_at_the_same_instant() {
        let mut alarms = Alarms::default();
        alarms.set_arrival(at(30));
        alarms.set_timer(TimerId(1), Some(at(30)), at(0));
        assert_eq!(alarms.take_due(at(30)), Wake::Timer(TimerId(1)));
        assert_eq!(alarms.next(), at(30));
        assert_eq!(alarms.take_due(at(30)), Wake::Reception);
    }

    #[test]
    fn a_robot_that_slept_fires_at_once_what_ran_out_meanwhile_and_keeps_its_other_timers() {
        let mut alarms = Alarms::default();
        alarms.set_timer(TimerId(1), Some(at(50)), at(0));
        alarms.set_timer(TimerId(2), Some(at(500)), at(0));
        alarms.sleep();
        assert_eq!(alarms.next(), SimTime::NEVER);
        alarms.resume(at(231));
        assert_eq!(alarms.next(), at(231));
        assert_eq!(alarms.take_due(at(231)), Wake::Timer(TimerId(1)));
        assert_eq!(alarms.next(), at(500));
    }

    proptest! {
        #[test]
        fn control_steps_come_in_order_of_time_then_id_and_each_robot_has_one_a_period(
            phases in prop::collection::vec(0_u64..20, 1..30), rounds in 1_u64..5,
        ) {
            const PERIOD: u64 = 20;
            let first_steps: Vec<_> = phases.iter().copied().map(at).collect();
            let mut steps = ControlSteps::new(&first_steps, Span::from_nanos(PERIOD), Clocks::right());
            let mut taken = Vec::new();
            for now in 0..rounds * PERIOD {
                let mut coming: VecDeque<_> = (0..phases.len()).map(|n| steps.ahead(n)).collect();
                while let Some(robot) = steps.take_due(at(now)) {
                    prop_assert_eq!(coming.pop_front(), Some(robot));
                    taken.push((now, robot.0));
                }
                prop_assert!(steps.upcoming() > at(now));
            }
            let mut expected: Vec<_> = (0..rounds)
                .flat_map(|round| phases.iter().zip(0..).map(move |(phase, robot)| (round * PERIOD + phase, robot)))
                .collect();
            expected.sort_unstable();
            for end in [0, PERIOD / 2, rounds * PERIOD - 1] {
                let due: Vec<u64> = (0..phases.len() as u32)
                    .map(|robot| taken.iter().filter(|step| step.0 <= end && step.1 == robot).count() as u64)
                    .collect();
                prop_assert_eq!(steps.due_by(at(end)), due);
            }
            prop_assert_eq!(taken, expected);
        }

        /// Clocks that are wrong by up to a tenth, so that robots pass each other again and again.
        #[test]
        fn by_wrong_clocks_each_robot_keeps_a_period_of_its_own(
            robots in prop::collection::vec((0_u64..20, -0.1..0.1), 1..12), rounds in 1_u64..40,
        ) {
            const PERIOD: u64 = 20;
            let first_steps: Vec<_> = robots.iter().map(|robot| at(robot.0)).collect();
            let clocks = Clocks::of(robots.iter().map(|robot| robot.1));
            let mut steps = ControlSteps::new(&first_steps, Span::from_nanos(PERIOD), clocks.clone());
            let (shortest, end) = (steps.shortest_period(), rounds * PERIOD);
            let mut taken = Vec::new();
            while steps.upcoming() <= at(end) {
                let now = steps.upcoming();
                let robot = steps.take_due(now).expect("it is due");
                let before = taken.iter().rev().find(|step: &&(SimTime, ActorId)| step.1 == robot);
                prop_assert!(before.is_none_or(|step| now.since(step.0) >= shortest));
                taken.push((now, robot));
            }
            let mut expected: Vec<_> = (0..2 * rounds)
                .flat_map(|round| (0..).map(ActorId).zip(&first_steps).map(move |(robot, first)| (robot, *first + Span::from_nanos(PERIOD) * round)))
                .map(|(robot, reading)| (clocks.when(robot, reading), robot))
                .filter(|step| step.0 <= at(end))
                .collect();
            expected.sort_unstable();
            let had: Vec<u64> = (0..robots.len() as u32)
                .map(|robot| taken.iter().filter(|step| step.1 == ActorId(robot)).count() as u64)
                .collect();
            prop_assert_eq!(steps.due_by(at(end)), had);
            prop_assert_eq!(taken, expected);
        }
    }
}
