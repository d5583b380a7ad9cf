//! The shared radio: frames take time on air, and everybody is on the same air.
//!
//! [`SharedConfig`] describes it: a [technology](crate::radio::technology), [propagation](crate::radio::propagation), medium access, and what robots differ in. A frame
//! that is handed over joins its robot's queue. Medium access says when it goes out. From then on it is a burst that every robot takes up
//! which it reaches, whomever it is for. When it ends, each of its receivers judges it by what else it took up meanwhile.
//!
//! # Cost
//! Events are a few a frame and none a receiver: medium access, beginning, end, acknowledgement. A burst looks once at each robot that it reaches,
//! and all questions are answered by one robot's [ear](ear).
//!
//! # Randomness
//! Keyed throughout: bit errors by sender, receiver, frame and attempt; medium access by robot and draw; fields by their place. So what survives at
//! one capture ratio survives at every lower one, as long as nobody's access depends on what was heard.

mod access;
mod agenda;
mod burst;
mod config;
mod ear;
mod exchange;
mod jammer;
mod link;
mod range;
mod receiver;
mod station;

pub use access::{AccessConfig, CsmaCaConfig, DcfConfig, PacedConfig};
pub use config::{CaptureConfig, SharedConfig, WallsConfig};
pub use jammer::NoiseConfig;

use std::sync::Arc;

use access::{Draws, Head, Scheme, Station, Step};
use agenda::{Agenda, Task};
use burst::{Burst, Bursts, Content};
use ear::{Ear, Heard};
use jammer::Jammers;
use link::LinkBudget;
use receiver::Receiver;
use station::{Doing, Queued, Radio};

use super::draw::FrameCopy;
use super::sensing::Sensing;
use super::technology::Phy;
use super::{Fate, Fates, FrameId, LossCause, Medium, Places, RadioKind, RadioSite, Reach, Transmission};
use crate::engine::{ActorId, SimTime, Span};
use crate::geometry::Vec2;

/// The shared radio of one run.
pub struct Shared {
    phy: Phy,
    budget: Arc<LinkBudget>,
    scheme: Box<dyn Scheme>,
    receiver: Receiver,
    jammers: Jammers,
    sensing: Sensing,
    draws: Draws,
    agenda: Agenda,
    bursts: Bursts,
    radios: Vec<Radio>,
    ears: Vec<Ear>,
    /// By how much each robot's clock is fast, as a share.
    skews: Vec<f64>,
    /// Frames that a queue holds at most, the one being sent included.
    room: usize,
    /// On how many channels in turn each frame is sent.
    channels: u8,
    /// The longest burst so far: what is older than two of these, and than what medium access looks back to, is over.
    longest: Span,
    /// Bodies are in the way of light.
    body_radius: f64,
    /// Buffers.
    reached: Vec<(ActorId, Vec2)>,
    spare: Vec<Vec<(ActorId, LossCause)>>,
    shortest: Span,
}

impl RadioKind for SharedConfig {
    fn medium(&self, site: &RadioSite) -> Box<dyn Medium> {
        Box::new(Shared::new(self, site))
    }
}

impl Medium for Shared {
    fn reach(&self) -> Reach {
        Reach::Links(self.budget.clone())
    }

    fn lookahead(&self) -> Span {
        self.scheme.least_delay() + self.shortest
    }

    fn transmit(&mut self, frame: &Transmission<'_>, _: &dyn Places, fates: &mut Fates) {
        let robot = frame.frame.sender;
        let payload = frame.bytes.saturating_sub(self.phy.header_bytes);
        let full = self.radios[robot.index()].queue.len() >= self.room;
        let refusal = if payload > self.phy.max_payload {
            Some(LossCause::TooLong)
        } else if full && self.scheme.restrained(frame.at, robot) {
            Some(LossCause::DutyCycle)
        } else {
            full.then_some(LossCause::QueueFull)
        };
        for listener in frame.listeners {
            fates.push(listener.id, refusal.map_or(Fate::Open, Fate::Lost));
        }
        if refusal.is_some() {
            return;
        }
        let mut open = self.spare.pop().unwrap_or_default();
        open.extend(frame.listeners.iter().map(|listener| (listener.id, LossCause::BelowSensitivity)));
        let radio = &mut self.radios[robot.index()];
        radio.queue.push_back(Queued {
            frame: frame.frame,
            to: frame.to,
            payload,
            airtime: self.phy.airtime(payload),
            at: frame.at,
            attempt: 0,
            began: None,
            open,
            arrived: false,
        });
        if radio.doing == Doing::Rests {
            let stamp = radio.replan(Doing::Contends);
            // What the medium makes of it it says at its own events.
            self.agenda.add(frame.at, Task::Access(robot.0, stamp));
        }
    }

    fn next(&self) -> SimTime {
        self.agenda.next()
    }

    fn advance(&mut self, now: SimTime, places: &dyn Places, fates: &mut Fates) -> Option<FrameId> {
        match self.agenda.take()? {
            Task::Access(robot, stamp) => self.is_planned(robot, stamp).then(|| self.access(now, ActorId(robot), fates))?,
            Task::Begin(robot, stamp) => {
                if self.is_planned(robot, stamp) {
                    self.begin(now, ActorId(robot), 0, places);
                }
                None
            }
            Task::Jam(jammer) => {
                self.jam(now, jammer, places);
                None
            }
            Task::End(burst) => self.end(now, burst, places, fates),
            Task::Acknowledge(robot, burst) => {
                self.acknowledge(now, ActorId(robot), burst, places);
                None
            }
            Task::Timeout(robot, stamp) => self
                .is_planned(robot, stamp)
                .then(|| self.conclude(now, ActorId(robot), access::Outcome::Unanswered, fates))?,
            Task::Flush(robot) => self.flush(now, ActorId(robot), fates),
        }
    }

    fn enable(&mut self, now: SimTime, robot: ActorId, sends: bool, hears: bool, _: &dyn Places) {
        let radio = &mut self.radios[robot.index()];
        if !hears {
            radio.hears_from = SimTime::NEVER;
        } else if radio.hears_from == SimTime::NEVER {
            radio.hears_from = now;
        }
        if sends == radio.sends {
            return;
        }
        radio.sends = sends;
        if !sends {
            self.silence(now, robot);
        }
    }
}

impl Shared {
    fn is_planned(&self, robot: u32, stamp: agenda::Stamp) -> bool {
        self.radios[robot as usize].stamp == stamp
    }

    /// What ended before this is of no use to anybody.
    fn since(&self, now: SimTime) -> SimTime {
        now - (self.longest * 2 + self.scheme.memory())
    }

    /// Lets the medium access of `robot` go on, and does what it says.
    fn access(&mut self, now: SimTime, robot: ActorId, fates: &mut Fates) -> Option<FrameId> {
        let step = self.at_medium(now, robot, |scheme, station| scheme.step(now, station));
        let radio = &mut self.radios[robot.index()];
        match step {
            Step::Rest => {
                radio.replan(Doing::Rests);
            }
            Step::Wait(until) => {
                let stamp = radio.replan(Doing::Contends);
                self.agenda.add(until, Task::Access(robot.0, stamp));
            }
            Step::Send(at) => {
                let stamp = radio.replan(Doing::Turns);
                let airtime = radio.queue.front().map_or(Span::ZERO, |head| head.airtime) * u64::from(self.channels);
                let until = at + airtime + self.scheme.turnaround();
                let since = self.since(now);
                self.ears[robot.index()].deafen(now, until, since);
                self.agenda.add(at, Task::Begin(robot.0, stamp));
            }
            Step::GiveUp(cause) => {
                let stamp = radio.replan(Doing::Contends);
                self.agenda.add(now, Task::Access(robot.0, stamp));
                return self.drop_head(robot, Some(cause), fates);
            }
        }
        None
    }

    /// Asks medium access something about `robot`.
    fn at_medium<T>(&mut self, now: SimTime, robot: ActorId, ask: impl FnOnce(&mut dyn Scheme, &mut Station<'_>) -> T) -> T {
        let radio = &self.radios[robot.index()];
        let answering = self.scheme.answering().is_some();
        let head = radio.queue.front().map(|queued| Head {
            answered: answering && queued.to.is_some(),
            attempt: queued.attempt,
            airtime: queued.airtime,
        });
        let mut station = Station {
            robot,
            head,
            answers: radio.answers_until > now,
            ear: &mut self.ears[robot.index()],
            bursts: &self.bursts,
            receiver: &self.receiver,
            skew: self.skews[robot.index()],
            draws: &mut self.draws,
        };
        ask(self.scheme.as_mut(), &mut station)
    }

    /// Takes the head off the queue of `robot`: the copies that have not arrived are lost, for this cause or each for its own.
    fn drop_head(&mut self, robot: ActorId, cause: Option<LossCause>, fates: &mut Fates) -> Option<FrameId> {
        let mut queued = self.radios[robot.index()].queue.pop_front()?;
        for (receiver, own) in queued.open.drain(..) {
            fates.push(receiver, Fate::Lost(cause.unwrap_or(own)));
        }
        self.spare.push(queued.open);
        Some(queued.frame)
    }
}
