//! All faults of a run.

use rand::RngExt as _;

use super::config::{Effect, FaultConfig};
use super::link::{LinkFault, LinkFaultKind};
use super::robot::RobotFault;
use crate::engine::{ActorId, KeyedStreams, Purpose, SimTime, Span, Streams};
use crate::geometry::Vec2;

/// Whether a fault of links stops a copy: one uniform number a copy.
const LINK: Purpose = Purpose::new("faults.link");

/// What a robot can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Health {
    /// Whether its radio sends.
    pub sends: bool,
    /// Whether its radio hears.
    pub hears: bool,
    /// Whether it thinks and moves.
    pub acts: bool,
}

impl Health {
    /// A robot that nothing ails.
    pub const WELL: Self = Self {
        sends: true,
        hears: true,
        acts: true,
    };

    /// Whether its radio does all that a radio does: a live robot, a node of the swarm's graph.
    #[must_use]
    pub const fn is_live(self) -> bool {
        self.sends && self.hears
    }
}

/// What a fault befalls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// A robot.
    Robot {
        /// Which.
        robot: ActorId,
        /// What fails or is well again.
        effect: Effect,
        /// What it can do from now on, all faults considered.
        health: Health,
    },
    /// Links.
    Links(LinkFaultKind),
}

/// A fault begins or ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Change {
    /// The fault's place in the scenario's list, from 0.
    pub fault: u16,
    /// Whether it begins; else it ends.
    pub begins: bool,
    /// What it befalls.
    pub subject: Subject,
}

/// How many faults ail a robot, by what they keep it from.
#[derive(Clone, Copy, Debug, Default)]
struct Ailments {
    mute: u16,
    deaf: u16,
    stopped: u16,
}

impl Ailments {
    fn add(&mut self, effect: Effect, begins: bool) {
        let Self { mute, deaf, stopped } = self;
        let ailments: &mut [&mut u16] = match effect {
            Effect::Silence => &mut [mute, deaf],
            Effect::Crash | Effect::Battery => &mut [mute, deaf, stopped],
            Effect::Mute => &mut [mute],
            Effect::Deaf => &mut [deaf],
        };
        for count in ailments {
            **count = if begins { **count + 1 } else { **count - 1 };
        }
    }

    fn health(self) -> Health {
        Health {
            sends: self.mute == 0,
            hears: self.deaf == 0,
            acts: self.stopped == 0,
        }
    }
}

/// A fault and its place in the scenario's list.
type Numbered<F> = (u16, F);

/// The faults of one run.
#[derive(Debug)]
pub struct Faults {
    robots: Vec<Numbered<RobotFault>>,
    links: Vec<Numbered<LinkFault>>,
    ailments: Vec<Ailments>,
    now: SimTime,
    next: SimTime,
    draws: KeyedStreams,
    /// The number behind those of the scenario's faults: that of empty batteries.
    batteries: u16,
    /// Whether any battery is empty.
    exhausted: bool,
}

impl Faults {
    /// The faults of `config` among `robots` robots that all start in the first of `roles`, drawing from the `streams` of
    /// their trial.
    ///
    /// # Panics
    /// If `config` has [`problems`](super::problems): a scenario is checked before it is run.
    #[must_use]
    pub fn new(config: &[FaultConfig], roles: &[&str], robots: usize, control_period: Span, streams: Streams) -> Self {
        let problems = super::problems(config, robots as u32, roles);
        assert!(problems.is_empty(), "the faults are unusable: {problems:?}");
        let numbered = || (0_u16..).zip(config);
        let robot = |(index, fault): (u16, &FaultConfig)| {
            let general = fault.of_robots()?;
            let number = u32::from(index);
            Some((
                index,
                RobotFault::new(&general, number, roles, robots, control_period, streams),
            ))
        };
        let mut faults = Self {
            robots: numbered().filter_map(robot).collect(),
            links: numbered()
                .filter_map(|(index, fault)| Some((index, LinkFault::new(fault)?)))
                .collect(),
            ailments: vec![Ailments::default(); robots],
            now: SimTime::ZERO,
            next: SimTime::NEVER,
            draws: streams.keyed(LINK),
            batteries: config.len() as u16,
            exhausted: false,
        };
        faults.plan();
        faults
    }

    /// When [`advance`](Self::advance) must be called next; `NEVER` if nothing can happen. Nothing need happen then: a robot
    /// that was to fail may have left its role.
    #[must_use]
    pub fn next(&self) -> SimTime {
        self.next
    }

    /// `robot` takes `role` at `now`. [`next`](Self::next) may come forward.
    ///
    /// # Panics
    /// If the protocol has no such role.
    pub fn enter(&mut self, now: SimTime, robot: ActorId, role: u8) {
        for (_, fault) in &mut self.robots {
            self.next = self.next.min(fault.enter(now, robot, role));
        }
    }

    /// Lets happen what is due at `now`, with the robots at `places`, and adds it to `changes`: by fault, then by robot.
    pub fn advance(&mut self, now: SimTime, places: &[Vec2], changes: &mut Vec<Change>) {
        let ailments = &mut self.ailments;
        for (number, fault) in &mut self.robots {
            let effect = fault.effect;
            fault.advance(now, places, |robot, begins| {
                let mine = &mut ailments[robot.index()];
                mine.add(effect, begins);
                changes.push(Change {
                    fault: *number,
                    begins,
                    subject: Subject::Robot {
                        robot,
                        effect,
                        health: mine.health(),
                    },
                });
            });
        }
        for (number, fault) in &mut self.links {
            if fault.advance(now) {
                changes.push(Change {
                    fault: *number,
                    begins: fault.active,
                    subject: Subject::Links(fault.kind()),
                });
            }
        }
        self.now = now;
        self.plan();
    }

    /// The battery of `robot` is empty: it fails for good.
    pub fn exhaust(&mut self, robot: ActorId) -> Change {
        self.exhausted = true;
        let mine = &mut self.ailments[robot.index()];
        mine.add(Effect::Battery, true);
        Change {
            fault: self.batteries,
            begins: true,
            subject: Subject::Robot {
                robot,
                effect: Effect::Battery,
                health: mine.health(),
            },
        }
    }

    /// What `robot` can do.
    #[inline]
    #[must_use]
    pub fn health(&self, robot: ActorId) -> Health {
        // Every wake asks: where no robot ever fails, nothing is looked up.
        if self.robots.is_empty() && !self.exhausted {
            return Health::WELL;
        }
        self.ailments[robot.index()].health()
    }

    /// Whether any link is in trouble.
    #[must_use]
    pub fn trouble_links(&self) -> bool {
        self.links.iter().any(|(_, fault)| fault.active)
    }

    /// Probability that the faults of links stop a copy between two robots, each given with its place.
    #[must_use]
    pub fn link_loss(&self, sender: (ActorId, Vec2), receiver: (ActorId, Vec2)) -> f64 {
        let active = self.links.iter().filter(|(_, fault)| fault.active);
        let passes: f64 = active.map(|(_, fault)| 1.0 - fault.loss(sender, receiver)).product();
        1.0 - passes
    }

    /// Whether frame number `sequence` of `sender` is stopped on its way to `receiver`, on a link of this
    /// [`link_loss`](Self::link_loss).
    #[must_use]
    pub fn stops(&self, loss: f64, sender: ActorId, receiver: ActorId, sequence: u32) -> bool {
        loss > 0.0 && self.draws.at(sender.0, receiver.0, sequence).random::<f64>() < loss
    }

    fn plan(&mut self) {
        let robots = self.robots.iter().map(|(_, fault)| fault.next(self.now));
        let links = self.links.iter().map(|(_, fault)| fault.next());
        self.next = robots.chain(links).min().unwrap_or(SimTime::NEVER);
    }
}
