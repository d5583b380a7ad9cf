//! Local trees as scenarios name them.

use std::rc::Rc;

use super::measure::Measure;
use super::{Duty, Keep, LocalTree, LocalTreeConfig, Settings, WORKER, message};
use crate::engine::SimTime;
use crate::geometry::Vec2;
use crate::kind::{Expected, Goal, InPieces, Kind, Problem, Sections, Shared, Start, Swarm, Targets, targets};
use crate::metrics::{Mission, MissionTarget, NotedFigure, Ties, TrialRecord};
use crate::protocol::{Assignment, CompletionConfig, Layout, TargetsConfig};
use crate::simulation::RunError;

impl LocalTreeConfig {
    fn places(&self) -> Vec<(Vec2, u8)> {
        self.targets.as_ref().map_or_else(Vec::new, TargetsConfig::places)
    }

    fn assignment(&self, swarm: &Swarm<'_>) -> Assignment {
        Assignment::nearest(swarm.poses, self.places().into_iter().map(|(place, _)| place))
    }
}

impl Kind for LocalTreeConfig {
    const NAME: &'static str = "LocalTree";
    type Robot = LocalTree;

    fn robots(&self, swarm: &Swarm<'_>) -> Vec<LocalTree> {
        let Sections {
            radio, motion, control, ..
        } = swarm.sections;
        let settings = Rc::new(Settings {
            config: self.clone(),
            range: radio.disk().range.get(),
            max_speed: motion.max_speed.get(),
            period: control.period.get(),
            ground: swarm.ground(),
        });
        let places = self.places();
        let duties = self.targets.is_some().then(|| self.assignment(swarm));
        swarm.each(|id| {
            let duty = match &duties {
                None => Duty::Wanders,
                Some(duties) if duties.root == id => Duty::Root,
                Some(duties) => match duties.target_of(id) {
                    Some(target) => Duty::Worker(target as u16, places[target].0),
                    None => Duty::Follows,
                },
            };
            LocalTree::new(id, Rc::clone(&settings), swarm.status_turns(id), duty)
        })
    }

    fn run(&self, swarm: &Swarm<'_>, start: Start<'_>) -> Result<TrialRecord, RunError> {
        let robots = self.robots(swarm);
        let goal = self.goal(&robots);
        // Each has then heard all that it hears, built a tree of them, and said it.
        let settled = swarm.sections.period() * (u64::from(self.memory) + 3);
        let finished = start.observe(robots, goal, Measure::new(swarm.poses.len(), SimTime::ZERO + settled))?;
        let mut record = finished.record;
        finished.observer.note(&mut record);
        Ok(record)
    }

    fn figures(&self) -> Vec<NotedFigure> {
        Measure::figures()
    }

    fn layout() -> Layout {
        message::layout()
    }

    /// Every target held by a worker that kept links lead to the root from.
    fn goal(&self, robots: &[LocalTree]) -> Goal {
        let Some(root) = robots.iter().find(|robot| robot.is_root()) else {
            return Goal::None;
        };
        let places = self.places().into_iter();
        let targets = places.map(|(position, links)| MissionTarget {
            position,
            links: links.into(),
        });
        Goal::Targets(Mission {
            targets: targets.collect(),
            reach: self.movement_threshold.get(),
            ties: Ties::Parents {
                within: root.settings.range,
            },
            root: root.id,
            root_role: None,
            worker_role: WORKER,
        })
    }

    fn mission(&self) -> Option<&'static str> {
        self.targets.as_ref().map(|_| "targets must be held")
    }

    fn completion(&self) -> Option<CompletionConfig> {
        self.completion
    }

    fn completed_by(&self, completion: CompletionConfig) -> Option<Self> {
        self.targets.as_ref().map(|_| Self {
            completion: Some(completion),
            ..self.clone()
        })
    }

    fn heeds(&self, _: &Sections<'_>) -> &'static [Shared] {
        if self.targets.is_some() {
            &[Shared::Status]
        } else {
            &[Shared::Status, Shared::Wander]
        }
    }

    fn unheeded(&self, setting: Shared) -> &'static str {
        match setting {
            Shared::Wander => "its robots follow each other to targets",
            Shared::StatusSend => "robots are heard by their statuses, whatever these say",
            Shared::Detector => "its `memory` says when a robot is missed",
            _ => "statuses are all that it says",
        }
    }

    fn moves(&self, _: &Sections<'_>) -> bool {
        true
    }

    fn problems(&self, sections: &Sections<'_>) -> Vec<(String, String)> {
        let range = sections.radio.disk().range.get();
        self.own_problems(sections.robots, range)
    }

    fn warnings(&self, sections: &Sections<'_>, completion: CompletionConfig) -> Vec<Problem> {
        let mut found = Vec::new();
        if let Some(config) = &self.targets {
            let near = self.movement_threshold.get();
            found.extend(targets::unreachable(config, near, sections));
            found.extend(targets::too_far(config, near, sections, completion));
        }
        let pause = sections.gossip.status.longest_pause(sections.period()).as_secs();
        let memory = (f64::from(self.memory) + 1.0) * sections.control.period.get();
        if pause > memory {
            let message = format!(
                "statuses come every {pause} s at the latest, and after {memory} s a robot is forgotten: links come and go"
            );
            let help = "make `protocol.memory` more, or the interval of `gossip.status` shorter";
            found.push(Problem::new("protocol.memory", message, help).with(&["gossip.status", "control.period"]));
        }
        if let Keep::Midpoint { margin } = self.keep {
            let moved = sections.motion.max_speed.get() * (memory + pause);
            if margin.get() < moved {
                let message = format!(
                    "two robots may be {moved:.3} m nearer to their ends of a link, or further, than the other knows, and the margin is {} m: links may part",
                    margin.get()
                );
                let help = "make `protocol.keep`'s margin more, `protocol.memory` less or robots slower";
                found.push(Problem::new("protocol.keep", message, help).with(&["protocol.memory", "motion.max_speed"]));
            }
        }
        found
    }

    fn targets(&self) -> Option<Targets> {
        let config = self.targets.as_ref()?;
        let places = config.places();
        Some(Targets {
            near: self.movement_threshold.get(),
            robots: 1 + places.len(),
            places,
        })
    }

    fn in_pieces(&self, _: &Sections<'_>) -> Option<InPieces> {
        Some(InPieces::harmful(
            "pieces stay apart, for only links that are there are kept",
        ))
    }

    fn frames_a_second(&self, _: &Sections<'_>) -> f64 {
        0.0
    }

    fn predict(&self, _: &Sections<'_>) -> Expected {
        let why = "a status has two bytes for each link of a tree whose size loss and motion change";
        Expected::default().without("status", "status bytes", why)
    }
}
