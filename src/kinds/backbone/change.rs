//! When a robot takes up or gives up a duty of its own accord.

use crate::geometry::Vec2;

use super::Backbone;
use super::duty::Duty;
use super::isolated;
use super::networker::Networker;
use super::view::Knowledge;
use super::worker::Worker;

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

    pub(super) fn replace_duty(&mut self, change: impl FnOnce(Duty, &Knowledge) -> Duty) {
        self.previous = self.duty.role();
        let old = std::mem::replace(&mut self.duty, Duty::Free);
        self.duty = change(old, &self.known);
    }
}
