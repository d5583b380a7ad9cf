//! What a replay needs of a run, gathered while it goes by: where robots are, what they are, what they say and what becomes of it. Of long
//! runs and large swarms every second place or message is left out, again and again, until what is left fits a page.

use std::collections::HashMap;

use super::airtime::Airtime;
use super::changes::Changes;
use crate::engine::{ActorId, SimTime, Span};
use crate::geometry::Vec2;
use crate::happenings::{Copy, Sent, Vocabulary, Watch};
use crate::motion::World;
use crate::protocol::Note;
use crate::radio::{Conclusion, LossCause};
use crate::scenario::Scenario;

/// Places are told to this length, metres.
pub const QUANTUM_M: f64 = 0.001;
/// How much a page has room for.
#[derive(Clone, Copy, Debug)]
struct Room {
    /// Robots times instants: about a byte each.
    places: usize,
    /// Messages, and copies of them.
    messages: usize,
    copies: usize,
}

impl Default for Room {
    fn default() -> Self {
        Self {
            places: 3_000_000,
            messages: 400_000,
            copies: 3_000_000,
        }
    }
}

/// Fates of copies as the page has them; a lost one has one more than the number of its cause.
pub const DELIVERED: u8 = 0;
pub const UNDER_WAY: u8 = u8::MAX;

/// A run as it is shown.
#[derive(Debug, Default)]
pub struct Film {
    /// Names of topics and roles.
    pub(super) vocabulary: Vocabulary,
    /// Places of all robots, robot after robot, instant after instant, in [quanta](QUANTUM_M).
    pub(super) places: Vec<[i32; 2]>,
    /// From one instant to the next.
    pub(super) every: Span,
    /// Changes of role, in order of time.
    pub(super) roles: Vec<(SimTime, ActorId, u8)>,
    /// Messages in order of time.
    pub(super) messages: Vec<Message>,
    /// Of how many messages each is one: the others are left out.
    pub(super) one_of: u64,
    /// What became of their copies, as it was told.
    pub(super) copies: Vec<CopyFate>,
    /// Why robots are what they are.
    pub(super) changes: Changes,
    /// What was on air, over a radio on which frames take time.
    pub(super) airtime: Option<Airtime>,
    room: Room,
    tick: Span,
    ticks: u64,
    stride: u64,
    robots: usize,
    /// Messages sent, with those left out.
    sent: u64,
    /// Of messages with copies yet to be told of: their place, and how many. Asked by key alone, so that its order reaches nothing.
    open: HashMap<(ActorId, u32), (u32, u64)>,
}

/// A message.
#[derive(Clone, Copy, Debug)]
pub(super) struct Message {
    /// Its number among all, from 0.
    number: u64,
    pub at: SimTime,
    pub sender: ActorId,
    pub topic: u8,
    /// Of its payload.
    pub bytes: u32,
}

/// What became of a copy.
#[derive(Clone, Copy, Debug)]
pub(super) struct CopyFate {
    /// Place of its message.
    pub message: u32,
    pub receiver: ActorId,
    pub fate: u8,
    /// When it arrived or was lost; when it was sent, where that is not known yet.
    pub at: SimTime,
}

impl Film {
    /// Of a trial of `scenario`, before it.
    #[must_use]
    pub fn of(scenario: &Scenario) -> Self {
        Self {
            airtime: scenario.radio.takes_time().then(Airtime::default),
            ..Self::default()
        }
    }

    /// How many instants there are.
    pub(super) fn instants(&self) -> usize {
        self.places.len() / self.robots.max(1)
    }

    /// Whether places between those that are there were left out.
    pub(super) fn is_thinned(&self) -> bool {
        self.stride > 1
    }

    /// How many robots.
    pub(super) fn robots(&self) -> usize {
        self.robots
    }

    /// Places at the end, unless they are there already.
    pub(super) fn close(&mut self, end: SimTime, places: impl Iterator<Item = Vec2>) {
        let last = self.every.as_nanos() * (self.instants().max(1) as u64 - 1);
        if end.as_nanos() > last {
            self.places.extend(places.map(quantised));
        }
    }

    fn look(&mut self, positions: &[Vec2]) {
        self.places.extend(positions.iter().copied().map(quantised));
        if self.places.len() > self.room.places.max(2 * self.robots) {
            let mut instant = 0;
            let robots = self.robots;
            self.places.retain(|_| {
                instant += 1;
                ((instant - 1) / robots).is_multiple_of(2)
            });
            self.stride *= 2;
            self.every = Span::from_nanos(self.tick.as_nanos() * self.stride);
        }
    }

    /// Every second message that is there is left out.
    fn thin(&mut self) {
        self.one_of *= 2;
        let mut places = Vec::with_capacity(self.messages.len());
        let mut kept = 0;
        for message in &self.messages {
            let stays = message.number.is_multiple_of(self.one_of);
            places.push(stays.then_some(kept));
            kept += u32::from(stays);
        }
        let place = |old: u32| places[old as usize];
        self.messages
            .retain(|message| message.number.is_multiple_of(self.one_of));
        self.copies
            .retain_mut(|copy| place(copy.message).map(|new| copy.message = new).is_some());
        self.open
            .retain(|_, open| place(open.0).map(|new| open.0 = new).is_some());
    }

    fn fate(&mut self, copy: &Copy, fate: u8, at: SimTime) {
        let key = (copy.sender, copy.sequence);
        let Some(open) = self.open.get_mut(&key) else { return };
        let message = open.0;
        open.1 -= 1;
        if open.1 == 0 {
            self.open.remove(&key);
        }
        self.copies.push(CopyFate {
            message,
            receiver: copy.receiver,
            fate,
            at,
        });
        if self.copies.len() > self.room.copies {
            self.thin();
        }
    }
}

impl Watch for Film {
    fn begin(&mut self, vocabulary: &Vocabulary, world: &World) {
        self.vocabulary = *vocabulary;
        self.robots = world.positions().len();
        self.tick = world.tick();
        self.stride = 1;
        self.one_of = 1;
        self.every = self.tick;
        self.roles = (0..self.robots as u32)
            .map(|robot| (SimTime::ZERO, ActorId(robot), 0))
            .collect();
        self.changes.begin(self.robots, vocabulary.status);
        self.look(world.positions());
    }

    fn tick(&mut self, world: &World) {
        self.ticks += 1;
        if self.ticks.is_multiple_of(self.stride) {
            self.look(world.positions());
        }
    }

    fn noted(&mut self, now: SimTime, robot: ActorId, note: &Note) {
        if let Note::Role(role) = note {
            self.roles.push((now, robot, role.0));
        }
        self.changes.noted(now, robot, note);
    }

    fn sent(&mut self, message: &Sent<'_>) {
        self.changes.sent(message);
        if let Some(airtime) = &mut self.airtime {
            airtime.said(message);
        }
        let number = self.sent;
        self.sent += 1;
        if !number.is_multiple_of(self.one_of) {
            return;
        }
        if message.copies > 0 {
            let place = self.messages.len() as u32;
            self.open
                .insert((message.sender, message.sequence), (place, message.copies));
        }
        self.messages.push(Message {
            number,
            at: message.at,
            sender: message.sender,
            topic: message.topic.0,
            bytes: u32::from(message.size.payload_bytes),
        });
        if self.messages.len() > self.room.messages {
            self.thin();
        }
    }

    fn lost(&mut self, copy: &Copy, cause: LossCause, at: SimTime) {
        self.changes.settled(copy, None);
        self.fate(copy, 1 + cause as u8, at);
    }

    fn delivered(&mut self, copy: &Copy, at: SimTime, read: Option<SimTime>) {
        self.changes.settled(copy, read);
        self.fate(copy, DELIVERED, at);
    }

    fn concluded(&mut self, conclusion: &Conclusion) {
        if let Some(airtime) = &mut self.airtime {
            airtime.concluded(conclusion);
        }
    }

    fn in_flight(&mut self, copy: &Copy, at: Option<SimTime>) {
        self.changes.settled(copy, None);
        self.fate(copy, UNDER_WAY, at.unwrap_or(copy.sent_at));
    }
}

fn quantised(place: Vec2) -> [i32; 2] {
    [place.x, place.y].map(|metres| (metres / QUANTUM_M).round() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::motion::{ArenaConfig, MotionConfig};
    use crate::protocol::{Address, MessageSize, Topic};

    const ROBOTS: u32 = 3;

    fn at(step: u64) -> SimTime {
        SimTime::ZERO + Span::from_nanos(step * 1_000_000)
    }

    /// So many ticks and messages, each for the two others: one gets it, the other does not.
    fn film(room: Room, steps: u64) -> (Film, World) {
        let poses = (0..ROBOTS).map(|robot| Pose {
            position: Vec2::new(f64::from(robot), 0.0),
            heading: 0.0,
        });
        let mut world = World::new(&MotionConfig::default(), &ArenaConfig::default(), poses.collect(), 1.0);
        let mut film = Film {
            room,
            ..Film::default()
        };
        film.begin(&Vocabulary::default(), &world);
        for step in 0..steps {
            world.advance();
            film.tick(&world);
            let (sender, sequence) = (ActorId(step as u32 % ROBOTS), step as u32 / ROBOTS);
            film.sent(&Sent {
                at: at(step),
                sender,
                to: None,
                topic: Topic(0),
                size: MessageSize::alone(5),
                sequence,
                copies: 2,
                overheard: false,
                payload: &[],
            });
            // Told of two messages later, as over a radio on which frames take time.
            let Some(step) = step.checked_sub(2) else { continue };
            let sender = step as u32 % ROBOTS;
            let copy = |receiver: u32| Copy {
                sender: ActorId(sender),
                receiver: ActorId(receiver % ROBOTS),
                address: Address::Everyone,
                topic: Topic(0),
                size: MessageSize::alone(5),
                sequence: step as u32 / ROBOTS,
                sent_at: at(step),
            };
            film.delivered(&copy(sender + 1), at(step), None);
            film.lost(&copy(sender + 2), LossCause::Collision, at(step));
        }
        (film, world)
    }

    #[test]
    fn what_outgrows_its_room_is_thinned_evenly_with_all_that_belongs_to_it() {
        let room = Room {
            places: 100 * ROBOTS as usize,
            messages: 64,
            copies: 1000,
        };
        let (film, world) = film(room, 1000);
        assert!(film.instants() <= 101 && film.instants() > 50);
        assert_eq!(film.every, Span::from_nanos(world.tick().as_nanos() * film.stride));
        assert_eq!(film.instants() as u64, 1000 / film.stride + 1);
        assert!(film.messages.len() <= 64 && film.messages.len() > 32);
        let steps = film.messages.iter().zip(film.messages.iter().skip(1));
        assert!(steps.clone().all(|(a, b)| b.number - a.number == film.one_of) && film.one_of > 1);
        for (place, message) in film.messages.iter().enumerate() {
            assert_eq!(message.at, at(message.number));
            let of_it: Vec<_> = film
                .copies
                .iter()
                .filter(|copy| copy.message as usize == place)
                .collect();
            let is_told = message.number < 998;
            assert_eq!(of_it.len(), if is_told { 2 } else { 0 }, "{message:?}");
            assert!(
                of_it
                    .iter()
                    .all(|copy| copy.at == message.at && copy.receiver != message.sender)
            );
        }
    }

    #[test]
    fn copies_alone_may_ask_for_thinning_and_what_fits_stays_whole() {
        let room = Room {
            copies: 100,
            ..Room::default()
        };
        let (thin, _) = film(room, 500);
        assert!(thin.copies.len() <= 100 && thin.messages.len() * 2 >= thin.copies.len());
        let (whole, _) = film(Room::default(), 500);
        assert_eq!((whole.one_of, whole.messages.len(), whole.instants()), (1, 500, 501));
        assert_eq!(whole.copies.len(), 2 * 498);
    }
}
