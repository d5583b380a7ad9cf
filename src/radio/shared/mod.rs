//! The shared radio: frames take time on air, and everybody is on the same air.
//!
//! [`SharedConfig`] describes it: a [technology](crate::radio::technology), [propagation](crate::radio::propagation), medium access, and what robots differ in. A frame
//! that is handed over joins its robot's queue. Medium access says when it goes out. From then on it is a burst that every robot takes up
//! which it reaches, whomever it is for. When it ends, each of its receivers judges it by what else it took up meanwhile.
//!
//! # Cost
//! Events are a few a frame and none a receiver: medium access, beginning, end, acknowledgement. A burst looks once at each robot that it reaches, whose
//! strength is kept while both stand, and all questions are answered by what one robot's antenna takes up.
//!
//! # Randomness
//! Keyed throughout: bit errors by sender, receiver, frame and attempt; medium access by robot and draw; fields by their place. So what survives at
//! one capture ratio survives at every lower one, as long as nobody's access depends on what was heard.

mod access;
mod agenda;
mod audience;
mod build;
mod burst;
mod config;
mod ear;
mod energy;
mod exchange;
mod forecast;
mod jammer;
mod link;
mod range;
mod receiver;
mod station;

pub use access::{AccessConfig, CsmaCaConfig, DcfConfig, PacedConfig};
pub(in crate::radio) use config::spelt_out;
pub use config::{CaptureConfig, SharedConfig};
pub use forecast::{Form, Stream};
pub use jammer::NoiseConfig;

use std::sync::Arc;

use access::{Draws, Head, Scheme, Station, Step};
use agenda::{Agenda, Task};
use audience::Audiences;
use burst::Bursts;
use ear::Ear;
use jammer::Jammers;
use link::LinkBudget;
use receiver::Receiver;
use station::{Doing, Open, Queued, Radio};

use super::sensing::Sensing;
use super::technology::Phy;
use super::{
    Account, Conclusion, Fate, Fates, FrameId, LossCause, Medium, Outcome, Places, RadioKind, RadioSite, Reach,
    Transmission,
};
use crate::engine::{ActorId, KeyedStreams, SimTime, Span};

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
    /// Where receivers begin their rounds of channels.
    scans: KeyedStreams,
    /// The longest burst so far: what is older than two of these, and than what medium access looks back to, is over.
    longest: Span,
    /// What each robot's battery holds at first, joules, if that is limited.
    battery: Option<f64>,
    /// Who takes up what robots and jammers send.
    audiences: Audiences,
    /// Whether memory is asked for before it is needed.
    prefetches: bool,
    /// Buffers.
    spare: Vec<Vec<Open>>,
    shortest: Span,
}

impl RadioKind for SharedConfig {
    fn medium(&self, site: &RadioSite) -> Box<dyn Medium> {
        Box::new(Shared::new(self, site))
    }

    fn header_bytes(&self, topics: usize, several: bool) -> Option<[u16; 2]> {
        Some(self.headers(topics, several))
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
        if let Some(cause) = refusal {
            fates.conclude(Conclusion {
                frame: frame.frame,
                outcome: Outcome::Dropped(cause),
                handed_over: frame.at,
                at_head: frame.at,
                began: None,
                attempts: 0,
            });
            return;
        }
        let mut open = self.spare.pop().unwrap_or_default();
        let listeners = frame.listeners.iter();
        open.extend(listeners.map(|listener| Open::new(listener.id, listener.sender.norm())));
        let radio = &mut self.radios[robot.index()];
        radio.queue.push_back(Queued {
            frame: frame.frame,
            to: frame.to,
            payload,
            airtime: self.phy.airtime(payload),
            handed_over: frame.at,
            at_head: frame.at,
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
            Task::Access(robot, stamp) => self
                .is_planned(robot, stamp)
                .then(|| self.access(now, ActorId(robot), fates))?,
            Task::Begin(robot, stamp) => {
                if self.is_planned(robot, stamp) {
                    self.begin(now, ActorId(robot), 0, places);
                }
                None
            }
            Task::Battery(robot) => {
                let robot = ActorId(robot);
                if self.look_at_battery(now, robot) {
                    fates.exhaust(robot);
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

    fn enable(&mut self, now: SimTime, _: &dyn Places, robot: ActorId, sends: bool, hears: bool) {
        let radio = &mut self.radios[robot.index()];
        if !hears {
            radio.hears_from = SimTime::NEVER;
        } else if radio.hears_from == SimTime::NEVER {
            radio.hears_from = now;
        }
        if !sends && !hears {
            radio.off_since = radio.off_since.min(now);
        } else {
            radio.off = radio.off + now.since(radio.off_since);
            radio.off_since = SimTime::NEVER;
        }
        if sends == radio.sends {
            return;
        }
        radio.sends = sends;
        if !sends {
            self.silence(now, robot);
        }
    }

    fn takes_far(&self) -> bool {
        true
    }

    fn account(&self, now: SimTime, robot: ActorId) -> Option<Account> {
        Some(self.account_of(now, robot))
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
                let airtime =
                    radio.queue.front().map_or(Span::ZERO, |head| head.airtime) * u64::from(self.phy.channels);
                radio.turned = radio.turned + self.scheme.turnaround() * 2;
                let until = at + airtime + self.scheme.turnaround();
                let since = self.since(now);
                self.ears[robot.index()].deafen(now, until, since);
                self.agenda.add(at, Task::Begin(robot.0, stamp));
            }
            Step::GiveUp(cause) => {
                let stamp = radio.replan(Doing::Contends);
                self.agenda.add(now, Task::Access(robot.0, stamp));
                return self.drop_head(now, robot, Outcome::Dropped(cause), fates);
            }
        }
        None
    }

    /// Asks medium access something about `robot`.
    fn at_medium<T>(
        &mut self,
        now: SimTime,
        robot: ActorId,
        ask: impl FnOnce(&mut dyn Scheme, &mut Station<'_>) -> T,
    ) -> T {
        let radio = &self.radios[robot.index()];
        let head = radio.queue.front().map(|queued| Head {
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
            skew: self.skews.get(robot.index()).copied().unwrap_or(0.0),
            draws: &mut self.draws,
        };
        ask(self.scheme.as_mut(), &mut station)
    }

    /// Takes the head off the queue of `robot`: the copies that have not arrived are lost, for the reason for which it was dropped or each for its own.
    fn drop_head(&mut self, now: SimTime, robot: ActorId, outcome: Outcome, fates: &mut Fates) -> Option<FrameId> {
        let queue = &mut self.radios[robot.index()].queue;
        let queued = queue.pop_front()?;
        if let Some(next) = queue.front_mut() {
            next.at_head = now;
        }
        Some(self.finish(queued, outcome, fates))
    }

    /// Is done with a frame.
    fn finish(&mut self, mut queued: Queued, outcome: Outcome, fates: &mut Fates) -> FrameId {
        for open in queued.open.drain(..) {
            fates.read(open.reading(false));
            let cause = match outcome {
                Outcome::Dropped(cause) => cause,
                Outcome::Sent | Outcome::Acknowledged | Outcome::Unacknowledged => open.cause,
            };
            fates.push(open.receiver, Fate::Lost(cause));
        }
        self.spare.push(queued.open);
        fates.conclude(Conclusion {
            frame: queued.frame,
            outcome,
            handed_over: queued.handed_over,
            at_head: queued.at_head,
            began: queued.began,
            attempts: queued.attempt + u32::from(queued.began.is_some()),
        });
        queued.frame
    }
}
