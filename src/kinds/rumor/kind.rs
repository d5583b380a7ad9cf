//! Rumours as scenarios name them.

use super::{Rumor, RumorConfig, message, swarm};
use crate::kind::{Expected, Goal, InPieces, Kind, Problem, Sections, Shared, Swarm};
use crate::protocol::gossip::FanOutConfig;
use crate::protocol::wander::WanderConfig;
use crate::protocol::{CompletionConfig, Layout};

impl Kind for RumorConfig {
    const NAME: &'static str = "Rumor";
    type Robot = Rumor;

    fn layout() -> Layout {
        message::layout()
    }

    fn robots(&self, robots: &Swarm<'_>) -> Vec<Rumor> {
        let Sections { gossip, control, .. } = robots.sections;
        let number = robots.poses.len() as u32;
        swarm(self, gossip, control, number, robots.ground(), robots.streams)
    }

    fn goal(&self, _: &[Rumor]) -> Goal {
        Goal::AllInformed(self.sources.rumors())
    }

    fn mission(&self) -> Option<&'static str> {
        Some("rumours must be known to all")
    }

    fn completion(&self) -> Option<CompletionConfig> {
        self.completion
    }

    fn completed_by(&self, completion: CompletionConfig) -> Option<Self> {
        Some(Self {
            completion: Some(completion),
            ..self.clone()
        })
    }

    fn heeds(&self, _: &Sections<'_>) -> &'static [Shared] {
        &[Shared::Relay, Shared::RelayFanOut, Shared::Piggyback, Shared::Wander]
    }

    fn unheeded(&self, setting: Shared) -> &'static str {
        match setting {
            Shared::Strand => "it has no strands",
            Shared::Request => "its requests go out with its rounds: see `gossip.relay`",
            Shared::Detector => "it runs no failure detector",
            _ => "it has no statuses",
        }
    }

    fn problems(&self, sections: &Sections<'_>) -> Vec<(String, String)> {
        self.own_problems(sections.robots)
    }

    fn conflicts(&self, sections: &Sections<'_>) -> Vec<Problem> {
        let relay = self.relay_problems(&sections.gossip.relay, sections.robots);
        let placed = |problem| Problem::of_section("gossip.relay", problem).with(&["protocol", "swarm.robots"]);
        relay.into_iter().map(placed).collect()
    }

    fn in_pieces(&self, sections: &Sections<'_>) -> Option<InPieces> {
        (*sections.wander == WanderConfig::Still).then(|| InPieces::harmful("a rumour stays in its own"))
    }

    fn frames_a_second(&self, sections: &Sections<'_>) -> f64 {
        let relay = &sections.gossip.relay;
        let peers = match relay.fan_out {
            FanOutConfig::Everyone => 1.0,
            FanOutConfig::Peers(peers) => f64::from(peers),
        };
        let interval = relay.interval.get();
        let rounds = if self.is_poisson() {
            1.0 / interval
        } else {
            1.0 / interval.max(sections.control.period.get())
        };
        rounds * self.sources.rumors() as f64 * peers
    }

    fn wakes_within(&self, sections: &Sections<'_>) -> Option<f64> {
        // Rounds of a Poisson process seldom come ten times later than on average.
        self.is_poisson().then(|| 10.0 * sections.gossip.relay.interval.get())
    }

    fn relays_in_steps(&self) -> bool {
        !self.is_poisson()
    }

    fn predict(&self, _: &Sections<'_>) -> Expected {
        let why = "who passes on what depends on who knows it already";
        Expected::default().without("rumor", "rumour bytes", why)
    }
}
