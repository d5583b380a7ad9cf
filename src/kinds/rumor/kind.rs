//! Rumours as scenarios name them.

use super::{Rumor, RumorConfig, message, swarm};
use crate::kind::{Expected, Goal, Holds, InPieces, Kind, Prediction, Problem, Sections, Shared, Swarm};
use crate::motion::DeployConfig;
use crate::protocol::control::WakeConfig;
use crate::protocol::gossip::{FanOutConfig, RetransmitConfig};
use crate::protocol::wander::WanderConfig;
use crate::protocol::{CompletionConfig, Layout};
use crate::quantity::NonNegative;
use crate::radio::{DiskConfig, LatencyConfig, LossConfig, RadioConfig, WallsConfig};
use crate::statistics::SimpleEpidemic;

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

    fn predict(&self, sections: &Sections<'_>) -> Expected {
        let why = "who passes on what depends on who knows it already";
        let expected = Expected::default().without("rumor", "rumour bytes", why);
        match self.epidemic(sections) {
            Ok(epidemic) => {
                let prediction = Prediction {
                    name: TIME_TO_ALL,
                    what: TIME_TO_ALL_WORDS,
                    value: epidemic.mean_duration(),
                    unit: "s",
                    // The rumour begins at a control step of its source.
                    accuracy: sections.control.period.get(),
                    holds: Holds::Throughout,
                    formula: "2 (N - 1) H(N - 1) / (N beta q)",
                    assumes: "a simple epidemic: all robots in range of each other, each addressing any other at rate beta, a message, or a request with \
                              its answer, arriving with probability q"
                        .to_owned(),
                };
                Expected {
                    predictions: vec![prediction],
                    ..expected
                }
            }
            Err(why) => expected.without(TIME_TO_ALL, TIME_TO_ALL_WORDS, why),
        }
    }
}

/// What is predicted of the spread, in the manner of `summary.json`.
const TIME_TO_ALL: &str = "spread.time_to_all_s";
const TIME_TO_ALL_WORDS: &str = "time until all know the rumour";

impl RumorConfig {
    /// The simple epidemic as which the one rumour spreads.
    ///
    /// # Errors
    /// Why it is none.
    fn epidemic(&self, sections: &Sections<'_>) -> Result<SimpleEpidemic, &'static str> {
        let Sections {
            gossip, control, radio, ..
        } = sections;
        let relay = &gossip.relay;
        let disk = match radio {
            RadioConfig::Disk(disk) => disk,
            RadioConfig::Shared(_) => return Err("robots share the air"),
        };
        let arrives = match disk.loss {
            LossConfig::None => 1.0,
            LossConfig::Bernoulli(loss) => 1.0 - loss.get(),
            _ => return Err("losses are not independent of each other, or not of where robots are"),
        };
        // Answers go out when their sender wakes: at once, if reception wakes it.
        let pulls_at_once = control.wake == WakeConfig::OnReception;
        let holds = [
            (
                sections.robots < 2 || arrives == 0.0,
                "there is nobody to tell, or nothing arrives",
            ),
            (self.sources.rumors() > 1, "there are several rumours"),
            (
                !self.is_poisson(),
                "rounds are periodic: no closed form here covers them",
            ),
            (
                relay.fan_out != FanOutConfig::Peers(1),
                "a robot addresses more than one other at a time",
            ),
            (
                relay.retransmit != RetransmitConfig::Unlimited,
                "robots stop passing a rumour on",
            ),
            (
                self.mode.pulls() && !pulls_at_once,
                "who is asked answers at its next control step, and not at once",
            ),
            (
                disk.latency != LatencyConfig::Constant(NonNegative::new(0.0)),
                "messages take time",
            ),
            (
                !all_in_range(sections, disk),
                "not all robots are in range of each other",
            ),
            (!sections.faults.is_empty(), "robots or links fail"),
            (control.clock_drift.get() > 0.0, "clocks drift"),
        ];
        if let Some((_, why)) = holds.into_iter().find(|(fails, _)| *fails) {
            return Err(why);
        }
        let pushed = if self.mode.pushes() { arrives } else { 0.0 };
        let pulled = if self.mode.pulls() { arrives * arrives } else { 0.0 };
        Ok(SimpleEpidemic::new(
            sections.robots,
            (pushed + pulled) / relay.interval.get(),
        ))
    }
}

/// Whether each robot hears each other throughout.
fn all_in_range(sections: &Sections<'_>, disk: &DiskConfig) -> bool {
    let is_near = match sections.deploy {
        DeployConfig::Cluster { radius } => 2.0 * radius.get() <= disk.range.get(),
        DeployConfig::Uniform | DeployConfig::At(_) => false,
    };
    let is_open = disk.walls == WallsConfig::Pass || sections.arena.obstacles.is_empty();
    is_near && is_open && *sections.wander == WanderConfig::Still
}
