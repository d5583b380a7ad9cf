//! Traffic as scenarios name it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Source, To};
use crate::engine::ActorId;
use crate::kind::{Broadcasts, Kind, Sections, Shared, Swarm};
use crate::protocol::{Layout, Part};
use crate::quantity::Positive;

/// Robots that send messages of one size, so often and to these; nothing else. They stand where they are.
///
/// ```
/// let text = r#"Scenario(
///     name: "ten_hertz",
///     time_limit: 10.0,
///     swarm: (robots: 20, deploy: Cluster(radius: 1.0)),
///     protocol: Traffic(when: Poisson(10.0), payload: 20),
///     radio: (technology: Ieee802154()),
/// )"#;
/// assert!(desim::scenario::parse("ten_hertz.ron", text, &[]).is_ok());
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TrafficConfig {
    /// Who sends.
    pub senders: Senders,
    /// To whom.
    pub to: Recipients,
    /// When.
    pub when: Timing,
    /// Bytes of a message.
    pub payload: u16,
}

/// Who sends.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Senders {
    /// Every robot.
    #[default]
    All,
    /// These, by number from 0.
    Given(Vec<u32>),
}

/// Whom messages are for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Recipients {
    /// All in range.
    #[default]
    Everyone,
    /// The robot with the next number, of the last one robot 0: a ring.
    Next,
    /// This robot; it sends nothing itself.
    Robot(u32),
}

/// When messages are sent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub enum Timing {
    /// Every so many seconds, each robot from a random phase on.
    Periodic(Positive),
    /// So many a second and robot on average, at the instants of a Poisson process.
    Poisson(Positive),
    /// As soon as the radio has done with another: there is always one more. Needs a radio on which frames take time.
    Saturated,
}

impl Default for TrafficConfig {
    fn default() -> Self {
        Self {
            senders: Senders::All,
            to: Recipients::Everyone,
            when: Timing::Periodic(Positive::new(0.1)),
            payload: 20,
        }
    }
}

impl TrafficConfig {
    fn to(&self, robot: ActorId, robots: u32) -> Option<To> {
        let sends = match &self.senders {
            Senders::All => true,
            Senders::Given(robots) => robots.contains(&robot.0),
        };
        let to = match self.to {
            Recipients::Everyone => To::Everyone,
            Recipients::Next if robots > 1 => To::One(ActorId((robot.0 + 1) % robots)),
            Recipients::Robot(to) if to != robot.0 => To::One(ActorId(to)),
            Recipients::Next | Recipients::Robot(_) => return None,
        };
        sends.then_some(to)
    }

    /// How many robots send.
    fn sending(&self, robots: u32) -> f64 {
        (0..robots)
            .filter(|robot| self.to(ActorId(*robot), robots).is_some())
            .count() as f64
    }
}

impl Kind for TrafficConfig {
    const NAME: &'static str = "Traffic";
    type Robot = Source;

    fn layout() -> Layout {
        Layout::new(vec![Part::rest("load")])
    }

    fn robots(&self, swarm: &Swarm<'_>) -> Vec<Source> {
        let robots = swarm.poses.len() as u32;
        swarm.each(|robot| Source::new(self.when, self.payload, self.to(robot, robots)))
    }

    fn moves(&self, _: &Sections<'_>) -> bool {
        false
    }

    fn heeds(&self, _: &Sections<'_>) -> &'static [Shared] {
        &[]
    }

    fn problems(&self, sections: &Sections<'_>) -> Vec<(String, String)> {
        let mut found = Vec::new();
        let robots = sections.robots;
        let absent = |robot: u32| {
            format!(
                "there is no robot {robot}: the swarm has robots 0 to {}",
                robots.saturating_sub(1)
            )
        };
        if let Senders::Given(senders) = &self.senders {
            for (place, &robot) in senders.iter().enumerate().filter(|(_, robot)| **robot >= robots) {
                found.push((format!("senders[{place}]"), absent(robot)));
            }
        }
        if let Recipients::Robot(robot) = self.to
            && robot >= robots
        {
            found.push(("to".to_owned(), absent(robot)));
        }
        if let Some(most) = sections.radio.longest_message(1, false)
            && u32::from(self.payload) > most
        {
            let message = format!(
                "a payload of {} bytes never fits a frame of this radio, which carries at most {most}; make it shorter",
                self.payload
            );
            found.push(("payload".to_owned(), message));
        }
        if self.when == Timing::Saturated && !sections.radio.takes_time() {
            let message = "over this radio frames take no time, and it is never full; use Periodic or Poisson, or a radio with a technology";
            found.push(("when".to_owned(), message.to_owned()));
        }
        found
    }

    fn broadcasts(&self, sections: &Sections<'_>) -> Option<Broadcasts> {
        let per_second = match self.when {
            Timing::Periodic(interval) => 1.0 / interval.get(),
            Timing::Poisson(rate) => rate.get(),
            Timing::Saturated => return None,
        };
        let broadcasts = Broadcasts {
            sending: self.sending(sections.robots) / f64::from(sections.robots.max(1)),
            per_second,
            payload: self.payload.into(),
            scattered: true,
        };
        (self.to == Recipients::Everyone).then_some(broadcasts)
    }

    fn frames_a_second(&self, sections: &Sections<'_>) -> f64 {
        let share = self.sending(sections.robots) / f64::from(sections.robots.max(1));
        let frames = match self.when {
            Timing::Periodic(interval) => 1.0 / interval.get(),
            Timing::Poisson(rate) => rate.get(),
            Timing::Saturated => sections.radio.most_frames_a_second(self.payload.into()),
        };
        share * frames
    }
}
