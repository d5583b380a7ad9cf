//! The settings of SWIM, by the names that memberlist gives them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::engine::Span;
use crate::quantity::{NonNegative, Positive};

/// Settings of SWIM. Defaults are those of memberlist's local network, where they are not said to be ours.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SwimConfig {
    /// Seconds from one probe to the next of a robot that is in good health (the protocol period T of SWIM). Recommended:
    /// at least four times what a message takes, the wait for its receiver's control step included, beside the probe timeout:
    /// 1.5 s with the radio's default latency.
    pub probe_interval: Positive,
    /// Seconds within which the robot probed must have acknowledged; then others are asked to probe it. Must be shorter than
    /// the probe interval, which must leave the others time for two messages and their answers.
    pub probe_timeout: Positive,
    /// k, how many others are asked to probe a robot that has not acknowledged (`k` of SWIM); 0 for none.
    pub indirect_checks: u8,
    /// A robot that did not acknowledge is only suspected at first, and taken for down if it has not denied that within this
    /// many probe intervals, times log₁₀ of the number of robots where those are more than ten. 0: it is down at once, as in
    /// SWIM without its suspicion mechanism.
    pub suspicion_mult: NonNegative,
    /// A robot repeats a piece of news this many times ⌈log₁₀(robots + 1)⌉ times, in its probes and acknowledgements; 0: it
    /// keeps them to itself.
    pub retransmit_mult: u8,
    /// Lifeguard's awareness: a robot whose probes fail, or that is suspected itself, doubts its own health, and stretches
    /// probe interval and timeout by up to this factor. 1: it never does.
    #[schemars(range(min = 1))]
    pub max_awareness: u8,
    /// Pieces of news in one message (ours: memberlist fills its datagram of 1400 B, a robot's radio has shorter ones).
    pub news_per_message: u8,
    /// Seconds after which a robot that was not heard at all counts as out of range (ours: SWIM is made for networks in which
    /// everybody reaches everybody). It is suspected by those who do not hear it, and nobody is told. Must be longer than the
    /// probe interval, and is best longer than SWIM itself takes: that is `suspicion_mult` and about three more probe
    /// intervals.
    pub leave_timeout: Positive,
}

impl Default for SwimConfig {
    fn default() -> Self {
        Self {
            probe_interval: Positive::new(1.0),
            probe_timeout: Positive::new(0.5),
            indirect_checks: 3,
            suspicion_mult: NonNegative::new(4.0),
            retransmit_mult: 4,
            max_awareness: 8,
            news_per_message: 8,
            leave_timeout: Positive::new(15.0),
        }
    }
}

impl SwimConfig {
    /// How long a robot may deny a suspicion, in a swarm of `robots`.
    #[must_use]
    pub fn suspicion_timeout(&self, robots: usize) -> Span {
        let scale = (robots.max(1) as f64).log10().max(1.0);
        Span::from_secs(self.suspicion_mult.get() * scale * self.probe_interval.get())
    }

    /// How often a robot repeats a piece of news, in a swarm of `robots`.
    #[must_use]
    pub fn retransmits(&self, robots: usize) -> u32 {
        let scale = (robots as f64 + 1.0).log10().ceil();
        u32::from(self.retransmit_mult) * scale as u32
    }

    /// The probability that a probe of a robot that is well fails, each message being lost on its own with probability `loss`:
    /// the ping or its acknowledgement is lost, and so is one of four messages on each way through others, if there are so
    /// many, (1 − (1−p)²) (1 − (1−p)⁴)ᵏ.
    #[must_use]
    pub fn probe_failure(&self, loss: f64) -> f64 {
        let arrives = 1.0 - loss;
        (1.0 - arrives.powi(2)) * (1.0 - arrives.powi(4)).powi(self.indirect_checks.into())
    }

    /// The mean number of the period in which a failed robot is first probed by anybody, in a swarm of `robots` in which all
    /// know each other and draw whom they probe: 1/(1 − (1 − 1/(N−1))^(N−1)), for many robots e/(e−1). Taking turns, as they do,
    /// makes it less by a little.
    #[must_use]
    pub fn first_detection_periods(robots: usize) -> f64 {
        let others = robots.max(2) as f64 - 1.0;
        1.0 / (1.0 - (1.0 - 1.0 / others).powf(others))
    }

    /// From a failure until it is known, on average: somebody pings the failed robot half a period before the end of the one
    /// in which it is first probed, finds an interval later that it does not answer, and then the suspicion has to run out.
    pub(in super::super) fn usual_silence(&self, robots: usize) -> Span {
        let periods = Self::first_detection_periods(robots) - 0.5 + 1.0;
        Span::from_secs(periods * self.probe_interval.get()) + self.suspicion_timeout(robots)
    }

    /// From a robot's last frame until it is suspected, at most: awareness apart, it counts as out of range by then.
    pub(in super::super) fn longest_silence(&self, robots: usize) -> Span {
        self.usual_silence(robots)
            .max(Span::from_secs(self.leave_timeout.get()))
    }

    pub(in super::super) fn problems(&self) -> Vec<(String, String)> {
        let [interval, timeout, leave] =
            [self.probe_interval, self.probe_timeout, self.leave_timeout].map(Positive::get);
        let mut found = Vec::new();
        let mut refuse = |field: &str, message: String| found.push((field.to_owned(), message));
        if timeout >= interval {
            let message =
                format!("{timeout} s leaves no time to ask others within the `probe_interval` of {interval} s");
            refuse("probe_timeout", message);
        }
        if leave <= interval {
            let message = format!("must be longer than the `probe_interval` of {interval} s");
            refuse("leave_timeout", message);
        }
        if self.max_awareness == 0 {
            refuse(
                "max_awareness",
                "must be at least 1, which stretches nothing".to_owned(),
            );
        }
        if self.retransmit_mult > 0 && self.news_per_message == 0 {
            refuse(
                "news_per_message",
                "must be at least 1, or `retransmit_mult` 0: there is news to pass on".to_owned(),
            );
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn timeout_and_retransmits_of_eighty_robots_are_those_of_memberlist() {
        let config = SwimConfig::default();
        assert!((config.suspicion_timeout(80).as_secs() - 7.612).abs() < 5e-4);
        assert_eq!(config.retransmits(80), 8);
        assert!((config.suspicion_timeout(7).as_secs() - 4.0).abs() < 1e-9);
        assert_eq!(config.retransmits(9), 4);
    }

    #[test]
    fn settings_that_leave_no_room_for_each_other_are_refused() {
        let config = SwimConfig {
            probe_timeout: Positive::new(1.0),
            leave_timeout: Positive::new(1.0),
            max_awareness: 0,
            news_per_message: 0,
            ..SwimConfig::default()
        };
        let fields: Vec<_> = config.problems().into_iter().map(|(field, _)| field).collect();
        assert_eq!(
            fields,
            ["probe_timeout", "leave_timeout", "max_awareness", "news_per_message"]
        );
        assert_eq!(SwimConfig::default().problems(), []);
    }
}
