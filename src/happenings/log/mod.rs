//! A run as a log: [`Log`] puts together what is told piece by piece, frames with all that became of them, and hands it on.

mod records;
mod select;

use std::collections::{HashMap, VecDeque};
use std::io;

pub use records::{CopyRecord, Event, Fate, Frame, Message, Sending, What, address_name};
pub use select::Selection;

use super::{Copy, Sent, Vocabulary, Watch};
use crate::engine::{ActorId, SimTime};
use crate::faults::{Change, LinkFaultKind, Subject};
use crate::geometry::Vec2;
use crate::motion::World;
use crate::protocol::{Note, Role};
use crate::radio::{Conclusion, FrameId, LossCause, Reading};

/// Whom a [`Log`] hands on what it has put together. An error ends the log; the run goes on.
#[allow(unused_variables)] // Names of what methods are told that do nothing with it.
pub trait Sink: Send {
    /// The run begins.
    ///
    /// # Errors
    /// If what is written cannot be.
    fn begin(&mut self, vocabulary: &Vocabulary, world: &World) -> io::Result<()> {
        Ok(())
    }

    /// A frame, as soon as all of its copies have their fates: in the order in which frames were said.
    ///
    /// # Errors
    /// If what is written cannot be.
    fn frame(&mut self, frame: &Frame) -> io::Result<()> {
        Ok(())
    }

    /// A copy, as soon as its fate is settled: in the order of that. It may come before its frame does.
    ///
    /// # Errors
    /// If what is written cannot be.
    fn copy(&mut self, record: &CopyRecord) -> io::Result<()> {
        Ok(())
    }

    /// No frame and no copy of before this instant is to come, but copies that strayed.
    ///
    /// # Errors
    /// If what is written cannot be.
    fn settled(&mut self, until: SimTime) -> io::Result<()> {
        Ok(())
    }

    /// Of `robot`, the first `frames` frames are said, the last of them at `now`, with everyone where `world` has them.
    ///
    /// # Errors
    /// If what is written cannot be.
    fn spoke(&mut self, now: SimTime, robot: ActorId, frames: u32, world: &World) -> io::Result<()> {
        Ok(())
    }

    /// Something that happened, in order of time, but that a rumour is known from its arrival on and told of when it is read.
    ///
    /// # Errors
    /// If what is written cannot be.
    fn event(&mut self, event: &Event) -> io::Result<()> {
        Ok(())
    }

    /// Something that is not to be in the log, for it happened before, or to others: so that whoever keeps how things stand knows it.
    ///
    /// # Errors
    /// If what is written cannot be.
    fn aside(&mut self, event: &Event) -> io::Result<()> {
        Ok(())
    }

    /// Where everybody is, in order of time.
    ///
    /// # Errors
    /// If what is written cannot be.
    fn places(&mut self, world: &World) -> io::Result<()> {
        Ok(())
    }
}

/// Puts together what a run tells, for a [`Sink`].
#[derive(Debug)]
pub struct Log<S> {
    selection: Selection,
    /// Whether radios say when they are done with a frame.
    concludes: bool,
    sink: S,
    /// Why it stopped, if it did.
    failed: Option<io::Error>,
    /// Frames of which something is yet to come, and those behind them, in the order in which they were said.
    open: VecDeque<Open>,
    /// How many frames went out of `open` at its front.
    gone: u64,
    /// Where in `open` a frame is, counted with those that have gone. Asked by key alone, so that its order reaches nothing.
    places: HashMap<(ActorId, u32), u64>,
    /// Of each robot, the number of the first message of each of its frames.
    firsts: Vec<Vec<u32>>,
    next_places: SimTime,
}

#[derive(Debug)]
struct Open {
    frame: Frame,
    readings: Vec<Reading>,
    /// Copies that are yet to be told of.
    awaited: u64,
    concluded: bool,
    /// Whether it is in the selection.
    wanted: bool,
}

impl<S: Sink> Log<S> {
    /// Of a `selection` of a run, over a radio that `concludes` frames or does not, for `sink`.
    #[must_use]
    pub fn new(selection: Selection, concludes: bool, sink: S) -> Self {
        Self {
            next_places: selection.from,
            selection,
            concludes,
            sink,
            failed: None,
            open: VecDeque::new(),
            gone: 0,
            places: HashMap::new(),
            firsts: Vec::new(),
        }
    }

    /// The sink, when the run is over.
    ///
    /// # Errors
    /// That of the sink, if it had one.
    pub fn into_sink(self) -> io::Result<S> {
        match self.failed {
            Some(error) => Err(error),
            None => Ok(self.sink),
        }
    }

    fn hand(&mut self, hand: impl FnOnce(&mut S) -> io::Result<()>) {
        if self.failed.is_none()
            && let Err(error) = hand(&mut self.sink)
        {
            self.failed = Some(error);
        }
    }

    fn of_message(&mut self, sender: ActorId, sequence: u32) -> Option<&mut Open> {
        let number = self.number(sender, sequence);
        self.of_frame(sender, number)
    }

    fn of_frame(&mut self, sender: ActorId, number: u32) -> Option<&mut Open> {
        let place = self.places.get(&(sender, number))?;
        self.open.get_mut((place - self.gone) as usize)
    }

    /// The number of the frame with this message.
    fn number(&self, sender: ActorId, sequence: u32) -> u32 {
        let firsts = &self.firsts[sender.index()];
        firsts.partition_point(|&first| first <= sequence) as u32 - 1
    }

    fn settle(&mut self, copy: &Copy, fate: Fate, at: Option<SimTime>, read: Option<SimTime>) {
        if !self.selection.is_then(copy.sent_at) {
            return;
        }
        let frame = self.number(copy.sender, copy.sequence);
        let mut record = CopyRecord {
            copy: *copy,
            frame,
            fate,
            at,
            read,
            power: None,
            distance: None,
        };
        let selected = self.selection.has_copy(&record);
        if let Some(open) = self.of_frame(copy.sender, frame) {
            let reading = open.readings.iter().find(|reading| reading.receiver == copy.receiver);
            record.power = reading.map(|reading| reading.power).filter(|power| power.is_finite());
            record.distance = reading.map(|reading| reading.distance);
            open.wanted |= selected;
            match fate {
                Fate::Delivered => open.frame.delivered += 1,
                Fate::Lost(cause) => open.frame.lost[cause as usize] += 1,
                Fate::InFlight | Fate::Strayed => {}
            }
            open.awaited -= u64::from(fate != Fate::Strayed);
        }
        if selected {
            self.hand(|sink| sink.copy(&record));
        }
        self.close();
    }

    /// Hands on the frames at the front that are whole.
    fn close(&mut self) {
        let concludes = self.concludes;
        let is_whole = |open: &Open| open.awaited == 0 && (open.concluded || !concludes);
        if !self.open.front().is_some_and(is_whole) {
            return;
        }
        while self.open.front().is_some_and(is_whole) {
            self.hand_front();
        }
        if let Some(until) = self.open.front().map(|open| open.frame.at) {
            self.hand(|sink| sink.settled(until));
        }
    }

    fn hand_front(&mut self) {
        let Some(open) = self.open.pop_front() else { return };
        self.gone += 1;
        self.places.remove(&(open.frame.sender, open.frame.number));
        if open.wanted {
            self.hand(|sink| sink.frame(&open.frame));
        }
    }

    fn event(&mut self, at: SimTime, robot: Option<ActorId>, what: What) {
        let event = Event { at, robot, what };
        if self.selection.is_then(at) && self.selection.has_event(&event) {
            self.hand(|sink| sink.event(&event));
        } else if at < self.selection.until {
            self.hand(|sink| sink.aside(&event));
        }
    }

    fn look(&mut self, world: &World) {
        let now = world.now();
        if self.selection.is_then(now) && now >= self.next_places {
            self.next_places = now + self.selection.places_every;
            self.hand(|sink| sink.places(world));
        }
    }
}

impl<S: Sink> Watch for Log<S> {
    fn begin(&mut self, vocabulary: &Vocabulary, world: &World) {
        self.firsts = vec![Vec::new(); world.positions().len()];
        self.hand(|sink| sink.begin(vocabulary, world));
        self.look(world);
    }

    fn sent(&mut self, message: &Sent<'_>) {
        let sender = message.sender;
        let begins = !message.size.rides;
        if begins {
            self.firsts[sender.index()].push(message.sequence);
        }
        if !self.selection.is_then(message.at) {
            return;
        }
        let wanted = self.selection.has_topic(message.topic) && self.selection.has_robot(sender);
        let part = Message {
            sequence: message.sequence,
            topic: message.topic,
            to: message.to,
            payload_bytes: message.size.payload_bytes,
        };
        if begins {
            let number = self.firsts[sender.index()].len() as u32 - 1;
            self.places.insert((sender, number), self.gone + self.open.len() as u64);
            self.open.push_back(Open {
                frame: Frame {
                    at: message.at,
                    sender,
                    number,
                    messages: vec![part],
                    payloads: message.payload.to_vec(),
                    sending: None,
                    offered: message.copies,
                    delivered: 0,
                    lost: Default::default(),
                },
                readings: Vec::new(),
                awaited: message.copies,
                concluded: false,
                wanted,
            });
        } else if let Some(open) = self.of_message(sender, message.sequence) {
            open.frame.messages.push(part);
            open.frame.payloads.extend_from_slice(message.payload);
            open.frame.offered += message.copies;
            open.awaited += message.copies;
            open.wanted |= wanted;
        }
    }

    fn spoke(&mut self, now: SimTime, robot: ActorId, world: &World) {
        if self.selection.is_then(now) {
            let frames = self.firsts[robot.index()].len() as u32;
            self.hand(|sink| sink.spoke(now, robot, frames, world));
        }
        // A frame that nobody is offered is whole once all in it is said.
        self.close();
        if self.open.is_empty() && self.selection.is_then(now) {
            self.hand(|sink| sink.settled(now));
        }
    }

    fn lost(&mut self, copy: &Copy, cause: LossCause, at: SimTime) {
        self.settle(copy, Fate::Lost(cause), Some(at), None);
    }

    fn delivered(&mut self, copy: &Copy, at: SimTime, read: Option<SimTime>) {
        self.settle(copy, Fate::Delivered, Some(at), read);
    }

    fn strayed(&mut self, copy: &Copy, at: SimTime, read: Option<SimTime>) {
        self.settle(copy, Fate::Strayed, Some(at), read);
    }

    fn in_flight(&mut self, copy: &Copy, at: Option<SimTime>) {
        self.settle(copy, Fate::InFlight, at, None);
    }

    fn concluded(&mut self, conclusion: &Conclusion) {
        let FrameId { sender, number, .. } = conclusion.frame;
        let Some(open) = self.of_frame(sender, number) else {
            return;
        };
        open.concluded = true;
        open.frame.sending = Some(Sending {
            began: conclusion.began,
            attempts: conclusion.attempts,
            outcome: conclusion.outcome,
        });
        self.close();
    }

    fn measured(&mut self, _: SimTime, frame: FrameId, reading: &Reading) {
        if let Some(open) = self.of_frame(frame.sender, frame.number) {
            open.readings.push(*reading);
        }
    }

    fn noted(&mut self, now: SimTime, robot: ActorId, note: &Note) {
        let what = match note {
            Note::Role(Role(role)) => What::Enters(*role),
            Note::Target(target) => What::Serves(*target),
            Note::Parents(parents) => What::ReliesOn(parents.clone()),
            Note::Watches(other) => What::Watches(*other),
            Note::Suspects { robot, heard, .. } => What::Suspects(*robot, *heard),
            Note::Trusts(other) => What::Trusts(*other),
            Note::Informed { rumor, at, from } => return self.event(*at, Some(robot), What::Learns(*rumor, *from)),
            Note::Count { name, n } => What::Counts(name, *n),
            Note::Value { name, value } => What::Measures(name, *value),
            Note::Duplicate { .. } => return,
        };
        self.event(now, Some(robot), what);
    }

    fn fault(&mut self, now: SimTime, change: &Change, _: &[Vec2]) {
        let (robot, what) = match (change.subject, change.begins) {
            (Subject::Robot { robot, effect, .. }, true) => (Some(robot), What::Fails(effect)),
            (Subject::Robot { robot, effect, .. }, false) => (Some(robot), What::Recovers(effect)),
            (Subject::Links(kind), true) => (None, What::LinksFail(link_fault(kind))),
            (Subject::Links(kind), false) => (None, What::LinksRecover(link_fault(kind))),
        };
        self.event(now, robot, what);
    }

    fn tick(&mut self, world: &World) {
        self.look(world);
    }

    fn end(&mut self, _: SimTime) {
        while !self.open.is_empty() {
            self.hand_front();
        }
        self.hand(|sink| sink.settled(SimTime::NEVER));
    }
}

const fn link_fault(kind: LinkFaultKind) -> &'static str {
    match kind {
        LinkFaultKind::Partition => "partition",
        LinkFaultKind::Burst => "burst",
    }
}
