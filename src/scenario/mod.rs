//! Scenario files: one file is one question. This module composes the configs of the parts; each part owns its own.
//!
//! A file is RON: comments, then `Scenario( ... )`. [`load`] and [`parse`] read it, with the overrides of the command
//! line worked in, and answer a [`Scenario`] that holds, or a [`Report`] of everything that is wrong with it, each
//! with its place. On the way from text to scenario: `token` and `tree` know what stands where, `overrides` and
//! `source` work overrides into the text, `read` has serde make sense of it, `checks` finds what no field shows on its
//! own, `warnings` what is allowed and hardly meant, `explain` and `shape` say what would be right, `report` and `drawn` show it.

mod checks;
mod detector;
mod diagnostic;
mod document;
#[cfg_attr(not(feature = "command"), path = "plain.rs")]
mod drawn;
mod explain;
mod file;
#[cfg(test)]
mod generated;
mod gossip;
mod limits;
mod lines;
mod needs;
mod node;
mod overrides;
mod path;
mod protocol;
mod read;
mod report;
mod shape;
mod source;
mod study;
mod swallow;
mod token;
mod tree;
mod typed;
mod warnings;
mod write;

pub use crate::text::Style;
pub use diagnostic::{Diagnostic, Place};
pub use file::{contents, load, question};
pub use overrides::Override;
pub use protocol::ProtocolConfig;
pub use read::{examine, parse};
pub use report::{Report, Warnings};
pub use study::{
    DesignConfig, FactorConfig, LevelConfig, Plan, RonText, Setting, Study, is_study, load_study, plan_of_files,
    study_schema,
};
pub use write::{json_schema, to_ron};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::faults::FaultConfig;
use crate::kind::{Sections, Shared};
use crate::metrics::MetricsConfig;
use crate::metrics::figures::Registry;
use crate::motion::{ArenaConfig, DeployConfig, MotionConfig, Site};
use crate::protocol::control::ControlConfig;
use crate::protocol::detector::{Circumstances, DetectorConfig};
use crate::protocol::gossip::GossipConfig;
use crate::protocol::wander::WanderConfig;
use crate::protocol::{CompletionConfig, Layout};
use crate::quantity::Positive;
use crate::radio::RadioConfig;

/// A scenario: everything that a run is given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Name of the scenario; the default results folder is `results/<name>`. Letters, digits, `-` and `_`.
    #[schemars(regex(pattern = r"^[A-Za-z0-9_-]{1,64}$"))]
    pub name: String,
    /// Number of trials, each with random streams of its own.
    #[schemars(range(min = 1, max = limits::TRIALS))]
    #[serde(default = "one_trial")]
    pub trials: u32,
    /// Seed of every random stream.
    #[serde(default = "first_seed")]
    pub seed: u64,
    /// Simulated seconds after which a trial ends, complete or not.
    pub time_limit: Positive,
    /// The arena.
    #[serde(default)]
    pub arena: ArenaConfig,
    /// The robots.
    pub swarm: SwarmConfig,
    /// How robots move.
    #[serde(default)]
    pub motion: MotionConfig,
    /// When robots wake.
    #[serde(default)]
    pub control: ControlConfig,
    /// What robots run.
    pub protocol: ProtocolConfig,
    /// How robots move whose protocol has no motion of its own: not at all by default.
    #[serde(default)]
    pub wander: WanderConfig,
    /// How robots repeat what they gossip.
    #[serde(default)]
    pub gossip: GossipConfig,
    /// When a robot believes that a neighbour is down.
    #[serde(default)]
    pub detector: DetectorConfig,
    /// The radio.
    #[serde(default)]
    pub radio: RadioConfig,
    /// How robots and links fail; nothing fails by default.
    #[serde(default)]
    pub faults: Vec<FaultConfig>,
    /// What is measured.
    #[serde(default)]
    pub metrics: MetricsConfig,
}

impl Scenario {
    /// When its mission is complete: as its protocol says, else held for as long as the metrics say, else for 10 s.
    #[must_use]
    pub fn completion(&self) -> CompletionConfig {
        let said = self.protocol.completion();
        let held = self.metrics.hold.map(CompletionConfig::Held);
        said.or(held).unwrap_or_default()
    }

    /// The same scenario, its completion said where it belongs: with the protocol.
    fn settled(mut self) -> Self {
        if let Some(config) = self.protocol.completed_by(self.completion()) {
            self.protocol = config.into();
            self.metrics.hold = None;
        }
        self
    }

    /// What its failure detector is told of the swarm.
    #[must_use]
    pub fn circumstances(&self) -> Circumstances {
        self.sections().circumstances()
    }

    /// What it says beside its protocol.
    #[must_use]
    pub fn sections(&self) -> Sections<'_> {
        Sections {
            robots: self.swarm.robots,
            time_limit: self.time_limit.get(),
            arena: &self.arena,
            deploy: &self.swarm.deploy,
            motion: &self.motion,
            control: &self.control,
            wander: &self.wander,
            gossip: &self.gossip,
            detector: &self.detector,
            radio: &self.radio,
            faults: &self.faults,
            metrics: &self.metrics,
        }
    }

    /// What its protocol calls the topics in use.
    #[must_use]
    pub fn topics(&self) -> &'static [&'static str] {
        self.protocol.topics(&self.detector)
    }

    /// How its protocol's messages lie in their bytes, if the kind says so.
    #[must_use]
    pub fn layout(&self) -> Layout {
        crate::kinds::find(self.protocol.name()).map_or_else(Layout::default, |kind| (kind.layout)())
    }

    /// Bytes that each frame carries beside its messages, and each message beside its payload.
    #[must_use]
    pub fn header_bytes(&self) -> [u16; 2] {
        self.radio.header_bytes(self.topics().len(), self.gossip.piggyback)
    }

    /// The figures of its trials: those of all protocols, those of its radio, and its protocol's own.
    #[must_use]
    pub fn figures(&self) -> Registry {
        let all = Registry::of(self.protocol.all_topics());
        let all = match self.radio.shared() {
            Some(radio) if radio.battery.is_some() => all.sharing_air().on_batteries(),
            Some(_) => all.sharing_air(),
            None => all,
        };
        all.noting(&self.protocol.figures())
    }

    /// Whether robots run the failure detector that it sets.
    #[must_use]
    pub fn runs_detector(&self) -> bool {
        self.protocol.heeds(&self.sections()).contains(&Shared::Detector)
    }

    /// Whether any robot moves.
    #[must_use]
    pub fn moves(&self) -> bool {
        let sections = self.sections();
        let wanders = self.wander.speed() > 0.0 && self.protocol.heeds(&sections).contains(&Shared::Wander);
        wanders || self.protocol.moves(&sections)
    }

    /// Where its robots are deployed, and by which draws.
    #[must_use]
    pub fn site(&self) -> Site<'_> {
        Site {
            deploy: &self.swarm.deploy,
            arena: &self.arena,
            robots: self.swarm.robots,
            body_radius: self.motion.body_radius.get(),
            seed: self.seed,
        }
    }
}

fn one_trial() -> u32 {
    1
}

fn first_seed() -> u64 {
    1
}

/// The robots of a scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SwarmConfig {
    /// How many.
    #[schemars(range(min = 1, max = limits::ROBOTS))]
    pub robots: u32,
    /// Where they start.
    pub deploy: DeployConfig,
}
