//! The chains as the root knows them, from the strands of the robots that end them.

use crate::engine::ActorId;

use super::message::Strand;
use super::mission::Mission;
use super::neighbours::Neighbours;
use super::view::View;

/// All chains, by number from 1.
#[derive(Debug)]
pub struct Lines {
    lines: Vec<Line>,
    /// Whether any robot fell silent in its place so far.
    any_lost: bool,
}

/// One chain.
#[derive(Clone, Debug, Default)]
struct Line {
    /// Its robots, worker first, as last heard from its end at the root, without those that fell silent there since.
    robots: Vec<ActorId>,
    /// The control step at which it was heard last.
    heard: u64,
    /// Whether its end at the root fell silent since.
    cut: bool,
}

impl Lines {
    /// The chains of `mission`, of which nothing was heard yet.
    #[must_use]
    pub fn new(mission: &Mission) -> Self {
        Self {
            lines: vec![Line::default(); mission.chains.len()],
            any_lost: false,
        }
    }

    /// The same at control step `step`, in the place of a root that was lost: they get time to be heard.
    #[must_use]
    pub fn from_now_on(mission: &Mission, step: u64) -> Self {
        let line = Line {
            heard: step,
            ..Line::default()
        };
        Self {
            lines: vec![line; mission.chains.len()],
            any_lost: true,
        }
    }

    /// Takes in the strand of a chain that ends at the root, which hears `neighbours`.
    pub fn hear(&mut self, strand: &Strand, neighbours: &Neighbours, step: u64) {
        if let Some(line) = self.lines.get_mut(usize::from(strand.chain).wrapping_sub(1)) {
            // A robot leaves its chain of its own accord near to the root alone, in its sight.
            let is_lost = |robot: &ActorId| !strand.robots.contains(robot) && neighbours.get(*robot).is_none();
            self.any_lost |= line.robots.iter().any(is_lost);
            line.robots.clear();
            line.robots.extend_from_slice(&strand.robots);
            line.heard = step;
            line.cut = false;
        }
    }

    /// Notices where the end of a chain fell silent, and forgets what was not heard for long.
    pub fn watch_ends(&mut self, view: &View<'_>) {
        for line in &mut self.lines {
            let end_is_silent = line
                .robots
                .last()
                .is_some_and(|&end| view.neighbours.get(end).is_none());
            if !line.cut && end_is_silent {
                line.robots.pop();
                line.cut = true;
                // Before that one who was not heard may just not have been heard yet.
                self.any_lost |= view.step > view.parameters().silence_steps;
            }
            let parameters = view.parameters();
            if view.step - line.heard > parameters.healing_patience.min(parameters.strand_lifetime) {
                line.robots.clear();
            }
        }
    }

    /// Whether any robot fell silent in its place so far.
    #[must_use]
    pub const fn any_lost(&self) -> bool {
        self.any_lost
    }

    /// The robots of `chain`, worker first.
    #[must_use]
    pub fn robots(&self, chain: u8) -> &[ActorId] {
        &self.lines[usize::from(chain) - 1].robots
    }

    /// Whether `robot` is known to be in `chain`.
    #[must_use]
    pub fn has(&self, chain: u8, robot: ActorId) -> bool {
        let line = self.lines.get(usize::from(chain).wrapping_sub(1));
        line.is_some_and(|line| line.robots.contains(&robot))
    }

    /// The relays of `chain`: all its robots but the worker.
    #[must_use]
    pub fn relays(&self, chain: u8) -> usize {
        self.robots(chain).len().saturating_sub(1)
    }

    /// A chain to be expanded whose end fell silent while others are left beyond.
    #[must_use]
    pub fn cut(&self, view: &View<'_>) -> Option<u8> {
        let lines = (1..).zip(&self.lines);
        let mut cut = lines.filter(|(chain, line)| line.cut && !line.robots.is_empty() && view.expands(*chain));
        cut.next().map(|(chain, _)| chain)
    }

    /// Puts `robot` at the end of `chain`.
    pub fn append(&mut self, chain: u8, robot: ActorId, step: u64) {
        let line = &mut self.lines[usize::from(chain) - 1];
        line.robots.push(robot);
        line.heard = step;
        line.cut = false;
    }

    /// Gives those of `chain` time to be heard.
    pub fn expect(&mut self, chain: u8, step: u64) {
        self.lines[usize::from(chain) - 1].heard = step;
    }

    /// A target to be expanded of which nobody is left: nothing is heard of its worker, nor for long of anybody who
    /// could come in from farther out and take over.
    #[must_use]
    pub fn abandoned(&self, view: &View<'_>) -> Option<u8> {
        let parameters = view.parameters();
        let is_gone = |line: &Line| {
            line.robots.is_empty() && view.step - line.heard > parameters.join_timeout + parameters.silence_steps
        };
        (0..).zip(&view.mission.targets).find_map(|(target, plan)| {
            let mut lines = plan.chains.clone().map(|chain| &self.lines[usize::from(chain) - 1]);
            let abandoned = view.order.expands(target) && lines.all(is_gone) && view.worker_of(target).is_none();
            abandoned.then_some(target)
        })
    }

    /// Whether all chains to `target` are complete and say that it is reached.
    #[must_use]
    pub fn hold(&self, view: &View<'_>, target: u8) -> bool {
        view.mission.targets[usize::from(target)].chains.clone().all(|chain| {
            let last = self.robots(chain).last().and_then(|&robot| view.neighbours.get(robot));
            self.robots(chain).len() > view.mission.chain(chain).relays && last.is_some_and(|last| !last.status.need)
        })
    }
}
