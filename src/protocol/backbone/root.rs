//! The root: the end of all chains, which watches them grow, appoints a worker where a target has none left, and, when
//! robots are too few for all, has one target after another visited (paper algorithm 3).

use crate::engine::ActorId;
use crate::geometry::Vec2;

use super::message::{Message, Order, Request, Role, Strand};
use super::mission::Mission;
use super::recruit::Recruiter;
use super::view::View;

/// The root's state.
#[derive(Debug)]
pub struct Root {
    /// What it knows of each chain.
    lines: Vec<Line>,
    /// The robot that it asked to fill a place.
    appointment: Option<Appointment>,
    /// What it ordered last.
    order: Order,
    /// Control steps for which too few robots were predicted without a break.
    short_for: u64,
    /// Control steps for which the only target expanded was held without a break.
    held_for: u64,
    /// Whether each target was visited.
    visited: Vec<bool>,
}

/// A chain as the root knows it.
#[derive(Clone, Debug, Default)]
struct Line {
    /// Its robots, worker first, as last heard from its end at the root, without those that fell silent there since.
    robots: Vec<ActorId>,
    /// The control step at which it was heard last.
    heard: u64,
    /// Whether its end at the root fell silent since.
    cut: bool,
}

#[derive(Clone, Copy, Debug)]
struct Appointment {
    to: ActorId,
    sequence: u8,
    vacancy: Vacancy,
    /// The control step of the request.
    since: u64,
}

/// A place that a free robot must fill.
#[derive(Clone, Copy, Debug)]
enum Vacancy {
    /// That of the worker of a target.
    Worker(u8),
    /// That next to the root in a chain.
    End(u8),
}

impl Vacancy {
    /// Where the robot that fills it has to go first.
    fn place(self, mission: &Mission) -> Vec2 {
        match self {
            Self::Worker(target) => mission.targets[usize::from(target)].at,
            Self::End(chain) => mission.chain(chain).first_place(mission.origin),
        }
    }
}

impl Root {
    /// A root that has heard of no chain yet.
    #[must_use]
    pub fn new(mission: &Mission) -> Self {
        Self {
            lines: vec![Line::default(); mission.chains.len()],
            appointment: None,
            order: Order::default(),
            short_for: 0,
            held_for: 0,
            visited: vec![false; mission.targets.len()],
        }
    }

    /// Takes in the strand of a chain that ends here.
    pub fn hear_child_strand(&mut self, heard: &Strand, me: ActorId, step: u64) {
        if heard.next == me
            && let Some(line) = self.lines.get_mut(usize::from(heard.chain).wrapping_sub(1))
        {
            line.robots.clear();
            line.robots.extend_from_slice(&heard.robots);
            line.heard = step;
            line.cut = false;
        }
    }

    /// Takes in that `sender` answered request number `sequence`: it fills the place, or another one must be asked.
    pub fn hear_answer(&mut self, sender: ActorId, sequence: u8, accepted: bool, mission: &Mission, step: u64) {
        let is_it = |asked: &mut Appointment| asked.to == sender && asked.sequence == sequence;
        let Some(asked) = self.appointment.take_if(is_it).filter(|_| accepted) else {
            return;
        };
        match asked.vacancy {
            Vacancy::Worker(target) => {
                for chain in mission.targets[usize::from(target)].chains.clone() {
                    self.lines[usize::from(chain) - 1].heard = step;
                }
            }
            Vacancy::End(chain) => {
                let line = &mut self.lines[usize::from(chain) - 1];
                line.robots.push(sender);
                line.heard = step;
                line.cut = false;
            }
        }
    }

    /// One control step: what is to be expanded from now on.
    pub fn control(&mut self, view: &View<'_>, recruiter: &mut Recruiter, out: &mut Vec<Message>) -> Order {
        self.watch_ends(view);
        match self.order.only {
            None => self.watch_for_shortage(view),
            Some(target) => self.visit(view, target),
        }
        self.appoint(view, recruiter, out);
        self.order
    }

    /// Notices where the end of a chain fell silent, and forgets what was not heard for long.
    fn watch_ends(&mut self, view: &View<'_>) {
        for line in &mut self.lines {
            let end_is_silent = line
                .robots
                .last()
                .is_some_and(|&end| view.neighbours.get(end).is_none());
            if !line.cut && end_is_silent {
                line.robots.pop();
                line.cut = true;
            }
            if view.step - line.heard > view.parameters().healing_patience {
                line.robots.clear();
            }
        }
    }

    /// Asks a free robot to fill a place that a failure left empty.
    fn appoint(&mut self, view: &View<'_>, recruiter: &mut Recruiter, out: &mut Vec<Message>) {
        let parameters = view.parameters();
        let is_over = |asked: &Appointment| view.step - asked.since > parameters.request_patience;
        if self.appointment.as_ref().is_some_and(is_over) {
            self.appointment = None;
        }
        if self.appointment.is_none()
            && let Some(vacancy) = self.vacancy(view)
            && let Some(to) = recruiter.candidate(view, vacancy.place(view.mission))
        {
            self.appointment = Some(Appointment {
                to,
                sequence: recruiter.number(view, to, parameters.refusal_memory),
                vacancy,
                since: view.step,
            });
        }
        if let Some(asked) = self.appointment
            && view.turn().is_multiple_of(parameters.request_every)
        {
            out.extend(self.request(asked).map(Message::Request));
        }
    }

    fn request(&self, asked: Appointment) -> Option<Request> {
        let Appointment { to, sequence, .. } = asked;
        match asked.vacancy {
            Vacancy::Worker(target) => Some(Request::Work { to, sequence, target }),
            Vacancy::End(chain) => {
                let beyond = &self.lines[usize::from(chain) - 1].robots;
                beyond.last().map(|&child| Request::Replace {
                    to,
                    sequence,
                    chain,
                    child,
                    beyond: beyond.len() as u8,
                })
            }
        }
    }

    fn vacancy(&self, view: &View<'_>) -> Option<Vacancy> {
        let open = |chain: &u8| {
            let line = &self.lines[usize::from(*chain) - 1];
            line.cut && !line.robots.is_empty() && view.expands(*chain)
        };
        let end = (1..=self.lines.len() as u8).find(open).map(Vacancy::End);
        end.or_else(|| self.abandoned(view).map(Vacancy::Worker))
    }

    /// A target to be expanded of which nobody is left: nothing is heard of its worker, nor for long of anybody who
    /// could come in from farther out and take over.
    fn abandoned(&self, view: &View<'_>) -> Option<u8> {
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

    /// Predicts whether the robots will do; when they have not for long enough, keeps one target only: the one whose
    /// chains hold the most robots, so that those with the fewest are dismantled.
    fn watch_for_shortage(&mut self, view: &View<'_>) {
        self.short_for = if self.is_short(view) { self.short_for + 1 } else { 0 };
        if self.short_for > view.parameters().shortage_patience {
            let robots = |target: &usize| -> usize {
                let chains = view.mission.targets[*target].chains.clone();
                chains
                    .map(|chain| self.lines[usize::from(chain) - 1].robots.len())
                    .sum()
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
            .zip(&self.lines)
            .map(|(plan, line)| plan.relays.saturating_sub(line.robots.len().saturating_sub(1)))
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
        let line = self.lines.get(usize::from(chain).wrapping_sub(1));
        line.is_some_and(|line| line.robots.contains(&robot))
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
            let robots = &self.lines[usize::from(chain) - 1].robots;
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
