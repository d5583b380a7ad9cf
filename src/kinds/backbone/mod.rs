//! The failure-tolerant connectivity backbone (paper section 4): robots build chains of relays from a root to workers
//! that visit targets, as many chains to a target as it needs.

mod change;
mod checks;
mod codec;
mod config;
mod duty;
mod election;
mod free;
mod heal;
mod isolated;
mod kind;
mod layout;
mod lines;
mod message;
mod mission;
mod neighbours;
mod networker;
mod recruit;
mod reign;
mod relays;
mod requests;
mod root;
mod said;
mod shortage;
mod strand;
mod view;
mod worker;

#[cfg(test)]
mod tests;

use std::rc::Rc;

pub use codec::BackboneCodec;
pub use config::{BackboneConfig, ControlLawConfig, ElectionConfig, HealingConfig, RecruitingConfig, ShortageConfig};
pub use message::{Bid, Message, Order, Request, Role, Status, Strand, TargetSet};

use duty::Duty;
use election::Election;
use mission::{Mission, Parameters};
use neighbours::Neighbours;
use recruit::Recruiter;
use root::Root;
use said::Said;
use view::{Knowledge, View};
use worker::Worker;

use crate::engine::{ActorId, SimTime, Streams};
use crate::geometry::{Pose, Vec2};
use crate::protocol::control::ControlConfig;
use crate::protocol::detector::{self, Circumstances, Detector, DetectorConfig};
use crate::protocol::gossip::GossipConfig;
use crate::protocol::steering::{Sidestep, forces};
use crate::protocol::{Input, Note, Output, Protocol, Reception, Topic, Wake};

/// One robot of the backbone.
#[derive(Debug)]
pub struct Backbone {
    known: Knowledge,
    duty: Duty,
    /// The role before the present one.
    previous: Role,
    recruiter: Recruiter,
    sidestep: Sidestep,
    /// What arrived since the last control step and was read when the detector's timer woke the robot.
    unread: Vec<Reception<Rc<Message>>>,
    said: Said,
    election: Election,
    told: Told,
}

/// What the metrics were last told.
#[derive(Debug, Default)]
struct Told {
    role: Role,
    target: Option<u16>,
    parents: Vec<ActorId>,
}

/// The robots of a scenario, in order of their ids, for robots that start at `poses`. The robot nearest to the centre is
/// the root; the robot nearest to each target is its worker; all others are free.
///
/// # Panics
/// If there are fewer robots than a root and a worker for each target, which [`BackboneConfig::own_problems`] reports.
#[must_use]
pub fn swarm(
    config: &BackboneConfig,
    gossip: &GossipConfig,
    detector: &DetectorConfig,
    control: &ControlConfig,
    poses: &[Pose],
    streams: Streams,
) -> Vec<Backbone> {
    let circumstances = Circumstances {
        robots: poses.len(),
        status_interval: gossip.status.longest_pause(control.period()),
    };
    let parameters = Parameters::new(config, gossip, (detector, circumstances), control, streams);
    let mission = Rc::new(Mission::new(config, parameters, poses));
    (0..poses.len() as u32)
        .map(|robot| Backbone::new(ActorId(robot), Rc::clone(&mission)))
        .collect()
}

impl Backbone {
    fn new(id: ActorId, mission: Rc<Mission>) -> Self {
        let duty = if id == mission.root {
            Duty::Root(Root::new(&mission))
        } else if let Some(target) = mission.worker_target(id) {
            Duty::Worker(Worker::new(target, &mission, mission.root))
        } else {
            Duty::Free
        };
        let parameters = &mission.parameters;
        let detector = Detector::new(&parameters.detector, parameters.circumstances, parameters.phases, id);
        Self {
            said: Said::nothing(id, parameters),
            election: Election::won_by(mission.root),
            known: Knowledge {
                id,
                step: 0,
                position: Vec2::zeros(),
                neighbours: Neighbours::default(),
                detector,
                root: mission.root,
                mission,
                order: Order::default(),
            },
            duty,
            previous: Role::Free,
            recruiter: Recruiter::default(),
            sidestep: Sidestep::default(),
            unread: Vec::new(),
            told: Told::default(),
        }
    }

    /// The robot that every chain ends at when a trial starts.
    #[must_use]
    pub fn root(&self) -> ActorId {
        self.known.mission.root
    }

    fn hear(&mut self, reception: &Reception<Rc<Message>>, out: &mut Vec<Message>) {
        let frame = &reception.frame;
        match &*frame.message {
            Message::Status(status) => {
                let position = self.known.position + reception.displacement();
                self.known
                    .neighbours
                    .hear(frame.sender, frame.sequence, reception.at, position, *status);
                if status.role == Role::Root && frame.sender != self.known.root {
                    self.election.contradict();
                }
            }
            Message::ParentStrand(strand) => self.hear_parent_strand(frame.sender, strand, out),
            Message::ChildStrand(strand) if self.is_too_long(strand) => {}
            Message::ChildStrand(strand) => match &mut self.duty {
                Duty::Networker(networker) => {
                    networker.hear_child_strand(frame.sender, strand, self.known.id, self.known.step);
                }
                Duty::Root(root) => root.hear_child_strand(strand, &self.known),
                Duty::Free | Duty::Worker(_) => {}
            },
            Message::Request(request) => self.hear_request(frame.sender, *request, out),
            // The detector has read it.
            Message::Probe(_) => {}
        }
    }

    /// Whether `strand` has come farther than strand info may.
    fn is_too_long(&self, strand: &Strand) -> bool {
        strand.robots.len() > self.known.mission.parameters.hop_limit
    }

    /// A robot that names this one as its child and is not counted on as a parent is let go.
    fn hear_parent_strand(&mut self, sender: ActorId, strand: &Strand, out: &mut Vec<Message>) {
        let (me, step) = (self.known.id, self.known.step);
        let nowhere;
        let strand = if self.is_too_long(strand) {
            // It is no way to the root.
            nowhere = Strand {
                robots: Rc::default(),
                ..*strand
            };
            &nowhere
        } else {
            strand
        };
        let known = match &mut self.duty {
            Duty::Networker(networker) => networker.slot.hear_parent_strand(sender, strand, me, step),
            Duty::Worker(worker) => {
                // Every slot hears it: no short cut after the first that knows the sender.
                let known = worker
                    .slots
                    .iter_mut()
                    .map(|slot| slot.hear_parent_strand(sender, strand, me, step));
                known.fold(false, std::ops::BitOr::bitor)
            }
            Duty::Free | Duty::Root(_) => false,
        };
        if !known && strand.next == me && sender != me {
            out.push(Message::Request(Request::Release { to: sender }));
        }
    }

    fn control(&mut self, now: SimTime, input: &mut Input<Rc<Message>>, output: &mut Output<Message>) {
        let Knowledge {
            neighbours, detector, ..
        } = &mut self.known;
        neighbours.forget(|robot| detector.suspected_before(now, robot));
        self.elect(now, &mut output.broadcasts);
        self.change_duty(&input.proximity);
        let desired = self.act(&input.proximity, &mut output.broadcasts);
        let parameters = &self.known.mission.parameters;
        let desired = forces::settle(desired, parameters.rest_speed);
        let velocity = if self.may_step_aside() {
            let patience = parameters.patience;
            self.sidestep.adjust(
                desired,
                self.known.position,
                self.known.step,
                patience,
                &mut input.random,
            )
        } else {
            self.sidestep.rest(self.known.position, self.known.step);
            desired
        };
        output.velocity = Some(velocity);
        self.gossip(&input.proximity, &mut output.broadcasts);
    }

    /// Runs the routine of the robot's role; the velocity that it wants.
    fn act(&mut self, proximity: &[Vec2], out: &mut Vec<Message>) -> Vec2 {
        let view = self.known.view(proximity);
        match &mut self.duty {
            Duty::Free | Duty::Networker(_) | Duty::Worker(_) if view.is_isolated() => isolated::velocity(&view),
            Duty::Free => free::velocity(&view),
            Duty::Root(root) => {
                let velocity = Root::velocity(&view);
                self.known.order = root.control(&view, &mut self.recruiter, out);
                velocity
            }
            Duty::Networker(networker) => networker.control(&view, &mut self.recruiter, out),
            Duty::Worker(worker) => worker.control(&view, &mut self.recruiter, out),
        }
    }

    /// Robots that hold a link in place stand still of their own will; all others may be stuck.
    fn may_step_aside(&self) -> bool {
        match &self.duty {
            Duty::Free => true,
            Duty::Networker(networker) => !networker.is_settled(),
            Duty::Root(_) | Duty::Worker(_) => false,
        }
    }

    fn gossip(&mut self, proximity: &[Vec2], out: &mut Vec<Message>) {
        let view = self.known.view(proximity);
        let parameters = view.parameters();
        if view.has_turn(&parameters.status_turns) {
            let status = self.status(&view);
            if self.said.status.is_due(parameters.status_repetition, &status) {
                out.push(Message::Status(status));
            }
        }
        if view.has_turn(&parameters.strand_turns) {
            let strands = self.strands();
            if self.said.strands.is_due(parameters.strand_repetition, &strands) {
                out.extend(strands);
            }
        }
        let ordered = self.known.order.epoch != 0 && !matches!(self.duty, Duty::Free);
        if ordered && view.has_turn(&parameters.relay_turns) {
            let limit = parameters.retransmit.limit(view.mission.robots);
            if self.said.passes_on(self.known.order, limit) {
                out.push(Message::Request(Request::Order(self.known.order)));
            }
        }
    }

    /// What its strands say now.
    fn strands(&self) -> Vec<Message> {
        let mut strands = Vec::new();
        match &self.duty {
            Duty::Free => {}
            Duty::Root(_) => Root::strands(self.known.id, &mut strands),
            Duty::Networker(networker) => networker.strands(self.known.id, &mut strands),
            Duty::Worker(worker) => worker.strands(self.known.id, &mut strands),
        }
        strands
    }

    fn status(&self, view: &View<'_>) -> Status {
        let (need, chain) = match &self.duty {
            Duty::Free | Duty::Root(_) => (false, 0),
            Duty::Networker(networker) => (networker.need(view), networker.slot.chain),
            Duty::Worker(worker) => (worker.need(view), worker.first_chain()),
        };
        Status {
            role: self.duty.role(),
            previous: self.previous,
            need,
            chain,
        }
    }

    /// Whether `message` is an order or a bid that it has had, or a newer one. Of other messages none is told apart: status and
    /// strands are signs of life, that they say nothing new is what they say.
    fn knows(&self, message: &Message) -> bool {
        match message {
            Message::Request(Request::Order(order)) => !order.is_newer_than(self.known.order),
            Message::Request(Request::Bid(bid)) => self.election.knows(*bid),
            _ => false,
        }
    }

    /// Tells the metrics what has changed.
    fn report(&mut self, notes: &mut Vec<Note>) {
        let role = self.duty.role();
        if role != self.told.role {
            self.told.role = role;
            notes.push(Note::Role(role.index()));
        }
        let target = self.duty.target(&self.known.mission);
        if target != self.told.target {
            self.told.target = target;
            notes.push(Note::Target(target));
        }
        let slots = self.duty.slots();
        if !slots
            .iter()
            .map(|slot| slot.parent)
            .eq(self.told.parents.iter().copied())
        {
            self.told.parents.clear();
            self.told.parents.extend(slots.iter().map(|slot| slot.parent));
            notes.push(Note::Parents(self.told.parents.clone()));
        }
    }
}

impl Protocol for Backbone {
    type Message = Message;
    type Heard = Rc<Message>;
    type Codec = BackboneCodec;
    const TOPICS: &'static [&'static str] = &["status", "request", "parent strand", "child strand", "probe"];
    const ROLES: &'static [&'static str] = &["free", "root", "networker", "worker"];
    const SENSES_POWER: bool = false;
    const STATUS: Option<Topic> = Some(Topic(0));
    const PROBE: Option<Topic> = Some(Topic(4));

    fn topic(message: &Message) -> Topic {
        Topic(match message {
            Message::Status(_) => 0,
            Message::Request(_) => 1,
            Message::ParentStrand(_) => 2,
            Message::ChildStrand(_) => 3,
            Message::Probe(_) => 4,
        })
    }

    fn step(&mut self, now: SimTime, input: &mut Input<Rc<Message>>, output: &mut Output<Message>) {
        self.known.detector.read(now, &input.inbox, output);
        if input.wake == Wake::Timer(detector::TIMER) {
            // Believing, and asking for news of others, is all that it does between control steps: what it read, and what
            // follows from a suspicion, wait for the next one.
            self.known.detector.expire(now, &mut input.random, output);
            self.unread.append(&mut input.inbox);
            return;
        }
        self.known.position = input.pose.position;
        let unread = std::mem::take(&mut self.unread);
        for reception in unread.iter().chain(&input.inbox) {
            let message = &reception.frame.message;
            if self.knows(message) {
                output.notes.push(reception.duplicate(Self::topic(message)));
            }
            self.hear(reception, &mut output.broadcasts);
        }
        if input.wake == Wake::ControlStep {
            self.control(now, input, output);
            self.known.step += 1;
        }
        self.report(&mut output.notes);
    }
}
