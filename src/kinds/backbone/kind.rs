//! The backbone as scenarios name it.

use super::reign::Reign;
use super::{Backbone, BackboneConfig, Role, checks, layout, swarm};
use crate::kind::{
    Expected, Goal, Holds, InPieces, Kind, Prediction, Problem, Sections, Shared, Start, Swarm, Targets,
};
use crate::metrics::{Mission, MissionTarget, NotedFigure, Ties, TrialRecord};
use crate::protocol::{CompletionConfig, Layout};
use crate::simulation::RunError;

impl Kind for BackboneConfig {
    const NAME: &'static str = "Backbone";
    type Robot = Backbone;

    fn robots(&self, robots: &Swarm<'_>) -> Vec<Backbone> {
        let Sections {
            gossip,
            detector,
            control,
            ..
        } = robots.sections;
        swarm(self, gossip, detector, control, robots.poses, robots.streams)
    }

    fn run(&self, swarm: &Swarm<'_>, start: Start<'_>) -> Result<TrialRecord, RunError> {
        let robots = self.robots(swarm);
        let goal = self.goal(&robots);
        let root = robots.first().filter(|_| self.election.is_some()).map(Backbone::root);
        let Some(root) = root else {
            return start.run(robots, goal);
        };
        let finished = start.observe(robots, goal, Reign::new(swarm.poses.len(), root))?;
        let mut record = finished.record;
        finished.observer.note(&mut record);
        Ok(record)
    }

    fn figures(&self) -> Vec<NotedFigure> {
        self.election.as_ref().map_or_else(Vec::new, |_| Reign::figures())
    }

    fn layout() -> Layout {
        layout::layout()
    }

    /// Every target held, with its links (paper eqs. 2 to 5).
    fn goal(&self, robots: &[Backbone]) -> Goal {
        let Some(first) = robots.first() else { return Goal::None };
        let targets = self.targets().into_iter().map(|(position, links)| MissionTarget {
            position,
            links: u32::from(links),
        });
        Goal::Targets(Mission {
            targets: targets.collect(),
            reach: self.movement_threshold.get(),
            ties: Ties::Parents {
                within: self.critical_distance.get(),
            },
            root: first.root(),
            root_role: self.election.as_ref().map(|_| Role::Root.index()),
            worker_role: Role::Worker.index(),
        })
    }

    fn mission(&self) -> Option<&'static str> {
        Some("targets must be held")
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
        &[
            Shared::Status,
            Shared::StatusSend,
            Shared::Strand,
            Shared::Request,
            Shared::Relay,
            Shared::Piggyback,
            Shared::Detector,
        ]
    }

    fn unheeded(&self, setting: Shared) -> &'static str {
        match setting {
            Shared::RelayFanOut => "its orders are for everyone",
            _ => "it says itself how robots move",
        }
    }

    fn problems(&self, sections: &Sections<'_>) -> Vec<(String, String)> {
        self.own_problems(sections.robots, sections.radio.disk().range.get())
    }

    fn conflicts(&self, sections: &Sections<'_>) -> Vec<Problem> {
        checks::conflicts(self, sections)
    }

    fn warnings(&self, sections: &Sections<'_>, completion: CompletionConfig) -> Vec<Problem> {
        checks::warnings(self, sections, completion)
    }

    fn targets(&self) -> Option<Targets> {
        Some(Targets {
            places: self.targets(),
            near: self.movement_threshold.get(),
            robots: self.robots_needed(),
        })
    }

    fn reserved(&self) -> Option<(u32, &'static str)> {
        self.election.is_none().then_some((0, "root"))
    }

    fn in_pieces(&self, _: &Sections<'_>) -> Option<InPieces> {
        Some(InPieces::harmful("robots out of reach of the root are never recruited"))
    }

    fn frames_a_second(&self, sections: &Sections<'_>) -> f64 {
        let gossip = sections.gossip;
        let period = sections.control.period.get();
        let topics = [gossip.strand.interval, gossip.request.interval, gossip.relay.interval];
        topics.iter().map(|interval| 1.0 / interval.get().max(period)).sum()
    }

    fn status_bytes(&self) -> Option<f64> {
        Some(4.0)
    }

    fn predict(&self, _: &Sections<'_>) -> Expected {
        let needed = Prediction {
            name: "robots_needed",
            what: "robots needed",
            value: self.robots_needed() as f64,
            unit: "robots",
            accuracy: 0.0,
            holds: Holds::AtEnd,
            formula: "1 + Σ (1 + links · (⌈(distance − d_δ)/d_s⌉ − 1))",
            assumes: "a root, a worker a target, chains as short as they can be and no failure".into(),
        };
        let expected = Expected {
            predictions: vec![needed],
            ..Expected::default()
        };
        let end = "chains end in straight lines, but where the free robots come to rest has no closed form";
        let requests = "how often robots ask, refuse and ask again depends on how chains grow";
        let strands = "a strand has a byte for each robot of its chain so far: its size is the history of the mission";
        expected
            .without("degree_at_end", "neighbours at the end", end)
            .without("request", "request bytes", requests)
            .without("strand", "strand bytes", strands)
    }
}
