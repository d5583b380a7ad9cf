//! The heartbeat as scenarios name it.

use std::convert::Infallible;
use std::rc::Rc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Heartbeat, Settings};
use crate::kind::{Goal, InPieces, Kind, Sections, Shared, Start, Swarm};
use crate::metrics::TrialRecord;
use crate::motion::DeployConfig;
use crate::protocol::detector::Probe;
use crate::protocol::wander::WanderConfig;
use crate::protocol::{Layout, Part};
use crate::simulation::RunError;

/// Status broadcasts and timeouts alone.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct HeartbeatConfig;

impl HeartbeatConfig {
    /// Robots whose messages carry what their detectors say by `P`.
    fn swarm<P>(swarm: &Swarm<'_>) -> Vec<Heartbeat<P>> {
        let Sections {
            gossip,
            detector,
            control,
            ..
        } = swarm.sections;
        let settings = Settings::new(gossip, detector, control, swarm.poses.len(), swarm.streams);
        let settings = Rc::new(settings.wandering(swarm.ground()));
        swarm.each(|id| Heartbeat::new(id, Rc::clone(&settings)))
    }
}

impl Kind for HeartbeatConfig {
    const NAME: &'static str = "Heartbeat";
    type Robot = Heartbeat;

    fn layout() -> Layout {
        // A number has fewer than 31 bits, so that no probe begins as it does.
        let status = (0..=0x3f, vec![Part::number("number", 4)]);
        let probes = Probe::layout();
        Layout::new(vec![Part::OneOf(std::iter::once(status).chain(probes).collect())])
    }

    fn robots(&self, swarm: &Swarm<'_>) -> Vec<Heartbeat> {
        Self::swarm::<Infallible>(swarm)
    }

    fn run(&self, swarm: &Swarm<'_>, start: Start<'_>) -> Result<TrialRecord, RunError> {
        if swarm.sections.detector.sends() {
            start.run(Self::swarm::<Rc<Probe>>(swarm), Goal::None)
        } else {
            start.run(self.robots(swarm), Goal::None)
        }
    }

    fn heeds(&self, sections: &Sections<'_>) -> &'static [Shared] {
        if sections.detector.sends() {
            &[Shared::Status, Shared::Wander, Shared::Detector, Shared::Piggyback]
        } else {
            &[Shared::Status, Shared::Wander, Shared::Detector]
        }
    }

    fn unheeded(&self, setting: Shared) -> &'static str {
        match setting {
            Shared::StatusSend => "each of its statuses has a new number, and so has changed",
            Shared::Strand => "it has no strands",
            Shared::Request => "it has no requests",
            Shared::Relay => "it passes nothing on",
            _ => "it sends one message at a time",
        }
    }

    fn in_pieces(&self, sections: &Sections<'_>) -> Option<InPieces> {
        let still = *sections.wander == WanderConfig::Still;
        let by_chance = !matches!(sections.deploy, DeployConfig::At(_));
        (still && by_chance).then(|| InPieces::noted("robots hear only those of their own"))
    }

    fn frames_a_second(&self, _: &Sections<'_>) -> f64 {
        0.0
    }

    fn status_bytes(&self) -> Option<f64> {
        Some(4.0)
    }

    fn sends_statuses_alone(&self, sections: &Sections<'_>) -> bool {
        !sections.detector.sends()
    }
}
