//! The networker: a relay of one chain (paper algorithm 2, eq. 14 to 16).

use crate::engine::ActorId;
use crate::geometry::Vec2;
use crate::protocol::steering::forces;

use super::heal;
use super::message::{Message, Request, Strand};
use super::mission::Chain;
use super::recruit::{Recruiter, Slot, joining_place};
use super::strand;
use super::view::View;

/// A networker's state. Until its child's strand names it, it is a joiner on the way to its place.
#[derive(Debug)]
pub struct Networker {
    /// Its place for a parent.
    pub slot: Slot,
    /// The robot that recruited it.
    child: ActorId,
    /// Number of the request that it accepted.
    sequence: u8,
    /// Whether its child counts on it.
    linked: bool,
    /// The control step of the child's last sign that it does, or will.
    confirmed: u64,
    /// The robots from the worker to the child, as last heard; without the child while that is lost.
    outer: Vec<ActorId>,
    /// Set while its child is lost.
    orphan: Option<Orphan>,
    /// Where the child was when it was last heard.
    seen: Option<Vec2>,
}

/// A networker whose child is lost: it is the other end of a break.
#[derive(Clone, Copy, Debug)]
struct Orphan {
    /// The control step from which on.
    since: u64,
    /// Whether one beyond the break was heard to have another parent.
    bypassed: bool,
}

impl Orphan {
    const fn since(step: u64) -> Self {
        Self {
            since: step,
            bypassed: false,
        }
    }
}

impl Networker {
    /// A joiner that accepted request number `sequence` of `child` at control step `step`.
    #[must_use]
    pub fn new(chain: u8, child: ActorId, sequence: u8, root: ActorId, step: u64) -> Self {
        Self {
            slot: Slot::new(chain, root),
            child,
            sequence,
            linked: false,
            confirmed: step,
            outer: Vec::new(),
            orphan: None,
            seen: None,
        }
    }

    /// The end of a break, at control step `step`: it has the parent of `slot`, and waits for `child`, beyond which it
    /// knows `outer`.
    #[must_use]
    pub fn waiting(slot: Slot, child: ActorId, sequence: u8, outer: Vec<ActorId>, step: u64) -> Self {
        Self {
            slot,
            child,
            sequence,
            linked: true,
            confirmed: step,
            outer,
            orphan: Some(Orphan::since(step)),
            seen: None,
        }
    }

    /// Answers a request to replace a lost robot: the one that it accepted it accepts again.
    pub fn hear_replace(&mut self, sender: ActorId, sequence: u8, chain: u8) -> Request {
        if self.orphan.is_some() && self.slot.parent == sender && self.sequence == sequence && self.slot.chain == chain
        {
            Request::Accept { to: sender, sequence }
        } else {
            Request::Refuse { to: sender, sequence }
        }
    }

    /// Answers a request to join: the one that it accepted it accepts again, for its answer may have been lost.
    pub fn hear_join(&mut self, sender: ActorId, sequence: u8, chain: u8, step: u64) -> Request {
        if sender != self.child || chain != self.slot.chain {
            return Request::Refuse { to: sender, sequence };
        }
        self.sequence = sequence;
        self.confirmed = step;
        Request::Accept { to: sender, sequence }
    }

    /// Answers a request to adopt: it serves whoever asks while its child is lost, and its child again and again.
    pub fn hear_adopt(&mut self, sender: ActorId, sequence: u8, chain: u8, step: u64) -> Request {
        let is_ahead = sender == self.slot.parent || self.slot.strand.contains(&sender);
        let is_welcome = self.linked && (self.orphan.is_some() || sender == self.child);
        if chain != self.slot.chain || is_ahead || !is_welcome {
            return Request::Refuse { to: sender, sequence };
        }
        if sender != self.child {
            self.outer = vec![sender];
        }
        self.child = sender;
        self.orphan = None;
        self.confirmed = step;
        Request::Accept { to: sender, sequence }
    }

    /// Takes in a child strand: if it is the child's and names `me`, the two are linked.
    pub fn hear_child_strand(&mut self, sender: ActorId, heard: &Strand, me: ActorId, step: u64) {
        if heard.chain != self.slot.chain {
            return;
        }
        if sender == self.child && heard.next == me {
            if strand::keep(&mut self.outer, &heard.robots, me) {
                self.linked = true;
                self.orphan = None;
                self.confirmed = step;
            }
        } else if let Some(orphan) = &mut self.orphan
            && heard.next != me
            // One that names the lost child has not missed it yet.
            && heard.next != self.child
            && self.outer.contains(&sender)
        {
            orphan.bypassed = true;
        }
    }

    /// Whether it holds its place, with a child and a parent that it counts on.
    #[must_use]
    pub const fn is_settled(&self) -> bool {
        self.linked && self.orphan.is_none() && self.slot.broken.is_none()
    }

    /// Whether a release by `sender` frees it.
    #[must_use]
    pub fn is_released_by(&self, sender: ActorId) -> bool {
        sender == self.child
    }

    /// Whether the chain has no use for it any more: its child does not count on it, or is lost for long with nobody
    /// else to count on it, or the chain is dismantled and it has come home behind its child.
    #[must_use]
    pub fn is_done(&self, view: &View<'_>) -> bool {
        let parameters = view.parameters();
        let patience = match self.orphan {
            Some(_) => parameters.healing_patience,
            // Longer than a child's silence lasts that is not noticed yet.
            None if self.linked => (parameters.join_timeout + parameters.silence_steps).min(parameters.strand_lifetime),
            None => parameters.join_timeout,
        };
        if view.step - self.confirmed > patience || self.orphan.is_some_and(|orphan| orphan.bypassed) {
            return true;
        }
        let is_home = |place: Vec2| (place - view.mission.origin).norm() <= view.parameters().safe;
        let child = view.neighbours.get(self.child);
        !view.expands(self.slot.chain)
            && is_home(view.position)
            && child.is_none_or(|child| is_home(child.position) || child.status.chain != self.slot.chain)
    }

    /// Whether it is the one to take over from its lost worker: the worker was its child, or whoever was between is
    /// lost for long too, and nobody else is heard to have done so. Of the networkers of several links the nearest to the
    /// target does, at once.
    #[must_use]
    pub fn is_heir(&self, view: &View<'_>) -> bool {
        let Some(orphan) = self.orphan else { return false };
        let chain = self.slot.chain;
        let target = view.mission.chain(chain).target;
        let patience = if self.outer.is_empty() {
            view.parameters().precedence * view.networkers_nearer_to(target) as u64
        } else {
            view.parameters().healing_patience
        };
        view.step - orphan.since >= patience && view.expands(chain) && view.worker_of(target).is_none()
    }

    /// The need that it passes on: its child's, and its own while it makes up for a lost one.
    #[must_use]
    pub fn need(&self, view: &View<'_>) -> bool {
        match self.orphan {
            Some(_) => !self.outer.is_empty(),
            None => self.linked && view.neighbours.get(self.child).is_some_and(|child| child.status.need),
        }
    }

    /// Notices that the child is lost.
    pub fn watch_child(&mut self, view: &View<'_>) {
        if !self.linked {
            return;
        }
        if let Some(child) = view.neighbours.get(self.child) {
            self.seen = Some(child.position);
        } else if self.orphan.is_none() {
            self.orphan = Some(Orphan::since(view.step));
            if self.outer.last() == Some(&self.child) {
                self.outer.pop();
            }
        }
    }

    /// One control step: recruits where the chain must grow, and answers with the velocity that it wants.
    pub fn control(&mut self, view: &View<'_>, recruiter: &mut Recruiter, out: &mut Vec<Message>) -> Vec2 {
        let wanted = self.wants_parent(view);
        self.slot.tend(view, wanted, Some(&self.outer), recruiter, out);
        if !self.linked {
            self.joining(view)
        } else if !view.expands(self.slot.chain) {
            self.retreating(view)
        } else if self.slot.broken.is_some() || self.orphan.is_some() {
            self.bridging(view)
        } else {
            self.holding(view)
        }
    }

    /// Whether the chain needs a relay between this robot and the root.
    fn wants_parent(&self, view: &View<'_>) -> bool {
        let chain = view.mission.chain(self.slot.chain);
        let relays = self.relays_outwards();
        self.slot.is_at_root(view)
            && (relays < chain.relays && self.need(view)
                || relays >= chain.relays && relays < view.relays_wanted(self.slot.chain))
            && view.expands(self.slot.chain)
            && self.slot.is_out_enough(view)
    }

    /// Relays from this one to the worker, this one included: as many as the strand has robots, the worker and the relays
    /// up to the child.
    const fn relays_outwards(&self) -> usize {
        self.outer.len()
    }

    /// Heads for its place beside its child.
    fn joining(&self, view: &View<'_>) -> Vec2 {
        let parameters = view.parameters();
        let Some(child) = view.neighbours.get(self.child) else {
            return Vec2::zeros();
        };
        let place = joining_place(view.mission.origin, child.position, view.mission.chain(self.slot.chain));
        let desired = (place - view.position) * parameters.spring_gain;
        desired + self.avoidance(view, desired)
    }

    /// Keeps its distance from parent and child (paper eq. 14).
    fn holding(&self, view: &View<'_>) -> Vec2 {
        let parameters = view.parameters();
        let chain = view.mission.chain(self.slot.chain);
        let Some(parent) = view.way_to(self.slot.parent) else {
            return Vec2::zeros();
        };
        let spring = |way, rest| forces::spring(way, rest, parameters.spring_gain, parameters.push_limit);
        // Between the root and the parent, this one, and from here to the worker.
        let springs = chain.springs(self.slot.relays() + self.relays_outwards());
        let to_parent = spring(parent, springs.between);
        if parent.norm() >= parameters.critical {
            return to_parent;
        }
        let child = view.way_to(self.child);
        let to_child = child.map_or_else(Vec2::zeros, |way| {
            let is_last = self.relays_outwards() == 1;
            spring(way, if is_last { springs.last } else { springs.between })
        });
        let desired = to_parent + to_child + lane_pull(view, chain);
        let shorter = child.map_or(f64::INFINITY, |child| child.norm()).min(parent.norm());
        let open = forces::gate(shorter, parameters.gate_opening(), parameters.gate);
        desired + self.avoidance(view, desired) * open
    }

    /// Makes for the other end of a break, and keeps the neighbour that it has.
    fn bridging(&self, view: &View<'_>) -> Vec2 {
        let (way, tie) = if let Some(broken) = &self.slot.broken {
            (broken.way(view), view.way_to(self.child))
        } else {
            let first = || view.mission.chain(self.slot.chain).first_place(view.mission.origin);
            let place = self.seen.unwrap_or_else(first);
            (place - view.position, view.way_to(self.slot.parent))
        };
        let desired = heal::velocity(view, way, tie.into_iter());
        desired + self.avoidance(view, desired)
    }

    /// Comes home ahead of its child, never so fast that the child falls behind.
    fn retreating(&self, view: &View<'_>) -> Vec2 {
        let parameters = view.parameters();
        let behind = view.way_to(self.child).map_or(0.0, |child| child.norm());
        let open = forces::gate(behind, parameters.safe, parameters.gate);
        let home = forces::spring(
            view.way_to_root(),
            AT_HOME * parameters.safe,
            parameters.spring_gain,
            0.0,
        );
        let desired = home * open;
        desired + self.avoidance(view, desired)
    }

    fn avoidance(&self, view: &View<'_>, desired: Vec2) -> Vec2 {
        let parameters = view.parameters();
        let range = if self.is_settled() {
            parameters.backbone_avoidance_range
        } else {
            parameters.avoidance_range
        };
        view.avoidance(desired, range)
    }

    /// The strands that it sends: to its child the way to the root, to its parent the way to the worker.
    pub fn strands(&self, me: ActorId, out: &mut Vec<Message>) {
        out.push(Message::ParentStrand(Strand {
            chain: self.slot.chain,
            next: self.child,
            robots: strand::passed_on(&self.slot.strand, me),
        }));
        // The robot that it names would take it for linked.
        if self.linked && self.slot.broken.is_none() {
            out.push(Message::ChildStrand(Strand {
                chain: self.slot.chain,
                next: self.slot.parent,
                robots: strand::passed_on(&self.outer, me),
            }));
        }
    }
}

/// How near to the root a retreating robot comes, in safe distances: near enough to be home.
const AT_HOME: f64 = 0.9;

fn lane_pull(view: &View<'_>, chain: &Chain) -> Vec2 {
    let parameters = view.parameters();
    let place = -view.way_to_root();
    let left = chain.left();
    let offset = chain.lane_at(place.dot(&chain.forward)) - place.dot(&left);
    forces::lane_pull(offset, left, parameters.lane_gain, parameters.lane_limit)
}
