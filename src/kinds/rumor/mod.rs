//! Rumour spreading (Demers et al. 1987, "Epidemic algorithms for replicated database maintenance"): some robots know
//! something, and round by round the others come to know it, by push, by pull or by both.
//!
//! In a round a robot addresses a few others, each as likely as any other robot of the swarm (it knows who there is, not
//! who is near; one out of range does not hear it), or whoever hears it. It *pushes* the rumours that it knows, or *pulls*:
//! asks for those that it does not, saying which it has. Whoever is asked answers with the rest, to the one who asked.
//! A message that names a robot is read by that robot alone, though others hear it.
//!
//! With Poisson rounds of rate β, push, one peer and everyone in range this is the SI epidemic of the textbooks: n informed
//! robots inform one of the N − n others at rate β (1 − p) n (N − n) / (N − 1) under loss p, and the time until all know has
//! the mean 2 (N − 1) H(N − 1) / (N β (1 − p)).

mod config;
mod kind;
mod message;

use std::rc::Rc;

pub use config::{Mode, RoundsConfig, RumorConfig, SourcesConfig};
pub use message::{Message, RumorCodec};

use crate::engine::{ActorId, KeyedStreams, Purpose, SimTime, Span, Streams};
use crate::protocol::control::{ControlConfig, Phases, Rhythm};
use crate::protocol::gossip::{FanOutConfig, GossipConfig, Turns};
use crate::protocol::wander::{Ground, Wander};
use crate::protocol::{Input, Note, Output, Protocol, Reception, Role, TimerId, Topic, Wake};

/// Whom a robot addresses, by robot and round: a word a peer.
const PEERS: Purpose = Purpose::new("rumor.peers");
/// When a robot has its next round, by robot and round: one word.
const ROUND: Purpose = Purpose::new("rumor.round");
/// Who begins a rumour, by rumour: one word.
const SOURCE: Purpose = Purpose::new("rumor.source");
const RUMOR: Topic = Topic(0);
const REQUEST: Topic = Topic(1);
/// The timer of Poisson rounds.
const NEXT_ROUND: TimerId = TimerId(0);

/// Settings that all robots of a trial share.
#[derive(Debug)]
pub struct Settings {
    mode: Mode,
    rounds: RoundsConfig,
    size: u16,
    robots: u32,
    /// The robot that begins each rumour.
    sources: Vec<ActorId>,
    fan_out: FanOutConfig,
    /// Messages that a robot pushes of one rumour.
    limit: u64,
    /// Mean seconds between rounds.
    interval: f64,
    turns: Turns,
    peers: KeyedStreams,
    contacts: KeyedStreams,
    ground: Ground,
}

/// One robot and what it knows.
#[derive(Debug)]
pub struct Rumor {
    id: ActorId,
    settings: Rc<Settings>,
    /// A bit for each rumour.
    known: u64,
    /// Messages pushed so far, by rumour.
    pushed: Vec<u64>,
    control_steps: u64,
    rounds: u32,
    wander: Wander,
}

/// `robots` robots in order of their ids, in a trial with these `streams`, which move on `ground`.
#[must_use]
pub fn swarm(
    config: &RumorConfig,
    gossip: &GossipConfig,
    control: &ControlConfig,
    robots: u32,
    ground: Ground,
    streams: Streams,
) -> Vec<Rumor> {
    let relay = &gossip.relay;
    let phases = Phases::new(control.phase, streams);
    let settings = Rc::new(Settings {
        mode: config.mode,
        rounds: config.rounds,
        size: config.size,
        robots,
        sources: sources(&config.sources, robots, streams),
        fan_out: relay.fan_out,
        limit: relay.retransmit.limit(robots as usize),
        interval: relay.interval.get(),
        turns: Turns::new(relay.timing(control.period()), Rhythm::Relay, phases, streams),
        peers: streams.keyed(PEERS),
        contacts: streams.keyed(ROUND),
        ground,
    });
    (0..robots)
        .map(|id| Rumor::new(ActorId(id), Rc::clone(&settings)))
        .collect()
}

fn sources(config: &SourcesConfig, robots: u32, streams: Streams) -> Vec<ActorId> {
    match config {
        SourcesConfig::Random(rumors) => {
            let draws = streams.keyed(SOURCE);
            (0..u32::from(*rumors))
                .map(|rumor| ActorId(below(draws.first_two(rumor, 0, 0)[0], robots)))
                .collect()
        }
        SourcesConfig::Robots(robots) => robots.iter().copied().map(ActorId).collect(),
    }
}

/// `word` as a number below `limit`, each as likely but for 2⁻³².
fn below(word: u64, limit: u32) -> u32 {
    ((u128::from(word) * u128::from(limit)) >> 64) as u32
}

impl Rumor {
    fn new(id: ActorId, settings: Rc<Settings>) -> Self {
        Self {
            id,
            known: 0,
            pushed: vec![0; settings.sources.len()],
            settings,
            control_steps: 0,
            rounds: 0,
            wander: Wander::default(),
        }
    }

    fn hear(&mut self, reception: &Reception<Message>, output: &mut Output<Message>) {
        let is_for_me = |to: Option<ActorId>| to.is_none_or(|to| to == self.id);
        match reception.frame.message {
            Message::Rumor { to, rumor, .. } if is_for_me(to) => {
                if self.knows(rumor) {
                    output.notes.push(reception.duplicate(RUMOR));
                } else {
                    self.learn(rumor, reception.at, Some(reception.frame.sender), &mut output.notes);
                }
            }
            Message::Request { to, known } if is_for_me(to) => {
                let lacking = self.known & !known;
                let size = self.settings.size;
                let answer = |rumor| Message::Rumor {
                    to: Some(reception.frame.sender),
                    rumor,
                    size,
                };
                output.broadcasts.extend(numbers(lacking).map(answer));
            }
            Message::Rumor { .. } | Message::Request { .. } => {}
        }
    }

    fn knows(&self, rumor: u8) -> bool {
        self.known & (1 << rumor) != 0
    }

    fn learn(&mut self, rumor: u8, at: SimTime, from: Option<ActorId>, notes: &mut Vec<Note>) {
        self.known |= 1 << rumor;
        notes.push(Note::Informed {
            rumor: rumor.into(),
            at,
            from,
        });
    }

    /// Learns what it is the source of.
    fn begin(&mut self, now: SimTime, notes: &mut Vec<Note>) {
        let settings = Rc::clone(&self.settings);
        for (rumor, source) in (0..).zip(&settings.sources) {
            if *source == self.id {
                self.learn(rumor, now, None, notes);
            }
        }
    }

    /// One round: addresses its peers.
    fn round(&mut self, out: &mut Vec<Message>) {
        let settings = Rc::clone(&self.settings);
        for to in settings.addressees(self.id, self.rounds) {
            if settings.mode.pushes() {
                self.push(to, out);
            }
            if settings.mode.pulls() {
                out.push(Message::Request { to, known: self.known });
            }
        }
        self.rounds = self.rounds.wrapping_add(1);
    }

    fn push(&mut self, to: Option<ActorId>, out: &mut Vec<Message>) {
        for rumor in numbers(self.known) {
            let pushed = &mut self.pushed[usize::from(rumor)];
            if *pushed < self.settings.limit {
                *pushed += 1;
                let size = self.settings.size;
                out.push(Message::Rumor { to, rumor, size });
            }
        }
    }

    fn set_timer(&self, now: SimTime, output: &mut Output<Message>) {
        if self.settings.rounds == RoundsConfig::Poisson {
            let pause = self.settings.pause(self.id, self.rounds);
            output.timers.push((NEXT_ROUND, Some(now + pause)));
        }
    }
}

/// The numbers of the bits that are set.
fn numbers(bits: u64) -> impl Iterator<Item = u8> {
    (0..64).filter(move |number| bits & (1 << number) != 0)
}

impl Settings {
    /// Whom `robot` addresses in its round number `round`: a robot, or everyone.
    fn addressees(&self, robot: ActorId, round: u32) -> Vec<Option<ActorId>> {
        let FanOutConfig::Peers(peers) = self.fan_out else {
            return vec![None];
        };
        // Floyd's sample of the others, without repetition: as many draws as peers.
        let mut random = self.peers.at(robot.0, 0, round);
        let others = self.robots.saturating_sub(1);
        let mut drawn = Vec::with_capacity(peers as usize);
        for last in others.saturating_sub(peers)..others {
            let other = below(random.next_u64(), last + 1);
            drawn.push(if drawn.contains(&other) { last } else { other });
        }
        let not_itself = |other: u32| Some(ActorId(other + u32::from(other >= robot.0)));
        drawn.into_iter().map(not_itself).collect()
    }

    /// The time from `robot`'s round number `round` to the next, in Poisson rounds.
    fn pause(&self, robot: ActorId, round: u32) -> Span {
        let [word, _] = self.contacts.first_two(robot.0, 0, round);
        // In (0, 1], so that its logarithm is finite.
        let share = ((word >> 11) + 1) as f64 / (1_u64 << 53) as f64;
        Span::from_secs(-share.ln() * self.interval)
    }
}

impl Protocol for Rumor {
    type Message = Message;
    type Heard = Message;
    type Codec = RumorCodec;
    const TOPICS: &'static [&'static str] = &["rumor", "request"];
    const ROLES: &'static [&'static str] = &["ignorant", "informed"];
    const SENSES_PROXIMITY: bool = false;
    const SENSES_POWER: bool = false;

    fn topic(message: &Message) -> Topic {
        match message {
            Message::Rumor { .. } => RUMOR,
            Message::Request { .. } => REQUEST,
        }
    }

    fn step(&mut self, now: SimTime, input: &mut Input<Message>, output: &mut Output<Message>) {
        let knew = self.known;
        for reception in &input.inbox {
            self.hear(reception, output);
        }
        match input.wake {
            Wake::ControlStep => {
                let settings = Rc::clone(&self.settings);
                output.velocity = self
                    .wander
                    .velocity(&settings.ground, self.id, now, input.pose.position);
                if self.control_steps == 0 {
                    self.begin(now, &mut output.notes);
                    self.set_timer(now, output);
                }
                let periodic = settings.rounds == RoundsConfig::Periodic;
                if periodic && settings.turns.is_due(self.id, self.control_steps) {
                    self.round(&mut output.broadcasts);
                }
                self.control_steps += 1;
            }
            Wake::Timer(_) => {
                self.round(&mut output.broadcasts);
                self.set_timer(now, output);
            }
            Wake::Reception | Wake::Sent => {}
        }
        // After the duplicates, which it heard in the role that it had.
        if self.known != knew && self.known.count_ones() as usize == self.settings.sources.len() {
            output.notes.push(Note::Role(Role(1)));
        }
    }
}

#[cfg(test)]
mod tests;
