//! The worker: visits a target, and stays linked to the root by as many chains as the target needs (paper algorithm 1,
//! eq. 10 to 13).

use crate::engine::ActorId;
use crate::geometry::Vec2;
use crate::protocol::steering::forces;

use super::free;
use super::heal;
use super::message::{Message, Strand};
use super::mission::Mission;
use super::recruit::{Recruiter, Slot};
use super::view::View;

/// A worker's state.
#[derive(Debug)]
pub struct Worker {
    /// Its target, an index into the mission's.
    pub target: u8,
    /// Its places for parents, one a link.
    pub slots: Vec<Slot>,
}

impl Worker {
    /// The worker of target number `target`, at first linked to the root itself by all its chains.
    #[must_use]
    pub fn new(target: u8, mission: &Mission, root: ActorId) -> Self {
        let chains = mission.targets[usize::from(target)].chains.clone();
        Self {
            target,
            slots: chains.map(|chain| Slot::new(chain, root)).collect(),
        }
    }

    /// The robot whose chain is that of `slot`, as the new worker of its target. Its other links are yet to be made.
    #[must_use]
    pub fn heir(slot: Slot, mission: &Mission, root: ActorId) -> Self {
        let target = mission.chain(slot.chain).target;
        let chains = mission.targets[usize::from(target)].chains.clone();
        let mut own = Some(slot);
        let slot_of = |chain| {
            own.take_if(|slot| slot.chain == chain)
                .unwrap_or_else(|| Slot::broken(chain, root, None))
        };
        Self {
            target,
            slots: chains.map(slot_of).collect(),
        }
    }

    /// Who else works for its target, nearer to it than this robot.
    #[must_use]
    pub fn better(&self, view: &View<'_>) -> Option<ActorId> {
        let at = view.mission.targets[usize::from(self.target)].at;
        let other = view.worker_of(self.target)?;
        let distances = (other.position - at)
            .norm_squared()
            .total_cmp(&(view.position - at).norm_squared());
        distances.then(other.id.cmp(&view.id)).is_lt().then_some(other.id)
    }

    /// Its first chain that has a relay, and so may be of use to another worker.
    pub fn into_slot(self, root: ActorId) -> Option<Slot> {
        self.slots.into_iter().find(|slot| slot.parent != root)
    }

    /// The first of its chains.
    #[must_use]
    pub fn first_chain(&self) -> u8 {
        self.slots.first().map_or(0, |slot| slot.chain)
    }

    /// Parent need: whether it is sent out and its target not reached, or a link not by a chain of its own yet.
    #[must_use]
    pub fn need(&self, view: &View<'_>) -> bool {
        let on_the_way = self.way_to_target(view).norm() > view.parameters().threshold;
        view.order.expands(self.target) && (on_the_way || self.slots.iter().any(|slot| lacks_relay(slot, view)))
    }

    fn way_to_target(&self, view: &View<'_>) -> Vec2 {
        view.mission.targets[usize::from(self.target)].at - view.position
    }

    /// One control step: recruits where a link needs it, and answers with the velocity that it wants.
    pub fn control(&mut self, view: &View<'_>, recruiter: &mut Recruiter, out: &mut Vec<Message>) -> Vec2 {
        let need = self.need(view);
        for slot in &mut self.slots {
            let wanted = need && lacks_relay(slot, view) && slot.is_out_enough(view);
            slot.tend(view, wanted, None, recruiter, out);
        }
        if !view.order.expands(self.target) {
            self.retreating(view)
        } else if let Some(broken) = self.slots.iter().find_map(|slot| slot.broken.as_ref()) {
            self.bridging(view, broken.way(view))
        } else {
            self.advancing(view)
        }
    }

    /// Makes for the other end of a break, and keeps the parents that it has.
    fn bridging(&self, view: &View<'_>, way: Vec2) -> Vec2 {
        let kept = self.slots.iter().filter(|slot| slot.broken.is_none());
        let ties = kept.filter_map(|slot| view.way_to(slot.parent));
        let desired = heal::velocity(view, way, ties);
        desired + avoidance(view, desired)
    }

    /// Makes for the target as far as the springs to its parents allow (paper eq. 10).
    fn advancing(&self, view: &View<'_>) -> Vec2 {
        let parameters = view.parameters();
        let pull = self.pull_of_parents(view);
        if pull.farthest >= parameters.critical {
            return pull.leash;
        }
        let open = forces::gate(pull.farthest, parameters.gate_opening(), parameters.gate);
        let to_target = forces::target(self.way_to_target(view), parameters.target_gain);
        let desired = pull.springs + to_target * open;
        desired + avoidance(view, desired) * open
    }

    /// Comes home along its chains, and then waits like a free robot.
    fn retreating(&self, view: &View<'_>) -> Vec2 {
        let parameters = view.parameters();
        let pull = self.pull_of_parents(view);
        if pull.farthest >= parameters.critical {
            return pull.leash;
        }
        let root = view.way_to_root();
        if root.norm() <= parameters.safe {
            return free::velocity(view);
        }
        let desired = root * parameters.spring_gain;
        desired + avoidance(view, desired)
    }

    fn pull_of_parents(&self, view: &View<'_>) -> Pull {
        let parameters = view.parameters();
        let mut pull = Pull::default();
        for (index, slot) in self.slots.iter().enumerate() {
            // The parents are a set (paper section 4.1): the root counts once, however many links still end there.
            let counted = self.slots[..index].iter().any(|earlier| earlier.parent == slot.parent);
            let Some(way) = view.way_to(slot.parent).filter(|_| !counted) else {
                continue;
            };
            let chain = view.mission.chain(slot.chain);
            // A relay in reserve comes close and does not push.
            let push = if slot.relays() > chain.relays {
                0.0
            } else {
                parameters.push_limit
            };
            let spring = forces::spring(way, chain.rest, parameters.spring_gain, push);
            pull.springs += spring;
            pull.farthest = pull.farthest.max(way.norm());
            if way.norm() >= parameters.critical {
                pull.leash += spring;
            }
        }
        pull
    }

    /// The strands that it sends to its parents, one a link.
    pub fn strands(&self, me: ActorId, out: &mut Vec<Message>) {
        let linked = self.slots.iter().filter(|slot| slot.broken.is_none());
        out.extend(linked.map(|slot| {
            Message::ChildStrand(Strand {
                chain: slot.chain,
                next: slot.parent,
                robots: [me].into(),
            })
        }));
    }
}

/// Whether `slot` still leads to the root itself and should lead to a relay.
fn lacks_relay(slot: &Slot, view: &View<'_>) -> bool {
    slot.is_at_root(view) && view.mission.chain(slot.chain).relays > 0
}

/// What a worker's parents do to it.
#[derive(Default)]
struct Pull {
    /// u^sd, the sum of all springs (paper eq. 11).
    springs: Vec2,
    /// u^p, the springs to parents that are at the critical distance or beyond.
    leash: Vec2,
    /// Distance of the farthest parent, metres.
    farthest: f64,
}

fn avoidance(view: &View<'_>, desired: Vec2) -> Vec2 {
    view.avoidance(desired, view.parameters().backbone_avoidance_range)
}
