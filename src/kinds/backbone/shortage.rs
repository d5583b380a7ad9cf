//! Too few robots (paper algorithm 3): the root has the chains with the fewest robots dismantled, so that the others can
//! be completed, and when those have been held, has the targets left out visited in their stead.
//!
//! The paper says it in two ways. Its algorithm and its section on the root have the chain with the fewest robots
//! dismantled whenever too few are predicted, and the others expanded; its conclusions speak of "constructing a single full
//! chain, and visiting one target at a time". This is the algorithm, asked again until the others can be completed. Where
//! robots do for one target alone it comes to what the conclusions say; where they do for more, several targets are held
//! at once, and none is visited later for it.
//!
//! The root also orders the reserve, where the scenario has one (ours): relays beyond the fewest, from the first lost robot on.

use std::cmp::Reverse;

use super::lines::Lines;
use super::message::{Order, Role, Status, TargetSet};
use super::view::View;

/// What the root remembers of its orders.
#[derive(Debug)]
pub struct Shortage {
    /// What it ordered last.
    order: Order,
    /// Control steps for which the robots were too few for all that is expanded, without a break.
    short_for: u64,
    /// Control steps for which the robots would have done for all targets, without a break.
    ample_for: u64,
    /// Control steps for which the robots were too few for the reserve that is ordered, without a break.
    reserve_short_for: u64,
    /// Control steps for which each target was held without a break.
    held_for: Vec<u64>,
    /// Whether each target was ever held for long enough.
    visited: Vec<bool>,
}

impl Shortage {
    /// The start: everything is expanded.
    #[must_use]
    pub fn new(targets: usize) -> Self {
        Self {
            order: Order::default(),
            short_for: 0,
            ample_for: 0,
            reserve_short_for: 0,
            held_for: vec![0; targets],
            visited: vec![false; targets],
        }
    }

    /// The state in which `order` was given already.
    #[must_use]
    pub fn going_on_from(order: Order, targets: usize) -> Self {
        Self {
            order,
            ..Self::new(targets)
        }
    }

    /// One control step: what is to be expanded from now on.
    pub fn control(&mut self, view: &View<'_>, lines: &Lines) -> Order {
        self.watch_visits(view, lines);
        let stock = Stock::of(view, lines, self.order);
        let patience = view.parameters().shortage_patience;
        self.order_reserve(view, lines, &stock);
        let is_left_out = |target: &usize| !self.order.expands(*target as u8);
        count(&mut self.short_for, stock.lacking() > stock.to_come);
        count(&mut self.ample_for, stock.needed() <= stock.relays());
        if self.order.dismantled.is_empty() {
            self.ample_for = 0;
        }
        if self.short_for > patience {
            self.retrench(&stock);
        } else if self.ample_for > patience {
            self.give(TargetSet::default());
        } else if let Some(next) = (0..self.visited.len())
            .filter(is_left_out)
            .find(|&target| !self.visited[target])
            && self.expanded().all(|target| self.visited[target])
        {
            self.advance(next, &stock);
        }
        self.order
    }

    /// From the first lost robot on chains get relays in reserve, as many as the robots are enough for; fewer once they
    /// were not enough for long.
    fn order_reserve(&mut self, view: &View<'_>, lines: &Lines, stock: &Stock) {
        let parameters = view.parameters();
        let most = if lines.any_lost() { parameters.reserve } else { 0 };
        let affordable = (0..=most).rev().find(|&reserve| stock.affords(reserve)).unwrap_or(0);
        count(&mut self.reserve_short_for, affordable < self.order.reserve);
        if affordable > self.order.reserve || self.reserve_short_for > parameters.shortage_patience {
            self.order = Order {
                epoch: self.order.epoch.wrapping_add(1),
                reserve: affordable,
                ..self.order
            };
            self.reserve_short_for = 0;
        }
    }

    fn expanded(&self) -> impl Iterator<Item = usize> {
        (0..self.visited.len()).filter(|&target| self.order.expands(target as u8))
    }

    fn watch_visits(&mut self, view: &View<'_>, lines: &Lines) {
        for target in 0..self.visited.len() {
            let is_held = self.order.expands(target as u8) && lines.hold(view, target as u8);
            count(&mut self.held_for[target], is_held);
            self.visited[target] |= self.held_for[target] > view.parameters().visit;
        }
    }

    /// Leaves out the targets with the fewest robots until the others can be completed, but for one.
    fn retrench(&mut self, stock: &Stock) {
        let mut order = self.order;
        let mut stock = stock.clone();
        while stock.lacking() > stock.to_come
            && stock.expanded().count() > 1
            && let Some(target) = self.least(&stock)
        {
            order.dismantled.insert(target as u8);
            stock.leave_out(target);
        }
        if order.dismantled != self.order.dismantled {
            self.give(order.dismantled);
        }
        self.short_for = 0;
    }

    /// Takes up target number `next`, in the stead of as many that were visited as it takes.
    fn advance(&mut self, next: usize, stock: &Stock) {
        let mut dismantled = self.order.dismantled;
        let mut stock = stock.clone();
        dismantled.remove(next as u8);
        let needs = stock.of_target(next).needs;
        while stock.lacking() + needs > stock.to_come
            && let Some(target) = self.least(&stock)
        {
            dismantled.insert(target as u8);
            stock.leave_out(target);
        }
        self.give(dismantled);
    }

    /// The first to be left out: visited ones before others, fewest robots before more, and the last of equals.
    fn least(&self, stock: &Stock) -> Option<usize> {
        stock
            .expanded()
            .min_by_key(|&target| (!self.visited[target], stock.of_target(target).has, Reverse(target)))
    }

    fn give(&mut self, dismantled: TargetSet) {
        self.order = Order {
            epoch: self.order.epoch.wrapping_add(1),
            dismantled,
            ..self.order
        };
        self.short_for = 0;
        self.ample_for = 0;
    }
}

/// Counts how long something `holds`.
fn count(steps: &mut u64, holds: bool) {
    *steps = if holds { *steps + 1 } else { 0 };
}

/// The relays that there are, target by target, and those that can still become some.
#[derive(Clone, Debug)]
struct Stock {
    targets: Vec<Relays>,
    /// Free robots, joiners, and the relays of targets left out.
    to_come: usize,
}

#[derive(Clone, Copy, Debug, Default)]
struct Relays {
    has: usize,
    needs: usize,
    lacks: usize,
    chains: usize,
    is_expanded: bool,
}

impl Stock {
    fn of(view: &View<'_>, lines: &Lines, order: Order) -> Self {
        let mut stock = Self {
            targets: vec![Relays::default(); view.mission.targets.len()],
            to_come: waiting(view, lines),
        };
        for (target, relays) in (0..).zip(&mut stock.targets) {
            relays.is_expanded = order.expands(target);
            for chain in view.mission.targets[usize::from(target)].chains.clone() {
                let has = lines.relays(chain);
                let needs = view.mission.chain(chain).relays;
                relays.has += has;
                relays.chains += 1;
                relays.needs += needs;
                relays.lacks += needs.saturating_sub(has);
            }
        }
        let left_out: usize = stock
            .targets
            .iter()
            .filter(|relays| !relays.is_expanded)
            .map(|relays| relays.has)
            .sum();
        stock.to_come += left_out;
        stock
    }

    fn of_target(&self, target: usize) -> Relays {
        self.targets[target]
    }

    fn expanded(&self) -> impl Iterator<Item = usize> {
        (0..self.targets.len()).filter(|&target| self.targets[target].is_expanded)
    }

    /// Relays that the expanded targets lack.
    fn lacking(&self) -> usize {
        self.expanded().map(|target| self.targets[target].lacks).sum()
    }

    /// Whether each chain of the expanded targets can have `reserve` relays more than it needs, and a robot for each
    /// target is left.
    fn affords(&self, reserve: u8) -> bool {
        let of_target = |target| {
            let relays: &Relays = &self.targets[target];
            relays.needs + relays.chains * usize::from(reserve) + 1
        };
        self.expanded().map(of_target).sum::<usize>() <= self.relays()
    }

    /// Relays that all targets need.
    fn needed(&self) -> usize {
        self.targets.iter().map(|relays| relays.needs).sum()
    }

    /// All robots that are or can become relays.
    fn relays(&self) -> usize {
        self.to_come + self.expanded().map(|target| self.targets[target].has).sum::<usize>()
    }

    fn leave_out(&mut self, target: usize) {
        self.targets[target].is_expanded = false;
        self.to_come += self.targets[target].has;
    }
}

/// Robots in sight that can become relays: free ones and joiners.
fn waiting(view: &View<'_>, lines: &Lines) -> usize {
    let can_come = |status: Status, id| match status.role {
        Role::Free => true,
        Role::Networker => !lines.has(status.chain, id),
        Role::Root | Role::Worker => false,
    };
    let in_sight = view.neighbours.iter();
    in_sight.filter(|known| can_come(known.status, known.id)).count()
}
