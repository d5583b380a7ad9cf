//! When a topic has its turn: once in every interval, at a step that jitter may move within it. Each robot's intervals begin at
//! a phase of its own.

use crate::engine::{ActorId, KeyedStreams, Purpose, Span, Streams};
use crate::protocol::control::{Phases, Rhythm};
use crate::quantity::{Positive, Probability};

/// The step within an interval, by robot, topic and interval: one word each, so that settings compare under common
/// random numbers.
const JITTER: Purpose = Purpose::new("gossip.jitter");

/// The rhythm of a topic, in control steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// From one interval to the next, at least 1.
    every: u64,
    /// Steps of the interval among which the turn is drawn, at least 1.
    places: u64,
}

impl Timing {
    /// An `interval` rounded up to whole control periods, and `jitter` as a share of it rounded down to them.
    #[must_use]
    pub fn new(interval: Positive, jitter: Probability, control_period: Span) -> Self {
        let every = Span::from_secs(interval.get()).in_periods(control_period).max(1);
        let places = (jitter.get() * every as f64) as u64;
        Self {
            every,
            places: places.clamp(1, every),
        }
    }

    /// Control steps from one interval to the next: what lies between two turns on average.
    #[must_use]
    pub const fn every(self) -> u64 {
        self.every
    }

    /// Most control steps between two turns in a row.
    #[must_use]
    pub const fn longest(self) -> u64 {
        self.every + self.places - 1
    }

    /// Whether turns are moved at all.
    #[must_use]
    pub const fn is_jittered(self) -> bool {
        self.places > 1
    }
}

/// The turns of one topic, for all robots of a trial.
#[derive(Clone, Copy, Debug)]
pub struct Turns {
    timing: Timing,
    /// By which the topic's draws differ from those of others.
    rhythm: Rhythm,
    phases: Phases,
    jitter: KeyedStreams,
}

impl Turns {
    /// The turns of a topic with this rhythm, in a trial with these `phases` and `streams`.
    #[must_use]
    pub fn new(timing: Timing, rhythm: Rhythm, phases: Phases, streams: Streams) -> Self {
        Self {
            timing,
            rhythm,
            phases,
            jitter: streams.keyed(JITTER),
        }
    }

    /// Whether `robot` has its turn at its control step number `step`.
    #[must_use]
    pub fn is_due(&self, robot: ActorId, step: u64) -> bool {
        let Timing { every, places } = self.timing;
        let step = step + self.phases.of(robot, self.rhythm, every);
        let place = step % every;
        place < places && place == self.place(robot, step / every)
    }

    /// Those of one robot, before its first control step.
    #[must_use]
    pub const fn of(self, robot: ActorId) -> OwnTurns {
        OwnTurns {
            turns: self,
            robot,
            step: 0,
        }
    }

    /// The rhythm.
    #[must_use]
    pub const fn timing(&self) -> Timing {
        self.timing
    }

    fn place(&self, robot: ActorId, interval: u64) -> u64 {
        if !self.timing.is_jittered() {
            return 0;
        }
        let [word, _] = self.jitter.first_two(robot.0, self.rhythm.number(), interval as u32);
        ((u128::from(word) * u128::from(self.timing.places)) >> 64) as u64
    }
}

/// The turns of one topic, for one robot, which counts its control steps.
#[derive(Clone, Copy, Debug)]
pub struct OwnTurns {
    turns: Turns,
    robot: ActorId,
    step: u64,
}

impl OwnTurns {
    /// Whether the robot has its turn at this control step: to be asked once at each.
    pub fn is_due(&mut self) -> bool {
        let is_due = self.turns.is_due(self.robot, self.step);
        self.step += 1;
        is_due
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::control::PhaseConfig;
    use proptest::prelude::*;

    const STEP: Span = Span::from_nanos(100_000_000);

    fn topic(timing: Timing, phase: PhaseConfig, rhythm: Rhythm, trial: u32) -> Turns {
        let streams = Streams::new(7, trial);
        Turns::new(timing, rhythm, Phases::new(phase, streams), streams)
    }

    /// Turns of a robot where all begin together.
    fn turns(interval: f64, jitter: f64, robot: u32, steps: u64) -> Vec<u64> {
        let timing = Timing::new(Positive::new(interval), Probability::new(jitter), STEP);
        let turns = topic(timing, PhaseConfig::Together, Rhythm::Status, 0);
        (0..steps).filter(|&step| turns.is_due(ActorId(robot), step)).collect()
    }

    #[test]
    fn without_jitter_and_together_a_turn_comes_at_the_first_step_of_every_interval() {
        assert_eq!(turns(0.1, 0.0, 3, 4), [0, 1, 2, 3]);
        assert_eq!(
            turns(0.25, 0.0, 3, 10),
            [0, 3, 6, 9],
            "rounded up to whole control periods"
        );
    }

    /// Intervals of 7 steps, 4,200 robots and trials: 600 begin at each step. Chi-square with 6 degrees of freedom, below 22.5
    /// with probability 0.999. Two rhythms of a robot begin together in one of seven: 600, σ 22.7, within four of it.
    #[test]
    fn at_random_phases_a_topic_begins_anywhere_in_its_interval_by_robot_topic_and_trial() {
        let timing = Timing::new(Positive::new(0.7), Probability::new(0.0), STEP);
        let first = |rhythm, robot, trial| {
            let turns = topic(timing, PhaseConfig::Random, rhythm, trial);
            let due: Vec<u64> = (0..21).filter(|&step| turns.is_due(ActorId(robot), step)).collect();
            assert_eq!((due.len(), due[1] - due[0], due[2] - due[1]), (3, 7, 7));
            due[0]
        };
        let mut counts = [0_f64; 7];
        let mut together = 0_u32;
        for (robot, trial) in (0..100).flat_map(|robot| (0..42).map(move |trial| (robot, trial))) {
            let status = first(Rhythm::Status, robot, trial);
            counts[status as usize] += 1.0;
            together += u32::from(status == first(Rhythm::Strand, robot, trial));
        }
        let chi_square: f64 = counts.iter().map(|count| (count - 600.0).powi(2) / 600.0).sum();
        assert!(chi_square < 22.5, "{chi_square}: {counts:?}");
        assert!(together.abs_diff(600) < 91, "{together}");
    }

    proptest! {
        #[test]
        fn every_interval_has_one_turn_and_no_pause_is_longer_than_stated(
            every in 1_u64..20, jitter in 0.0..=1.0_f64, robot in 0_u32..50,
        ) {
            let interval = every as f64 / 10.0;
            let timing = Timing::new(Positive::new(interval), Probability::new(jitter), STEP);
            prop_assert_eq!(timing.every(), every);
            let turns = turns(interval, jitter, robot, every * 40);
            prop_assert!(turns.iter().enumerate().all(|(number, step)| step / every == number as u64));
            prop_assert_eq!(turns.len(), 40);
            prop_assert!(turns.windows(2).all(|pair| pair[1] - pair[0] <= timing.longest()));
        }

        #[test]
        fn no_pause_is_longer_than_stated_at_random_phases_either_the_one_before_the_first_turn_included(
            every in 1_u64..20, jitter in 0.0..=1.0_f64, robot in 0_u32..50, trial in 0_u32..50,
        ) {
            let timing = Timing::new(Positive::new(every as f64 / 10.0), Probability::new(jitter), STEP);
            let turns = topic(timing, PhaseConfig::Random, Rhythm::Relay, trial);
            let mut last = None;
            for step in (0..every * 40).filter(|&step| turns.is_due(ActorId(robot), step)) {
                prop_assert!(step < last.map_or(timing.longest(), |last: u64| last + timing.longest() + 1));
                last = Some(step);
            }
            prop_assert!(last >= Some(every * 38));
        }
    }

    /// With jitter 1 and 10 steps an interval, each place has probability 1/10. Chi-square over 4,000 draws, 9 degrees of
    /// freedom: below 27.9 with probability 0.999.
    #[test]
    fn jitter_spreads_turns_evenly_over_its_share_of_the_interval() {
        let mut counts = [0_f64; 10];
        for robot in 0..40 {
            for step in turns(1.0, 1.0, robot, 1000) {
                counts[(step % 10) as usize] += 1.0;
            }
        }
        let chi_square: f64 = counts.iter().map(|count| (count - 400.0).powi(2) / 400.0).sum();
        assert!(chi_square < 27.9, "{chi_square}: {counts:?}");
        assert!(turns(1.0, 0.5, 0, 1000).iter().all(|step| step % 10 < 5));
    }

    #[test]
    fn robots_and_topics_are_moved_apart_from_each_other() {
        let timing = Timing::new(Positive::new(1.0), Probability::new(1.0), STEP);
        let of = |rhythm, robot| {
            let turns = topic(timing, PhaseConfig::Together, rhythm, 0);
            (0..200)
                .filter(|&step| turns.is_due(ActorId(robot), step))
                .collect::<Vec<u64>>()
        };
        assert_ne!(of(Rhythm::Status, 0), of(Rhythm::Status, 1));
        assert_ne!(of(Rhythm::Status, 0), of(Rhythm::Request, 0));
    }
}
