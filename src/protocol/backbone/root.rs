//! The root: the end of all chains, which watches them grow and, when robots are too few for all, has one target after
//! another visited (paper algorithm 3).

use crate::engine::ActorId;

use super::message::{Message, Order, Role, Strand};
use super::mission::Mission;
use super::view::View;

/// The root's state.
#[derive(Debug)]
pub struct Root {
    /// The robots of each chain, worker first, as last heard from the chain's end at the root.
    chains: Vec<Vec<ActorId>>,
    /// What it ordered last.
    order: Order,
    /// Control steps for which too few robots were predicted without a break.
    short_for: u64,
    /// Control steps for which the only target expanded was held without a break.
    held_for: u64,
    /// Whether each target was visited.
    visited: Vec<bool>,
}

impl Root {
    /// A root that has heard of no chain yet.
    #[must_use]
    pub fn new(mission: &Mission) -> Self {
        Self {
            chains: vec![Vec::new(); mission.chains.len()],
            order: Order::default(),
            short_for: 0,
            held_for: 0,
            visited: vec![false; mission.targets.len()],
        }
    }

    /// Takes in the strand of a chain that ends here.
    pub fn hear_child_strand(&mut self, heard: &Strand, me: ActorId) {
        if heard.next == me
            && let Some(chain) = self.chains.get_mut(usize::from(heard.chain).wrapping_sub(1))
        {
            chain.clear();
            chain.extend_from_slice(&heard.robots);
        }
    }

    /// One control step: what is to be expanded from now on.
    pub fn control(&mut self, view: &View<'_>) -> Order {
        match self.order.only {
            None => self.watch_for_shortage(view),
            Some(target) => self.visit(view, target),
        }
        self.order
    }

    /// Predicts whether the robots will do; when they have not for long enough, keeps one target only: the one whose
    /// chains hold the most robots, so that those with the fewest are dismantled.
    fn watch_for_shortage(&mut self, view: &View<'_>) {
        self.short_for = if self.is_short(view) { self.short_for + 1 } else { 0 };
        if self.short_for > view.parameters().shortage_patience {
            let robots = |target: &usize| -> usize {
                let chains = view.mission.targets[*target].chains.clone();
                chains.map(|chain| self.chains[usize::from(chain) - 1].len()).sum()
            };
            // The first of the largest: max_by_key would take the last.
            let largest = (0..self.visited.len()).rev().max_by_key(robots);
            self.expand_only(largest.map(|target| target as u8));
        }
    }

    /// Whether the chains lack more relays than there are robots to become some: free ones and joiners.
    fn is_short(&self, view: &View<'_>) -> bool {
        let lacking: usize = view
            .mission
            .chains
            .iter()
            .zip(&self.chains)
            .map(|(plan, robots)| plan.relays.saturating_sub(robots.len().saturating_sub(1)))
            .sum();
        let to_come = view
            .neighbours
            .iter()
            .filter(|known| match known.status.role {
                Role::Free => true,
                Role::Networker => !self.has(known.status.chain, known.id),
                Role::Root | Role::Worker => false,
            })
            .count();
        lacking > to_come
    }

    fn has(&self, chain: u8, robot: ActorId) -> bool {
        let chain = self.chains.get(usize::from(chain).wrapping_sub(1));
        chain.is_some_and(|robots| robots.contains(&robot))
    }

    /// When `target` was held for long enough, has the next one visited.
    fn visit(&mut self, view: &View<'_>, target: u8) {
        self.held_for = if self.is_held(view, target) {
            self.held_for + 1
        } else {
            0
        };
        if self.held_for > view.parameters().visit {
            self.visited[usize::from(target)] = true;
            self.held_for = 0;
            if let Some(next) = self.visited.iter().position(|visited| !visited) {
                self.expand_only(Some(next as u8));
            }
        }
    }

    /// Whether all chains to `target` are complete and say that it is reached.
    fn is_held(&self, view: &View<'_>, target: u8) -> bool {
        view.mission.targets[usize::from(target)].chains.clone().all(|chain| {
            let robots = &self.chains[usize::from(chain) - 1];
            let last = robots.last().and_then(|&robot| view.neighbours.get(robot));
            robots.len() > view.mission.chain(chain).relays && last.is_some_and(|last| !last.status.need)
        })
    }

    fn expand_only(&mut self, only: Option<u8>) {
        self.order = Order {
            epoch: self.order.epoch.wrapping_add(1),
            only,
        };
    }

    /// The strand that it sends to all its children: itself.
    pub fn strands(me: ActorId, out: &mut Vec<Message>) {
        out.push(Message::ParentStrand(Strand {
            chain: 0,
            next: me,
            robots: vec![me],
        }));
    }
}
