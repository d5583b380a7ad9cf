//! What a robot does for the backbone, and when it takes up or gives up a duty of its own accord.

use crate::geometry::Vec2;

use super::Backbone;
use super::isolated;
use super::message::Role;
use super::mission::Mission;
use super::networker::Networker;
use super::recruit::Slot;
use super::root::Root;
use super::view::Knowledge;
use super::worker::Worker;

/// What a robot does, with the state that this needs.
#[derive(Debug)]
pub enum Duty {
    Free,
    Root(Root),
    Networker(Networker),
    Worker(Worker),
}

impl Duty {
    pub const fn role(&self) -> Role {
        match self {
            Self::Free => Role::Free,
            Self::Root(_) => Role::Root,
            Self::Networker(_) => Role::Networker,
            Self::Worker(_) => Role::Worker,
        }
    }

    pub fn slots(&self) -> &[Slot] {
        match self {
            Self::Free | Self::Root(_) => &[],
            Self::Networker(networker) => std::slice::from_ref(&networker.slot),
            Self::Worker(worker) => &worker.slots,
        }
    }

    pub fn slots_mut(&mut self) -> &mut [Slot] {
        match self {
            Self::Free | Self::Root(_) => &mut [],
            Self::Networker(networker) => std::slice::from_mut(&mut networker.slot),
            Self::Worker(worker) => &mut worker.slots,
        }
    }

    pub fn target(&self, mission: &Mission) -> Option<u16> {
        match self {
            Self::Free | Self::Root(_) => None,
            Self::Networker(networker) => Some(mission.chain(networker.slot.chain).target.into()),
            Self::Worker(worker) => Some(worker.target.into()),
        }
    }
}

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
                        Duty::Networker(networker) => Duty::Worker(Worker::heir(networker.slot, &known.mission)),
                        other => other,
                    });
                } else if networker.is_done(&view) {
                    self.become_free();
                }
            }
            Duty::Worker(worker) => {
                if let Some(better) = worker.better(&view) {
                    self.replace_duty(|duty, known| match duty {
                        Duty::Worker(worker) => worker.into_slot(known.mission.root).map_or(Duty::Free, |slot| {
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
}
