//! A disk radio that keeps what it knows to itself until the last moment: the run must be the disk radio's.

use std::collections::VecDeque;

use desim::engine::{ActorId, SimTime, Span};
use desim::radio::{
    Disk, Fate, Fates, FrameId, Medium, Places, RadioConfig, RadioKind, RadioSite, Reach, Transmission,
};

/// A disk radio with these settings, which says what becomes of a frame when its first copy could arrive.
#[derive(Clone, Debug)]
pub struct Late {
    pub disk: RadioConfig,
    /// Whether it says how late it is.
    pub tells: bool,
}

impl RadioKind for Late {
    fn medium(&self, site: &RadioSite) -> Box<dyn Medium> {
        let disk = Disk::new(&self.disk, &site.streams, site.robots);
        Box::new(Held {
            least: disk.lookahead(),
            disk,
            tells: self.tells,
            frames: VecDeque::new(),
        })
    }
}

/// A frame, and what it knows of it.
struct Frame {
    told_at: SimTime,
    id: FrameId,
    known: Vec<(ActorId, Fate)>,
}

struct Held {
    disk: Disk,
    least: Span,
    tells: bool,
    /// Frames, by when it says what becomes of them.
    frames: VecDeque<Frame>,
}

impl Medium for Held {
    fn reach(&self) -> Reach {
        self.disk.reach()
    }

    fn lookahead(&self) -> Span {
        if self.tells { self.least } else { Span::ZERO }
    }

    fn transmit(&mut self, frame: &Transmission<'_>, places: &dyn Places, fates: &mut Fates) {
        let mut known = Fates::default();
        self.disk.transmit(frame, places, &mut known);
        for listener in frame.listeners {
            fates.push(listener.id, Fate::Open);
        }
        self.frames.push_back(Frame {
            told_at: frame.at + self.least,
            id: frame.frame,
            known: known.drain().collect(),
        });
    }

    fn next(&self) -> SimTime {
        self.frames.front().map_or(SimTime::NEVER, |frame| frame.told_at)
    }

    fn advance(&mut self, _: SimTime, _: &dyn Places, fates: &mut Fates) -> Option<FrameId> {
        let frame = self.frames.pop_front()?;
        for (receiver, fate) in frame.known {
            fates.push(receiver, fate);
        }
        Some(frame.id)
    }
}
