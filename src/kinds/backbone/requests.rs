//! Requests and answers between robots, by role.

use crate::engine::ActorId;

use super::Backbone;
use super::duty::Duty;
use super::message::{Message, Request, Role};
use super::networker::Networker;
use super::recruit::Slot;
use super::view::Knowledge;
use super::worker::Worker;

impl Backbone {
    /// Takes in a request or an answer of `sender`; those to other robots say nothing here.
    pub(super) fn hear_request(&mut self, sender: ActorId, request: Request, out: &mut Vec<Message>) {
        match request {
            Request::Join { to, sequence, chain } if to == self.known.id => {
                out.push(Message::Request(self.answer(sender, sequence, chain)));
            }
            // One whose status was not heard yet would be missed at once: it will ask again.
            Request::Adopt { to, sequence, chain }
                if to == self.known.id && self.known.neighbours.get(sender).is_some() =>
            {
                out.push(Message::Request(self.answer_adopt(sender, sequence, chain)));
            }
            Request::Work { to, sequence, target } if to == self.known.id => {
                out.push(Message::Request(self.answer_work(sender, sequence, target)));
            }
            Request::Replace {
                to,
                sequence,
                chain,
                child,
                beyond,
            } if to == self.known.id => {
                let beyond = vec![child; usize::from(beyond)];
                out.push(Message::Request(self.answer_replace(sender, sequence, chain, beyond)));
            }
            Request::Accept { to, sequence } if to == self.known.id => self.hear_accept(sender, sequence, out),
            Request::Refuse { to, sequence } if to == self.known.id => {
                if let Duty::Root(root) = &mut self.duty {
                    root.hear_answer(sender, sequence, false, &self.known.mission, self.known.step);
                }
                for slot in self.duty.slots_mut() {
                    slot.hear_refuse(sender, sequence);
                }
            }
            Request::Release { to } if to == self.known.id => {
                if matches!(&self.duty, Duty::Networker(networker) if networker.is_released_by(sender)) {
                    self.become_free();
                }
            }
            Request::Order(order) if order.is_newer_than(self.known.order) => self.known.order = order,
            Request::Bid(bid) if self.known.mission.parameters.election.is_some() => {
                if let Some(root) = self.election.hear(bid, self.known.step) {
                    self.follow(root);
                }
            }
            _ => {}
        }
    }

    fn hear_accept(&mut self, sender: ActorId, sequence: u8, out: &mut Vec<Message>) {
        let step = self.known.step;
        if let Duty::Root(root) = &mut self.duty {
            root.hear_answer(sender, sequence, true, &self.known.mission, step);
            return;
        }
        let slots = self.duty.slots_mut();
        if !slots.iter_mut().any(|slot| slot.hear_accept(sender, sequence, step)) {
            out.push(Message::Request(Request::Release { to: sender }));
        }
    }

    fn answer_adopt(&mut self, sender: ActorId, sequence: u8, chain: u8) -> Request {
        match &mut self.duty {
            Duty::Networker(networker) => networker.hear_adopt(sender, sequence, chain, self.known.step),
            _ => Request::Refuse { to: sender, sequence },
        }
    }

    /// The answer to the root's request to work: a free robot does.
    fn answer_work(&mut self, sender: ActorId, sequence: u8, target: u8) -> Request {
        let mission = &self.known.mission;
        match &self.duty {
            Duty::Worker(worker) if worker.target == target => Request::Accept { to: sender, sequence },
            Duty::Free if usize::from(target) < mission.targets.len() => {
                self.duty = Duty::Worker(Worker::new(target, mission, self.known.root));
                self.previous = Role::Free;
                Request::Accept { to: sender, sequence }
            }
            _ => Request::Refuse { to: sender, sequence },
        }
    }

    /// The answer to the root's request to replace a lost robot of `chain`, `beyond` which so many are left: a free robot
    /// does. Their names it learns from their strands.
    fn answer_replace(&mut self, sender: ActorId, sequence: u8, chain: u8, beyond: Vec<ActorId>) -> Request {
        let Knowledge {
            mission, step, root, ..
        } = &self.known;
        match (&mut self.duty, beyond.last().copied()) {
            (Duty::Networker(networker), _) => networker.hear_replace(sender, sequence, chain),
            (Duty::Free, Some(child)) if mission.has_chain(chain) => {
                let slot = Slot::new(chain, *root);
                self.duty = Duty::Networker(Networker::waiting(slot, child, sequence, beyond, *step));
                self.previous = Role::Free;
                Request::Accept { to: sender, sequence }
            }
            _ => Request::Refuse { to: sender, sequence },
        }
    }

    /// The answer to a request to join: a free robot accepts the first one.
    fn answer(&mut self, sender: ActorId, sequence: u8, chain: u8) -> Request {
        match &mut self.duty {
            Duty::Networker(networker) => networker.hear_join(sender, sequence, chain, self.known.step),
            Duty::Free if self.known.mission.has_chain(chain) => {
                let joiner = Networker::new(chain, sender, sequence, self.known.root, self.known.step);
                self.duty = Duty::Networker(joiner);
                self.previous = Role::Free;
                Request::Accept { to: sender, sequence }
            }
            Duty::Free | Duty::Root(_) | Duty::Worker(_) => Request::Refuse { to: sender, sequence },
        }
    }
}
