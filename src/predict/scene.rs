//! What several predictions need to know of a scenario.

use crate::engine::Span;
use crate::kind::{Broadcasts, Expected, Shared};
use crate::motion::Spacing;
use crate::protocol::control::PhaseConfig;
use crate::protocol::gossip::{SendConfig, Timing};
use crate::radio::LossConfig;
use crate::scenario::Scenario;

/// A scenario, looked at by one who predicts.
pub struct Scene<'a> {
    pub scenario: &'a Scenario,
    /// How long a trial lasts, seconds.
    pub duration_s: f64,
    /// Where robots stand at the start, or why no law of it is known.
    pub spacing: Result<Spacing, &'static str>,
    /// What the protocol's own closed forms say.
    pub expected: Expected,
}

/// Shells that the range is cut into where a figure depends on the distance.
const SHELLS: usize = 100;

impl<'a> Scene<'a> {
    pub fn of(scenario: &'a Scenario, duration_s: f64) -> Self {
        let swarm = &scenario.swarm;
        let body_radius = scenario.motion.body_radius.get();
        Self {
            scenario,
            duration_s,
            spacing: Spacing::of(&swarm.deploy, &scenario.arena, swarm.robots, body_radius),
            expected: scenario.protocol.predict(&scenario.sections()),
        }
    }

    /// Whether robots stay where they are deployed.
    pub fn stands_still(&self) -> bool {
        !self.scenario.moves()
    }

    /// Why no steady stream of statuses can be counted on, if none can.
    pub fn unsteady(&self) -> Option<&'static str> {
        let protocol = &self.scenario.protocol;
        if !protocol.has_statuses() {
            return Some("the protocol sends no statuses");
        }
        if !protocol.heeds(&self.scenario.sections()).contains(&Shared::Status) {
            return Some("the protocol does not send its statuses as `gossip.status` says");
        }
        match self.scenario.gossip.status.send {
            SendConfig::OnChange { .. } => {
                Some("statuses are sent when what they say changes: how often that is depends on the mission")
            }
            SendConfig::Always => None,
        }
    }

    /// Why nothing can be said of the bytes of statuses, if nothing can.
    pub fn unmeasured(&self) -> Option<&'static str> {
        let unsaid = self.scenario.protocol.status_bytes().is_none();
        let why = unsaid.then_some("the protocol does not say how long its statuses are");
        self.unsteady().or(why)
    }

    /// Whether robots send nothing but statuses.
    pub fn sends_statuses_alone(&self) -> bool {
        self.scenario.protocol.sends_statuses_alone(&self.scenario.sections())
    }

    /// Length of a control step, seconds.
    pub fn period_s(&self) -> f64 {
        self.scenario.control.period.get()
    }

    /// The rhythm of statuses.
    pub fn status_timing(&self) -> Timing {
        self.scenario.gossip.status.timing(Span::from_secs(self.period_s()))
    }

    /// Control steps from one status of a robot to the next, on average.
    pub fn steps_a_status(&self) -> f64 {
        self.status_timing().every() as f64
    }

    /// η, seconds from one status of a robot to the next.
    pub fn interval_s(&self) -> f64 {
        self.steps_a_status() * self.period_s()
    }

    /// The one steady stream that robots send, if they send nothing beside.
    pub fn broadcasts(&self) -> Option<Broadcasts> {
        let (protocol, sections) = (&self.scenario.protocol, self.scenario.sections());
        if let Some(broadcasts) = protocol.broadcasts(&sections) {
            return Some(broadcasts);
        }
        let alone = self.unmeasured().is_none() && self.sends_statuses_alone();
        alone.then(|| Broadcasts {
            sending: 1.0,
            per_second: 1.0 / self.interval_s(),
            payload: protocol.status_bytes().unwrap_or(0.0),
            scattered: self.scenario.control.phase == PhaseConfig::Random,
        })
    }

    /// Bytes of a status, headers included.
    pub fn status_bytes(&self) -> f64 {
        let payload = self.scenario.protocol.status_bytes().unwrap_or(0.0);
        let [frame, message] = self.scenario.header_bytes();
        payload + f64::from(frame) + f64::from(message)
    }

    /// Those of them that are another message's where a status is not the first in its frame.
    pub fn shared_bytes(&self) -> f64 {
        let shared = self.scenario.gossip.piggyback && !self.sends_statuses_alone();
        if shared {
            f64::from(self.scenario.header_bytes()[0])
        } else {
            0.0
        }
    }

    /// The means of figures of the distance over the neighbours at the start; the figures themselves where they do not depend on
    /// it. `None` if distances are not known, or nobody has a neighbour.
    pub fn mean_over_neighbours<const N: usize>(&self, figures: impl Fn(f64) -> [f64; N]) -> Option<[f64; N]> {
        let range = self.scenario.radio.disk().range.get();
        if !self.depends_on_distance() {
            return Some(figures(range));
        }
        // Shells, so that the work does not grow with the number of places given.
        let mut shells = [[0.0; 2]; SHELLS];
        self.spacing.as_ref().ok()?.for_each_within(range, |distance, number| {
            let shell = ((distance / range * SHELLS as f64) as usize).min(SHELLS - 1);
            shells[shell][0] += number;
            shells[shell][1] += number * distance;
        });
        let neighbours: f64 = shells.iter().map(|shell| shell[0]).sum();
        let mut means = [0.0; N];
        for [number, distances] in shells.into_iter().filter(|shell| shell[0] > 0.0) {
            let figures = figures(distances / number);
            for (mean, figure) in means.iter_mut().zip(figures) {
                *mean += number / neighbours * figure;
            }
        }
        (neighbours > 0.0).then_some(means)
    }

    /// Whether copies to near robots are lost less often than those to far ones.
    pub fn depends_on_distance(&self) -> bool {
        matches!(self.scenario.radio.disk().loss, LossConfig::Distance { .. })
    }

    /// The share of copies lost in the channel, over the neighbours at the start.
    pub fn loss_ratio(&self) -> Option<f64> {
        let radio = self.scenario.radio.disk();
        let loss = |distance| radio.loss.mean_loss(distance, radio.range.get());
        self.mean_over_neighbours(|distance| [loss(distance)])
            .map(|[loss]| loss)
    }
}
