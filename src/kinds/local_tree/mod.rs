//! Local minimum spanning trees with kept links: each robot says where it is and whom it counts on, builds the tree of those that it hears, and moves so
//! that the links of the tree last. Nobody is asked, nothing is remembered but who was heard of late: what the least structure costs, and how loss breaks it.
//!
//! Robots know where they are in axes that all share, and say so, as the sources have it. A robot that fails is a neighbour no more once it was not heard for more than
//! [`memory`](LocalTreeConfig::memory) control steps: there is no failure detector.

mod bounds;
mod config;
mod kind;
mod measure;
mod message;
mod tree;

#[cfg(test)]
mod tests;

use std::rc::Rc;

pub use config::{Keep, Links, LocalTreeConfig, Renew};
pub use message::{Heard, Message, MessageCodec};

use crate::engine::{ActorId, SimTime};
use crate::geometry::Vec2;
use crate::protocol::gossip::OwnTurns;
use crate::protocol::robot_table::{RobotRow, RobotTable};
use crate::protocol::steering::forces;
use crate::protocol::wander::{Ground, Wander};
use crate::protocol::{Input, Note, Output, Protocol, Role, Topic, Wake};

/// The role of the robot at the base; who follows or wanders is free, as all are at first.
const ROOT: Role = Role(1);
/// The role of robots that hold targets.
pub const WORKER: Role = Role(2);

/// Settings that all robots share.
#[derive(Debug)]
pub struct Settings {
    config: LocalTreeConfig,
    /// The radio's range, metres.
    range: f64,
    /// Fastest speed, m/s.
    max_speed: f64,
    /// From one control step to the next, seconds.
    period: f64,
    ground: Ground,
}

/// What a robot is there for.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Duty {
    /// Goes where `wander` says.
    Wanders,
    /// Follows those that it is linked to.
    Follows,
    /// Stands at the base.
    Root,
    /// Goes to a target: its number and its place.
    Worker(u16, Vec2),
}

/// A robot that was heard of late.
#[derive(Clone, Debug)]
struct Neighbour {
    id: ActorId,
    /// The control step at which it was read, and its number among the sender's messages.
    heard: u64,
    sequence: u32,
    at: Vec2,
    /// Whether this robot is in its tree.
    counts_on_me: bool,
}

impl RobotRow for Neighbour {
    fn robot(&self) -> ActorId {
        self.id
    }
}

/// One robot.
#[derive(Debug)]
pub struct LocalTree {
    id: ActorId,
    settings: Rc<Settings>,
    turns: OwnTurns,
    duty: Duty,
    wander: Wander,
    step: u64,
    neighbours: RobotTable<Neighbour>,
    /// Those next to it in its tree, in order of ids.
    tree: Vec<ActorId>,
    /// Those that it stays linked to, in order of ids; and as the metrics know it.
    links: Vec<ActorId>,
    told: Vec<ActorId>,
    /// Whether a link held it back at the last control step.
    held_back: bool,
    // Buffers.
    near: Vec<tree::Placed>,
    disks: Vec<bounds::Disk>,
}

impl LocalTree {
    fn new(id: ActorId, settings: Rc<Settings>, turns: OwnTurns, duty: Duty) -> Self {
        Self {
            id,
            settings,
            turns,
            duty,
            wander: Wander::default(),
            step: 0,
            neighbours: RobotTable::default(),
            tree: Vec::new(),
            links: Vec::new(),
            told: Vec::new(),
            held_back: false,
            near: Vec::new(),
            disks: Vec::new(),
        }
    }

    /// Whether it is the root of a mission; robots that wander have none.
    fn is_root(&self) -> bool {
        self.duty == Duty::Root
    }

    fn hear(&mut self, sender: ActorId, sequence: u32, message: &Message) {
        let row = Neighbour {
            id: sender,
            heard: self.step,
            sequence,
            at: message.place(),
            counts_on_me: message.tree.contains(&self.id),
        };
        match self.neighbours.get_mut(sender) {
            None => self.neighbours.add(row),
            Some(known) if sequence.wrapping_sub(known.sequence).cast_signed() > 0 => *known = row,
            // It was overtaken by what is known already.
            Some(_) => {}
        }
    }

    /// Builds the tree anew if it is time, and takes the links from it.
    fn link(&mut self, me: Vec2) {
        let Settings { config, range, .. } = &*self.settings;
        let (step, memory) = (self.step, u64::from(config.memory));
        self.neighbours.retain(|known| step - known.heard <= memory);
        let neighbours = &self.neighbours;
        let is_torn = self.tree.is_empty() || self.tree.iter().any(|robot| neighbours.get(*robot).is_none());
        if config.renew == Renew::EachStep || is_torn || self.held_back {
            self.near.clear();
            self.near.extend(neighbours.iter().map(|known| (known.id, known.at)));
            tree::neighbours((self.id, me), &self.near, *range, &mut self.tree);
        }
        let counted_on = |robot: ActorId| neighbours.get(robot).is_some_and(|known| known.counts_on_me);
        self.links.clear();
        match config.links {
            Links::Intersection => self
                .links
                .extend(self.tree.iter().copied().filter(|robot| counted_on(*robot))),
            Links::Union => {
                self.links.extend(self.tree.iter().copied());
                let claims = neighbours
                    .iter()
                    .filter(|known| known.counts_on_me)
                    .map(|known| known.id);
                self.links.extend(claims);
                self.links.sort_unstable();
                self.links.dedup();
            }
        }
    }

    /// Ways to those that it is linked to, metres.
    fn ways(&self, me: Vec2) -> impl Iterator<Item = Vec2> {
        let linked = self.links.iter().filter_map(|robot| self.neighbours.get(*robot));
        linked.map(move |known| known.at - me)
    }

    /// Where it wants to go for its own sake, m/s.
    fn wish(&mut self, now: SimTime, me: Vec2) -> Vec2 {
        let config = &self.settings.config;
        match self.duty {
            Duty::Wanders => {
                let velocity = self.wander.velocity(&self.settings.ground, self.id, now, me);
                velocity.unwrap_or_else(Vec2::zeros)
            }
            Duty::Root => Vec2::zeros(),
            Duty::Worker(_, at) => forces::target(at - me, config.target_gain.get()),
            Duty::Follows => {
                let (sum, links) = self
                    .ways(me)
                    .fold((Vec2::zeros(), 0_u32), |(sum, n), way| (sum + way, n + 1));
                sum * (config.follow_gain.get() / f64::from(links.max(1)))
            }
        }
    }

    /// The velocity that it commands, m/s.
    fn velocity(&mut self, now: SimTime, me: Vec2, proximity: &[Vec2]) -> Vec2 {
        let wish = self.wish(now, me);
        if self.is_root() {
            return Vec2::zeros();
        }
        let Settings {
            config,
            range,
            max_speed,
            period,
            ..
        } = &*self.settings;
        let avoidance = forces::obstacle(
            wish,
            proximity,
            config.avoidance_range.get(),
            config.avoidance_gain.get(),
        );
        let wish = wish + avoidance;
        let mut disks = std::mem::take(&mut self.disks);
        disks.clear();
        let (velocity, held_back) = match config.keep {
            Keep::Midpoint { margin } => {
                disks.extend(
                    self.ways(me)
                        .map(|way| bounds::midpoint(me, me + way, *range, margin.get())),
                );
                let ahead = forces::in_order(Vec2::zeros(), wish, *max_speed) * *period;
                let (place, held_back) = bounds::within(me, me + ahead, &disks);
                ((place - me) / *period, held_back)
            }
            Keep::Tension { gain } => {
                let pulls = self.ways(me).map(|way| bounds::tension(way, *range) * gain.get());
                let pull: Vec2 = pulls.sum();
                (forces::in_order(pull, wish, *max_speed), pull.dot(&wish) < 0.0)
            }
        };
        self.held_back = held_back;
        self.disks = disks;
        velocity
    }

    /// Tells the metrics what has changed.
    fn report(&mut self, notes: &mut Vec<Note>) {
        if self.step == 0 {
            match self.duty {
                Duty::Wanders | Duty::Follows => {}
                Duty::Root => notes.push(Note::Role(ROOT)),
                Duty::Worker(target, _) => notes.extend([Note::Role(WORKER), Note::Target(Some(target))]),
            }
        }
        if self.links != self.told {
            self.told.clone_from(&self.links);
            notes.push(Note::Parents(self.links.clone()));
        }
    }
}

impl Protocol for LocalTree {
    type Message = Message;
    type Heard = Heard;
    type Codec = MessageCodec;
    const TOPICS: &'static [&'static str] = &["status"];
    const ROLES: &'static [&'static str] = &["free", "root", "worker"];
    const STATUS: Option<Topic> = Some(Topic(0));
    const SENSES_POWER: bool = false;

    fn step(&mut self, now: SimTime, input: &mut Input<Heard>, output: &mut Output<Message>) {
        for reception in &input.inbox {
            let frame = &reception.frame;
            self.hear(frame.sender, frame.sequence, &frame.message);
        }
        if input.wake != Wake::ControlStep {
            return;
        }
        // As the others will know it.
        let at = [0, 1].map(|axis| input.pose.position[axis] as f32);
        let me = Vec2::new(at[0].into(), at[1].into());
        self.link(me);
        output.velocity = Some(self.velocity(now, me, &input.proximity));
        if self.turns.is_due() {
            output.broadcast(Message {
                at,
                tree: self.tree.clone(),
            });
        }
        self.report(&mut output.notes);
        self.step += 1;
    }
}
