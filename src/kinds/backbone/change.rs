//! When a robot takes up or gives up a duty of its own accord, or by election.

use crate::engine::{ActorId, SimTime};
use crate::geometry::Vec2;

use super::Backbone;
use super::duty::Duty;
use super::isolated;
use super::message::{Message, Request};
use super::networker::Networker;
use super::root::Root;
use super::view::Knowledge;
use super::worker::Worker;

/// What is added to the bid of a relay, and twice to that of a worker, millimetres: more than any robot that still hears others is away.
const ENGAGED_MM: f64 = 20_000.0;

impl Backbone {
    /// Goes back to the cluster.
    pub(super) fn become_free(&mut self) {
        self.previous = self.duty.role();
        self.duty = Duty::Free;
    }

    /// Gives up a duty that is over, and takes over from a worker that is lost.
    pub(super) fn change_duty(&mut self, proximity: &[Vec2]) {
        let view = self.known.view(proximity);
        if view.is_isolated() {
            if isolated::must_be_deaf(&view) && matches!(self.duty, Duty::Networker(_) | Duty::Worker(_)) {
                self.become_free();
            }
            return;
        }
        match &mut self.duty {
            Duty::Networker(networker) => {
                networker.watch_child(&view);
                if networker.is_heir(&view) {
                    self.replace_duty(|duty, known| match duty {
                        Duty::Networker(networker) => {
                            Duty::Worker(Worker::heir(networker.slot, &known.mission, known.root))
                        }
                        other => other,
                    });
                } else if networker.is_done(&view) {
                    self.become_free();
                }
            }
            Duty::Worker(worker) => {
                if let Some(better) = worker.better(&view) {
                    self.replace_duty(|duty, known| match duty {
                        Duty::Worker(worker) => worker.into_slot(known.root).map_or(Duty::Free, |slot| {
                            Duty::Networker(Networker::waiting(slot, better, 0, Vec::new(), known.step))
                        }),
                        other => other,
                    });
                }
            }
            Duty::Free | Duty::Root(_) => {}
        }
    }

    fn replace_duty(&mut self, change: impl FnOnce(Duty, &Knowledge) -> Duty) {
        self.previous = self.duty.role();
        let old = std::mem::replace(&mut self.duty, Duty::Free);
        self.duty = change(old, &self.known);
    }

    /// One control step of electing, where the scenario has it.
    pub(super) fn elect(&mut self, now: SimTime, out: &mut Vec<Message>) {
        let Some(rules) = self.known.mission.parameters.election else {
            return;
        };
        let view = self.known.view(&[]);
        let distance = view.way_to_root().norm();
        let is_root = matches!(self.duty, Duty::Root(_));
        let must_hear = !view.neighbours.is_empty() && distance <= view.parameters().critical;
        let misses = !is_root && must_hear && self.known.detector.suspected_before(now, self.known.root);
        let engaged = match self.duty {
            Duty::Root(_) | Duty::Free => 0.0,
            Duty::Networker(_) => ENGAGED_MM,
            Duty::Worker(_) => 2.0 * ENGAGED_MM,
        };
        // Cast: saturates. One millimetre is what a root that is there is ahead of all.
        let bid = if is_root {
            0
        } else {
            (1000.0 * distance + engaged).ceil().max(1.0) as u16
        };
        let turn = view.has_turn(&view.parameters().request_turns);
        let (me, step) = (self.known.id, self.known.step);
        if let Some(root) = self.election.control(me, step, misses, bid, rules) {
            self.follow(root);
        }
        if turn && let Some(bid) = self.election.says() {
            out.push(Message::Request(Request::Bid(bid)));
        }
    }

    /// Takes `root` for the root from now on: it becomes it, or stands down, or counts on it where it counted on the old one.
    pub(super) fn follow(&mut self, root: ActorId) {
        let old = std::mem::replace(&mut self.known.root, root);
        if root == old {
            return;
        }
        if root == self.known.id {
            self.replace_duty(|_, known| Duty::Root(Root::heir(&known.mission, known.order, known.step)));
        } else if matches!(self.duty, Duty::Root(_)) {
            self.become_free();
        }
        for slot in self.duty.slots_mut() {
            slot.follow(old, root);
        }
    }
}
