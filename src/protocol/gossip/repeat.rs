//! What is sent when a topic has its turn: what there is to say, or only what has changed.

use crate::engine::{ActorId, Span};
use crate::protocol::control::{Phases, Rhythm};

use super::config::{SendConfig, StrandConfig, TopicConfig};
use super::turns::Timing;

/// When a message is said again, in working units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Repetition {
    /// Turns in a row in which something new is said.
    times: u32,
    /// Turns after which it is said again though nothing is new; 1: at every turn.
    refresh: u64,
    timing: Timing,
}

impl Repetition {
    /// For a topic with this rhythm.
    #[must_use]
    pub fn new(send: SendConfig, timing: Timing, control_period: Span) -> Self {
        let (times, refresh) = match send {
            SendConfig::Always => (1, 1),
            SendConfig::OnChange {
                max_interval,
                repetition,
            } => {
                let steps = Span::from_secs(max_interval.get()).as_nanos() / control_period.as_nanos().max(1);
                (repetition, (steps / timing.every()).max(1))
            }
        };
        Self {
            times: times.max(1),
            refresh,
            timing,
        }
    }

    /// Most control steps from a broadcast to the next, whatever there is to say.
    #[must_use]
    pub const fn longest_pause(self) -> u64 {
        self.timing.every() * (self.refresh - 1) + self.timing.longest()
    }
}

impl TopicConfig {
    /// What is sent when the topic has its turn.
    #[must_use]
    pub fn repetition(&self, control_period: Span) -> Repetition {
        Repetition::new(self.send, self.timing(control_period), control_period)
    }

    /// The longest pause from one broadcast to the next, whatever there is to say.
    #[must_use]
    pub fn longest_pause(&self, control_period: Span) -> Span {
        control_period * self.repetition(control_period).longest_pause()
    }
}

impl StrandConfig {
    /// What is sent when the topic has its turn.
    #[must_use]
    pub fn repetition(&self, control_period: Span) -> Repetition {
        Repetition::new(self.send, self.timing(control_period), control_period)
    }
}

/// What a robot last said on a topic.
#[derive(Debug)]
pub struct Repeat<M> {
    last: Option<M>,
    /// Turns in which it is still to be said.
    left: u32,
    /// Turns since it was said.
    silent: u64,
    /// Turns that the first silence is shorter by: all robots have something new to say at the start, and are not to say it again
    /// all at once.
    head_start: u64,
}

impl<M> Repeat<M> {
    /// Nothing was said yet by `robot`, which refreshes what it says in this `rhythm`.
    #[must_use]
    pub fn new(repetition: Repetition, rhythm: Rhythm, phases: Phases, robot: ActorId) -> Self {
        Self {
            last: None,
            left: 0,
            silent: 0,
            head_start: phases.of(robot, rhythm, repetition.refresh),
        }
    }
}

impl<M: PartialEq> Repeat<M> {
    /// Whether `message` is to be sent at this turn; to be asked at every turn.
    pub fn is_due(&mut self, repetition: Repetition, message: &M) -> bool
    where
        M: Clone,
    {
        if repetition.refresh == 1 {
            return true;
        }
        if self.last.as_ref() != Some(message) {
            self.last = Some(message.clone());
            self.left = repetition.times;
        }
        self.silent += 1;
        let due = self.left > 0 || self.silent >= repetition.refresh;
        if due {
            self.left = self.left.saturating_sub(1);
            self.silent = 0;
            if self.left == 0 {
                self.silent = std::mem::take(&mut self.head_start);
            }
        }
        due
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Streams;
    use crate::protocol::control::PhaseConfig;
    use crate::quantity::{Positive, Probability};
    use proptest::prelude::*;

    const STEP: Span = Span::from_nanos(100_000_000);

    fn on_change(interval: f64, max_interval: f64, repetition: u32) -> Repetition {
        let timing = Timing::new(Positive::new(interval), Probability::new(0.0), STEP);
        let send = SendConfig::OnChange {
            max_interval: Positive::new(max_interval),
            repetition,
        };
        Repetition::new(send, timing, STEP)
    }

    fn repeat(repetition: Repetition, phase: PhaseConfig, trial: u32) -> Repeat<char> {
        let phases = Phases::new(phase, Streams::new(3, trial));
        Repeat::new(repetition, Rhythm::StatusRefresh, phases, ActorId(5))
    }

    fn sent(repetition: Repetition, said: &str) -> String {
        let mut repeat = repeat(repetition, PhaseConfig::Together, 0);
        let send = |word: char| if repeat.is_due(repetition, &word) { word } else { '.' };
        said.chars().map(send).collect()
    }

    #[test]
    fn what_is_new_is_said_at_once_and_what_is_old_after_the_longest_pause() {
        assert_eq!(sent(on_change(0.1, 0.4, 1), "aaaaaaaabbbbbb"), "a...a...b...b.");
        assert_eq!(sent(on_change(0.1, 0.1, 1), "aaa"), "aaa");
    }

    #[test]
    fn what_is_new_is_said_as_many_times_as_asked_and_a_newer_word_begins_anew() {
        assert_eq!(sent(on_change(0.1, 0.5, 3), "aaaaaaaabbcccccccc"), "aaa....abbccc....c");
    }

    #[test]
    fn a_longest_pause_between_two_turns_is_rounded_down_to_the_earlier() {
        let repetition = on_change(0.3, 1.0, 1);
        assert_eq!(repetition.longest_pause(), 9);
        assert_eq!(sent(repetition, "aaaaaaa"), "a..a..a", "a turn every 0.3 s");
    }

    /// Refreshed every 5 turns: over 500 trials 100 begin at each, σ 8.9; four of it.
    #[test]
    fn at_random_phases_the_first_silence_is_cut_short_anywhere_and_later_ones_are_whole() {
        let repetition = on_change(0.1, 0.5, 2);
        let mut counts = [0_u32; 5];
        for trial in 0..500 {
            let mut repeat = repeat(repetition, PhaseConfig::Random, trial);
            let due: Vec<u64> = (0..20).filter(|_| repeat.is_due(repetition, &'a')).collect();
            let rhythm: Vec<u64> = due.windows(2).map(|pair| pair[1] - pair[0]).collect();
            assert_eq!(due[..2], [0, 1], "what is new is said at once, and as often as asked");
            assert!(rhythm[2..].iter().all(|pause| *pause == 5), "{rhythm:?}");
            counts[rhythm[1] as usize - 1] += 1;
        }
        assert!(counts.iter().all(|count| count.abs_diff(100) < 36), "{counts:?}");
    }

    proptest! {
        #[test]
        fn no_pause_is_longer_than_stated_and_no_change_is_missed(
            words in prop::collection::vec(prop::char::range('a', 'c'), 1..60), max in 1_u32..8, times in 1_u32..4,
            trial in 0_u32..100,
        ) {
            let repetition = on_change(0.1, f64::from(max) / 10.0, times);
            let mut repeat = repeat(repetition, PhaseConfig::Random, trial);
            let mut heard = None;
            let mut pause = 0;
            for word in words {
                pause += 1;
                if repeat.is_due(repetition, &word) {
                    heard = Some(word);
                    pause = 0;
                }
                prop_assert!(pause < repetition.longest_pause());
                prop_assert_eq!(heard, Some(word));
            }
        }
    }
}
