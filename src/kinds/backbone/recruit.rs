//! Recruiting: how a robot at the root's end of a chain wins a free robot as its new parent.
//!
//! Only a robot whose parent is the root recruits, so chains are fed at the root and pushed outwards. It asks one free
//! robot, again and again until there is an answer. The robot that accepts comes as a *joiner*: it knows its child, but
//! the child keeps the root as its parent until the joiner is in place and its strand names the child. Then the child's
//! own strand names the joiner, by which it knows that it is linked. Whatever is lost on the way, each end undoes its
//! half after a time without a sign from the other.

use crate::engine::ActorId;
use crate::geometry::{Vec2, direction};

use super::heal::{self, Break};
use super::message::{Message, Request, Role, Strand};
use super::mission::Chain;
use super::neighbours::Neighbour;
use super::strand;
use super::view::View;

/// How far ahead of the root, towards its child, a joiner must be before it takes its place, as a share of its chain's
/// spring length: from behind the root, springs would push it the wrong way.
const AHEAD: f64 = 0.15;

/// How far behind its child a joiner goes, as a share of its chain's spring length: less than all of it, for the child
/// moves on, and a joiner that is farther out has less of the cluster to get through.
const BEHIND: f64 = 0.5;

/// A robot's place for one parent. A worker has one a link, a networker has one.
#[derive(Debug)]
pub struct Slot {
    /// The chain, from 1.
    pub chain: u8,
    /// The parent, at first the root.
    pub parent: ActorId,
    /// The robots from the root to the parent, as last heard.
    pub strand: Vec<ActorId>,
    /// The control step at which it was heard, or from which on it is waited for.
    heard: Option<u64>,
    /// Set from the loss of a parent until there is another one.
    pub broken: Option<Break>,
    /// Where the parent was when it was last heard.
    seen: Option<Vec2>,
    /// Who was asked to become the parent in the root's stead.
    invitation: Option<Invitation>,
}

#[derive(Clone, Copy, Debug)]
struct Invitation {
    to: ActorId,
    kind: Kind,
    sequence: u8,
    /// Whether it was accepted.
    accepted: bool,
    /// The control step of the request, and then of the last sign of the one who accepted.
    sign: u64,
}

/// What a robot is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// A free robot: to come and join.
    Join,
    /// A networker at the other end of a break: to bridge it.
    Adopt,
}

/// What a robot remembers about recruiting, over all its slots.
#[derive(Debug, Default)]
pub struct Recruiter {
    sequence: u8,
    /// Robots asked lately, and the control step until which they are not asked again.
    asked: Vec<(ActorId, u64)>,
}

impl Recruiter {
    /// The known free robot nearest to `place` that was not asked lately.
    pub fn candidate(&mut self, view: &View<'_>, place: Vec2) -> Option<ActorId> {
        self.asked.retain(|(_, until)| *until > view.step);
        view.neighbours
            .iter()
            .filter(|known| known.status.role == Role::Free && !self.was_asked(known.id))
            .min_by(|a, b| {
                let distance = |position: Vec2| (position - place).norm_squared();
                let nearer = distance(a.position).total_cmp(&distance(b.position));
                nearer.then(a.id.cmp(&b.id))
            })
            .map(|known| known.id)
    }

    /// The robot that can serve as a parent in `chain` and is farthest from the root, but for those asked lately: the farther out it is, the less the chain need come in.
    fn bridge(&mut self, view: &View<'_>, chain: u8, descendants: Option<&[ActorId]>) -> Option<ActorId> {
        self.asked.retain(|(_, until)| *until > view.step);
        view.neighbours
            .iter()
            .filter(|known| heal::can_serve(view, known, chain, descendants) && !self.was_asked(known.id))
            .max_by(|a, b| {
                let distance = |position: Vec2| (position - view.mission.origin).norm_squared();
                let farther = distance(a.position).total_cmp(&distance(b.position));
                farther.then(b.id.cmp(&a.id))
            })
            .map(|known| known.id)
    }

    fn was_asked(&self, robot: ActorId) -> bool {
        self.asked.iter().any(|(id, _)| *id == robot)
    }

    /// The number of a new request to `to`, which is not asked again for `memory` control steps.
    pub fn number(&mut self, view: &View<'_>, to: ActorId, memory: u64) -> u8 {
        self.sequence = self.sequence.wrapping_add(1);
        self.asked.push((to, view.step + memory));
        self.sequence
    }

    fn invite(&mut self, view: &View<'_>, to: ActorId, kind: Kind) -> Invitation {
        let parameters = view.parameters();
        let memory = match kind {
            Kind::Join => parameters.refusal_memory,
            // The other end of a break may not have noticed yet: it is asked again soon.
            Kind::Adopt => parameters.request_patience,
        };
        Invitation {
            to,
            kind,
            sequence: self.number(view, to, memory),
            accepted: false,
            sign: view.step,
        }
    }
}

impl Slot {
    /// A slot of chain number `chain` whose parent is the root.
    #[must_use]
    pub fn new(chain: u8, root: ActorId) -> Self {
        Self {
            chain,
            parent: root,
            strand: vec![root],
            heard: None,
            broken: None,
            seen: None,
            invitation: None,
        }
    }

    /// A slot of chain number `chain` whose parent was lost, last heard at `place` if it ever was.
    #[must_use]
    pub fn broken(chain: u8, root: ActorId, place: Option<Vec2>) -> Self {
        Self {
            broken: Some(Break { place, offer: None }),
            ..Self::new(chain, root)
        }
    }

    /// Whether the slot's parent is the root.
    #[must_use]
    pub fn is_at_root(&self, view: &View<'_>) -> bool {
        self.parent == view.root
    }

    /// Has `root` in the place of the `old` one.
    pub fn follow(&mut self, old: ActorId, root: ActorId) {
        if self.parent == old {
            self.parent = root;
        }
        if let Some(first) = self.strand.first_mut().filter(|first| **first == old) {
            *first = root;
        }
    }

    /// Relays from the root to the parent, the parent included.
    #[must_use]
    pub fn relays(&self) -> usize {
        self.strand.len().saturating_sub(1)
    }

    /// Whether the robot is far enough from the root for a relay between the two.
    #[must_use]
    pub fn is_out_enough(&self, view: &View<'_>) -> bool {
        view.way_to_root().norm() >= view.parameters().recruit_ratio * view.mission.chain(self.chain).rest
    }

    /// Does what a control step asks for: drops what is over, mends a break, swaps in a joiner that is in place, and
    /// recruits where one is `wanted`. The `descendants` of a relay are those on the side of the worker.
    pub fn tend(
        &mut self,
        view: &View<'_>,
        wanted: bool,
        descendants: Option<&[ActorId]>,
        recruiter: &mut Recruiter,
        out: &mut Vec<Message>,
    ) {
        self.give_up_a_lost_parent(view);
        self.mend(view, descendants);
        self.settle_invitation(view, wanted);
        if self.invitation.is_none() {
            self.invite(view, wanted, descendants, recruiter);
        }
        if let Some(invitation) = self.invitation
            && view.has_turn(&view.parameters().request_turns)
        {
            out.push(Message::Request(invitation.request(self.chain)));
        }
    }

    /// A parent that is silent, or says that it serves this chain no more, is replaced by the root, from which it was
    /// recruited; where that is out of reach, the chain is broken.
    fn give_up_a_lost_parent(&mut self, view: &View<'_>) {
        let root = view.root;
        if self.parent == root {
            return;
        }
        let heard = *self.heard.get_or_insert(view.step);
        if view.step - heard > view.parameters().strand_lifetime {
            self.strand.clear();
        }
        match view.neighbours.get(self.parent) {
            Some(parent) if self.is_served_by(parent) => self.seen = Some(parent.position),
            Some(_) => *self = Self::broken(self.chain, root, None),
            None => *self = Self::broken(self.chain, root, self.seen),
        }
    }

    fn is_served_by(&self, parent: &Neighbour) -> bool {
        parent.status.role == Role::Networker && parent.status.chain == self.chain && !self.strand.is_empty()
    }

    /// Takes up an offer to become the parent.
    fn mend(&mut self, view: &View<'_>, descendants: Option<&[ActorId]>) {
        let Some(broken) = &mut self.broken else { return };
        broken.look_around(view);
        let offer = broken.offer.and_then(|robot| view.neighbours.get(robot));
        if let Some(parent) = offer.filter(|known| heal::can_serve(view, known, self.chain, descendants)) {
            let root = view.root;
            *self = Self::new(self.chain, root);
            self.link_to(parent.id, root);
        }
    }

    fn link_to(&mut self, parent: ActorId, root: ActorId) {
        self.parent = parent;
        self.strand = vec![root, parent];
        self.heard = None;
        self.broken = None;
        self.invitation = None;
    }

    /// Asks the other end of a break if one is in sight; at the root, asks a free robot if one is wanted.
    fn invite(&mut self, view: &View<'_>, wanted: bool, descendants: Option<&[ActorId]>, recruiter: &mut Recruiter) {
        if self.broken.is_some() {
            if let Some(other_end) = recruiter.bridge(view, self.chain, descendants) {
                self.invitation = Some(recruiter.invite(view, other_end, Kind::Adopt));
                return;
            }
            if view.way_to_root().norm() > view.parameters().critical {
                return;
            }
            self.broken = None;
        }
        if wanted {
            let place = joining_place(view.mission.origin, view.position, view.mission.chain(self.chain));
            self.invitation = recruiter
                .candidate(view, place)
                .map(|candidate| recruiter.invite(view, candidate, Kind::Join));
        }
    }

    /// Ends an invitation that has led to a parent or that has led to nothing.
    fn settle_invitation(&mut self, view: &View<'_>, wanted: bool) {
        let Some(invitation) = self.invitation else { return };
        if invitation.accepted && self.is_in_place(view, invitation.to) {
            self.link_to(invitation.to, view.root);
            return;
        }
        let parameters = view.parameters();
        let patience = if invitation.accepted {
            parameters.join_timeout
        } else {
            parameters.request_patience
        };
        let unwanted = match invitation.kind {
            Kind::Join => !wanted && !invitation.accepted,
            Kind::Adopt => self.broken.is_none(),
        };
        if view.step - invitation.sign > patience || unwanted {
            self.invitation = None;
        }
    }

    /// Whether `joiner` stands where it can take over: near to this robot, near to the root, and ahead of it.
    fn is_in_place(&self, view: &View<'_>, joiner: ActorId) -> bool {
        let Some(known) = view.neighbours.get(joiner) else {
            return false;
        };
        let parameters = view.parameters();
        let from_root = known.position - view.mission.origin;
        let ahead = from_root.dot(&direction(view.position - view.mission.origin));
        known.status.role == Role::Networker
            && known.status.chain == self.chain
            && (known.position - view.position).norm() <= parameters.safe
            && from_root.norm() <= parameters.gate
            && ahead >= AHEAD * view.mission.chain(self.chain).rest
    }

    /// Takes in that `sender` accepted request number `sequence`. Says whether that makes sense here.
    pub fn hear_accept(&mut self, sender: ActorId, sequence: u8, step: u64) -> bool {
        match &mut self.invitation {
            Some(invitation) if invitation.to == sender && invitation.sequence == sequence => {
                invitation.sign = step;
                match (invitation.kind, &mut self.broken) {
                    (Kind::Adopt, Some(broken)) => broken.offer = Some(sender),
                    _ => invitation.accepted = true,
                }
                true
            }
            // A repeated answer from one that is a parent already.
            _ => self.parent == sender,
        }
    }

    /// Takes in that `sender` refused request number `sequence`.
    pub fn hear_refuse(&mut self, sender: ActorId, sequence: u8) {
        let refused = |invitation: &Invitation| invitation.to == sender && invitation.sequence == sequence;
        if self.invitation.as_ref().is_some_and(refused) {
            self.invitation = None;
        }
    }

    /// Takes in the parent strand of `sender`. Says whether `sender` is a parent or a joiner of this slot.
    pub fn hear_parent_strand(&mut self, sender: ActorId, heard: &Strand, me: ActorId, step: u64) -> bool {
        let names_me = heard.chain == self.chain && heard.next == me;
        if sender == self.parent {
            // A strand that comes back to this robot is no way to the root: without one, the parent is given up.
            if heard.chain == 0 || names_me {
                self.heard = Some(step);
                if !strand::keep(&mut self.strand, &heard.robots, me) {
                    self.strand.clear();
                }
            }
            return true;
        }
        match (&mut self.invitation, &mut self.broken) {
            (Some(invitation), _) if names_me && invitation.to == sender && invitation.kind == Kind::Join => {
                invitation.accepted = true;
                invitation.sign = step;
                true
            }
            // The other end of the break, or a parent that was given up too early.
            (_, Some(broken)) if names_me => {
                broken.offer = Some(sender);
                true
            }
            _ => false,
        }
    }
}

impl Invitation {
    fn request(&self, chain: u8) -> Request {
        let Self { to, sequence, .. } = *self;
        match self.kind {
            Kind::Join => Request::Join { to, sequence, chain },
            Kind::Adopt => Request::Adopt { to, sequence, chain },
        }
    }
}

/// Where a joiner of `chain` goes: on the way from the root at `origin` to its child at `child`, well ahead of the root,
/// and over to its chain's lane, so that chains need not cross.
#[must_use]
pub fn joining_place(origin: Vec2, child: Vec2, chain: &Chain) -> Vec2 {
    let way = child - origin;
    let ahead = (way.norm() - BEHIND * chain.rest).clamp(2.0 * AHEAD * chain.rest, chain.rest);
    origin + direction(way) * ahead + chain.left() * chain.lane_at(ahead)
}
