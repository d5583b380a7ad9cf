//! A disk radio that keeps what it knows to itself until the last moment: the run must be the disk radio's.

use std::collections::VecDeque;

use desim::engine::{SimTime, Span, Streams};
use desim::radio::{Disk, Fate, Fates, FrameId, Medium, RadioConfig, RadioKind, Transmission};

/// A disk radio with these settings, which says what becomes of a frame when its first copy could arrive.
#[derive(Clone, Debug)]
pub struct Late {
    pub disk: RadioConfig,
    /// Whether it says how late it is.
    pub tells: bool,
}

impl RadioKind for Late {
    fn medium(&self, streams: &Streams, robots: usize) -> Box<dyn Medium> {
        let disk = Disk::new(&self.disk, streams, robots);
        Box::new(Held {
            least: disk.lookahead(),
            disk,
            tells: self.tells,
            held: VecDeque::new(),
        })
    }
}

struct Held {
    disk: Disk,
    least: Span,
    tells: bool,
    /// Frames, and what it knows of them, by when it says so.
    held: VecDeque<(SimTime, FrameId, Vec<(desim::engine::ActorId, Fate)>)>,
}

impl Medium for Held {
    fn range(&self) -> f64 {
        self.disk.range()
    }

    fn lookahead(&self) -> Span {
        if self.tells { self.least } else { Span::ZERO }
    }

    fn transmit(&mut self, frame: &Transmission<'_>, fates: &mut Fates) {
        let mut known = Fates::default();
        self.disk.transmit(frame, &mut known);
        for listener in frame.listeners {
            fates.push(listener.id, Fate::Open);
        }
        let known = known.drain().collect();
        self.held.push_back((frame.at + self.least, frame.frame, known));
    }

    fn next(&self) -> SimTime {
        self.held.front().map_or(SimTime::NEVER, |frame| frame.0)
    }

    fn advance(&mut self, _: SimTime, fates: &mut Fates) -> Option<FrameId> {
        let (_, frame, known) = self.held.pop_front()?;
        known.into_iter().for_each(|(id, fate)| fates.push(id, fate));
        Some(frame)
    }
}
