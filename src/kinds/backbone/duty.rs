//! What a robot does for the backbone.

use super::message::Role;
use super::mission::Mission;
use super::networker::Networker;
use super::recruit::Slot;
use super::root::Root;
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
