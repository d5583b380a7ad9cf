//! Whom a robot that runs SWIM knows, and what it believes of them.

use rand::RngExt as _;
use rand_philox::Philox;

use super::message::{Claim, News};
use crate::engine::{ActorId, SimTime};
use crate::protocol::robot_table::{RobotRow, RobotTable};
use crate::protocol::{Evidence, Note, Output, Reception};

/// A robot that was heard at some time.
#[derive(Debug)]
pub struct Member {
    /// Who.
    pub id: ActorId,
    /// Its incarnation, as far as it is known.
    pub incarnation: u32,
    /// What is believed of it.
    pub belief: Belief,
    /// When its last frame arrived.
    pub heard: SimTime,
    /// The newest of its frames that arrived.
    sequence: u32,
}

/// What is believed of a member.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Belief {
    /// It is alive.
    Alive,
    /// It is down unless it denies that before this instant.
    Suspected(SimTime),
    /// It is down, since then.
    Down(SimTime),
}

impl RobotRow for Member {
    fn robot(&self) -> ActorId {
        self.id
    }
}

impl Member {
    /// What this robot would tell others of it.
    pub fn news(&self) -> News {
        News {
            about: self.id,
            claim: match self.belief {
                Belief::Alive => Claim::Alive,
                Belief::Suspected(_) => Claim::Suspected,
                Belief::Down(_) => Claim::Down,
            },
            incarnation: self.incarnation,
        }
    }

    /// Whether it is down.
    pub const fn is_down(&self) -> bool {
        matches!(self.belief, Belief::Down(_))
    }

    /// Takes it for down from `now` on.
    pub fn bury<M>(&mut self, now: SimTime, evidence: Evidence, output: &mut Output<M>) {
        self.belief = Belief::Down(now);
        output.notes.push(Note::Suspects {
            robot: self.id,
            heard: self.heard,
            sequence: self.sequence,
            evidence,
        });
    }
}

/// All members, and the order in which they are probed.
#[derive(Debug, Default)]
pub struct Members {
    rows: RobotTable<Member>,
    /// Those that are still to be probed in this round, the next one last.
    round: Vec<ActorId>,
}

impl Members {
    /// A frame of a robot arrived: it is known from now on, and not down. Whether that is new.
    pub fn hear<H, M>(&mut self, frame: &Reception<H>, output: &mut Output<M>) -> bool {
        let id = frame.frame.sender;
        let sequence = frame.frame.sequence;
        let Some(member) = self.rows.get_mut(id) else {
            self.rows.add(Member {
                id,
                incarnation: 0,
                belief: Belief::Alive,
                heard: frame.at,
                sequence,
            });
            output.notes.push(Note::Watches(id));
            return true;
        };
        member.heard = frame.at;
        if sequence.wrapping_sub(member.sequence).cast_signed() > 0 {
            member.sequence = sequence;
        }
        let is_back = member.is_down();
        if is_back {
            member.belief = Belief::Alive;
            // Older claims, which still go round, do not concern it.
            member.incarnation = member.incarnation.saturating_add(1);
            output.notes.push(Note::Trusts(id));
        }
        is_back
    }

    /// What is known of `robot`.
    pub fn get(&self, robot: ActorId) -> Option<&Member> {
        self.rows.get(robot)
    }

    /// The same, to be changed.
    pub fn get_mut(&mut self, robot: ActorId) -> Option<&mut Member> {
        self.rows.get_mut(robot)
    }

    /// All of them.
    pub fn iter(&self) -> std::slice::Iter<'_, Member> {
        self.rows.iter()
    }

    /// All of them, to be changed.
    pub fn iter_mut(&mut self) -> std::slice::IterMut<'_, Member> {
        self.rows.iter_mut()
    }

    /// The next one to be probed: each once a round, in an order drawn anew for every round (SWIM section 4.3).
    pub fn next_target(&mut self, random: &mut Philox) -> Option<ActorId> {
        if self.rows.iter().all(Member::is_down) {
            return None;
        }
        loop {
            let Some(robot) = self.round.pop() else {
                self.round.extend(self.rows.iter().map(|member| member.id));
                shuffle(&mut self.round, random);
                continue;
            };
            if self.get(robot).is_some_and(|member| !member.is_down()) {
                return Some(robot);
            }
        }
    }

    /// Up to `count` members to probe `target` through, drawn at random among those believed to be alive.
    pub fn proxies(&self, target: ActorId, count: usize, random: &mut Philox) -> Vec<ActorId> {
        let alive = self.rows.iter().filter(|member| member.belief == Belief::Alive);
        let mut proxies: Vec<_> = alive.map(|member| member.id).filter(|id| *id != target).collect();
        shuffle(&mut proxies, random);
        proxies.truncate(count);
        proxies
    }
}

fn shuffle<T>(items: &mut [T], random: &mut Philox) {
    for last in (1..items.len()).rev() {
        items.swap(last, random.random_range(0..=last));
    }
}
