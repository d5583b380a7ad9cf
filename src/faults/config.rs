//! What a scenario says about failures.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::engine::SimTime;
use crate::geometry::{Vec2, at_most};
use crate::quantity::{Finite, NonNegative, Positive, Probability};

/// One way in which robots or links fail. The first seven fail robots and are short for `Robots`, the general form.
///
/// ```text
/// faults: [
///     Silence(robots: [3, 4], at: 120.0),
///     Crash(robots: [5], at: 30.0, lasts: For(60.0)),
///     Fallible(share: 0.2, hazard: 0.0003),
///     Radiation(within: Disc(at: (2.0, 0.0), radius: 1.5), hazard: 0.001, during: Between(60.0, 300.0)),
///     Robots(effect: Deaf, robots: Share(0.5), roles: ["networker"], when: At(90.0), lasts: For(10.0)),
///     Partition(line: ((0.0, -5.0), (0.0, 5.0)), during: Between(60.0, 90.0)),
///     Burst(links: Of([3]), loss: 0.9, during: From(60.0)),
/// ]
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(clippy::large_enum_variant)] // There are a few a scenario.
pub enum FaultConfig {
    /// Given robots lose their ability to communicate at a given time (the paper's failure): they neither send nor hear,
    /// and move and think on.
    Silence(PlannedConfig),
    /// Given robots stop moving, sending, hearing and thinking at a given time.
    Crash(PlannedConfig),
    /// Given robots can send no more, from a given time on.
    Mute(PlannedConfig),
    /// Given robots can hear no more, from a given time on.
    Deaf(PlannedConfig),
    /// The paper's failures as this simulator reads them: a share of the robots is fallible, and a fallible robot goes
    /// silent for good with a small probability a control step while it has a backbone role.
    Fallible(FallibleConfig),
    /// The harsher reading of the paper: every robot that takes a backbone role is silenced with a probability, soon after.
    OnJoin(OnJoinConfig),
    /// Robots fail with a small probability a control step while they are inside a region.
    Radiation(RadiationConfig),
    /// Robots fail: the general form.
    Robots(RobotsConfig),
    /// A line splits the arena: nothing that is sent on one side is heard on the other.
    Partition(PartitionConfig),
    /// Some links lose frames beside what the channel loses.
    Burst(BurstConfig),
}

/// A failure of given robots at a given time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlannedConfig {
    /// The robots, by number from 0.
    pub robots: Vec<u32>,
    /// When they fail, seconds.
    pub at: NonNegative,
    /// For how long.
    #[serde(default)]
    pub lasts: LastsConfig,
}

/// A share of the robots is fallible; a fallible robot goes silent while it has one of the roles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FallibleConfig {
    /// Share of the robots that is fallible: a uniform number, drawn for each robot once a trial, decides. Robots that
    /// are fallible at a share are also at any greater one.
    pub share: Probability,
    /// Probability of failing in a control step (0.0003 is calibrated to the paper's completion times).
    pub hazard: Probability,
    /// The roles in which a fallible robot may fail; none for any role.
    #[serde(default = "backbone_roles")]
    pub roles: Vec<String>,
}

/// Robots that take a role go silent with a probability, for good.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OnJoinConfig {
    /// Probability of failing, drawn once whenever a robot takes one of the roles from another role.
    pub probability: Probability,
    /// A robot that is to fail does so at a uniform time within so many seconds, unless it has left the roles by then.
    pub window: NonNegative,
    /// The roles.
    #[serde(default = "backbone_roles")]
    pub roles: Vec<String>,
}

/// Robots fail while they are inside a region.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RadiationConfig {
    /// The region.
    pub within: RegionConfig,
    /// Probability of failing in a control step inside.
    pub hazard: Probability,
    /// When it is so.
    #[serde(default)]
    pub during: IntervalConfig,
    /// What fails.
    #[serde(default = "crash")]
    pub effect: Effect,
    /// For how long a robot fails.
    #[serde(default)]
    pub lasts: LastsConfig,
}

/// Robots fail: which of them, when, how and for how long.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RobotsConfig {
    /// What fails.
    pub effect: Effect,
    /// Which robots may fail at all.
    #[serde(default)]
    pub robots: ChosenConfig,
    /// The roles in which they may fail; none for any role.
    #[serde(default)]
    pub roles: Vec<String>,
    /// Where they may fail.
    #[serde(default)]
    pub within: RegionConfig,
    /// When they fail.
    pub when: WhenConfig,
    /// For how long.
    #[serde(default)]
    pub lasts: LastsConfig,
}

/// What a failed robot cannot do. Failures may overlap: a robot is well when all have passed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Effect {
    /// It neither sends nor hears.
    Silence,
    /// It stops: no motion, no radio, no thought. Its memory stays; if it recovers it goes on at its next control step,
    /// timers that ran out meanwhile fire at once, and it stands until it commands a velocity.
    Crash,
    /// It cannot send.
    Mute,
    /// It cannot hear.
    Deaf,
    /// Its battery is empty: as a crash. Over a radio whose robots have a `battery`, what befalls those that have used it up.
    Battery,
}

impl Effect {
    /// Every effect.
    pub const ALL: [Self; 5] = [Self::Silence, Self::Crash, Self::Mute, Self::Deaf, Self::Battery];

    /// The name that reports and tables use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Silence => "silence",
            Self::Crash => "crash",
            Self::Mute => "mute",
            Self::Deaf => "deaf",
            Self::Battery => "battery",
        }
    }
}

/// Which robots may fail.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum ChosenConfig {
    /// All.
    #[default]
    All,
    /// These, by number from 0.
    Given(Vec<u32>),
    /// A share, decided by a uniform number drawn for each robot once a trial.
    Share(Probability),
}

/// A part of the arena. Coordinates in metres from its centre; the rim belongs to the region.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum RegionConfig {
    /// All of it.
    #[default]
    Anywhere,
    /// A disc.
    Disc {
        /// Its centre.
        at: (Finite, Finite),
        /// Its radius, metres.
        radius: Positive,
    },
    /// An upright rectangle.
    Rectangle {
        /// Its centre.
        at: (Finite, Finite),
        /// Width and height, metres.
        size: (Positive, Positive),
    },
}

impl RegionConfig {
    /// Whether `place` is inside.
    #[must_use]
    pub fn contains(&self, place: Vec2) -> bool {
        match self {
            Self::Anywhere => true,
            Self::Disc { at, radius } => (place - point(*at)).norm() <= at_most(radius.get()),
            Self::Rectangle { at, size } => {
                let off = (place - point(*at)).abs();
                off.x <= at_most(size.0.get() / 2.0) && off.y <= at_most(size.1.get() / 2.0)
            }
        }
    }
}

/// When robots fail.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum WhenConfig {
    /// At this time, seconds: those that have one of the roles and are in the region then.
    At(NonNegative),
    /// At random, with the same probability in every control step.
    Hazard {
        /// Probability of failing in a control step, at whose end the robot has one of the roles and is in the region.
        per_step: Probability,
        /// When it is so.
        #[serde(default)]
        during: IntervalConfig,
    },
    /// After taking one of the roles.
    OnJoin {
        /// Probability of failing, drawn once whenever a robot takes one of the roles from another role.
        probability: Probability,
        /// A robot that is to fail does so at a uniform time within so many seconds, if it still has one of the roles and
        /// is in the region then.
        window: NonNegative,
    },
}

/// How long a failure lasts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum LastsConfig {
    /// To the end of the trial.
    #[default]
    ForGood,
    /// So many seconds; then the robot recovers.
    For(Positive),
}

/// A part of the trial.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum IntervalConfig {
    /// All of it.
    #[default]
    Always,
    /// From this time on, seconds.
    From(NonNegative),
    /// From the first time to the second, a later one, seconds.
    Between(NonNegative, NonNegative),
}

impl IntervalConfig {
    /// Its start and its end.
    #[must_use]
    pub fn bounds(self) -> (SimTime, SimTime) {
        let time = |seconds: NonNegative| SimTime::from_secs(seconds.get());
        match self {
            Self::Always => (SimTime::ZERO, SimTime::NEVER),
            Self::From(from) => (time(from), SimTime::NEVER),
            Self::Between(from, until) => (time(from), time(until)),
        }
    }
}

/// A line that nothing crosses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PartitionConfig {
    /// Two points of the line, which goes on beyond both; metres from the arena's centre. A robot on the line is on the
    /// left-hand side, as seen from the first point to the second.
    pub line: ((Finite, Finite), (Finite, Finite)),
    /// When it is there. Sides are decided by where robots are when a frame is sent.
    #[serde(default)]
    pub during: IntervalConfig,
}

/// More loss on some links.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BurstConfig {
    /// The links.
    #[serde(default)]
    pub links: LinksConfig,
    /// Probability that a copy of a frame is lost, beside what the channel loses.
    pub loss: Probability,
    /// When it is so: a frame is lost if it is sent then.
    #[serde(default)]
    pub during: IntervalConfig,
}

/// Some links, in both directions.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum LinksConfig {
    /// All.
    #[default]
    All,
    /// All links of these robots.
    Of(Vec<u32>),
    /// The links between these pairs of robots.
    Pairs(Vec<(u32, u32)>),
}

/// The vector to a place of a scenario.
pub(super) fn point(at: (Finite, Finite)) -> Vec2 {
    Vec2::new(at.0.get(), at.1.get())
}

fn backbone_roles() -> Vec<String> {
    vec!["networker".into(), "worker".into()]
}

fn crash() -> Effect {
    Effect::Crash
}

impl FaultConfig {
    /// The general form of a failure of robots; `None` for one of links.
    #[must_use]
    pub fn of_robots(&self) -> Option<RobotsConfig> {
        Some(match self {
            Self::Silence(planned) => planned.general(Effect::Silence),
            Self::Crash(planned) => planned.general(Effect::Crash),
            Self::Mute(planned) => planned.general(Effect::Mute),
            Self::Deaf(planned) => planned.general(Effect::Deaf),
            Self::Fallible(fallible) => RobotsConfig {
                robots: ChosenConfig::Share(fallible.share),
                roles: fallible.roles.clone(),
                ..RobotsConfig::all(
                    Effect::Silence,
                    WhenConfig::Hazard {
                        per_step: fallible.hazard,
                        during: IntervalConfig::Always,
                    },
                )
            },
            Self::OnJoin(join) => RobotsConfig {
                roles: join.roles.clone(),
                ..RobotsConfig::all(
                    Effect::Silence,
                    WhenConfig::OnJoin {
                        probability: join.probability,
                        window: join.window,
                    },
                )
            },
            Self::Radiation(radiation) => RobotsConfig {
                within: radiation.within.clone(),
                lasts: radiation.lasts,
                ..RobotsConfig::all(
                    radiation.effect,
                    WhenConfig::Hazard {
                        per_step: radiation.hazard,
                        during: radiation.during,
                    },
                )
            },
            Self::Robots(robots) => robots.clone(),
            Self::Partition(_) | Self::Burst(_) => return None,
        })
    }
}

impl PlannedConfig {
    fn general(&self, effect: Effect) -> RobotsConfig {
        RobotsConfig {
            robots: ChosenConfig::Given(self.robots.clone()),
            lasts: self.lasts,
            ..RobotsConfig::all(effect, WhenConfig::At(self.at))
        }
    }
}

impl RobotsConfig {
    /// Every robot, in any role and anywhere, for good.
    fn all(effect: Effect, when: WhenConfig) -> Self {
        Self {
            effect,
            robots: ChosenConfig::All,
            roles: Vec::new(),
            within: RegionConfig::Anywhere,
            when,
            lasts: LastsConfig::ForGood,
        }
    }
}
