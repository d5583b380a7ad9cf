//! Why robots are what they are: their changes of role, whom they rely on, and what they had just read.

use std::collections::HashMap;

use crate::engine::{ActorId, SimTime};
use crate::happenings::{Copy, Sent};
use crate::protocol::{Layout, Meaning, Note, Topic, Value};

/// A message that a robot read.
#[derive(Clone, Debug)]
pub struct Read {
    pub sender: ActorId,
    pub topic: Topic,
    pub payload: Vec<u8>,
}

impl Read {
    /// What it says, if it names `robot`, in the words of the `layout`.
    pub fn to(&self, robot: ActorId, layout: &Layout) -> Option<String> {
        let content = layout.read(&self.payload);
        let names_it = content
            .fields
            .iter()
            .any(|(field, value)| field.meaning == Meaning::Robot && *value == Value::Number(robot.0.into()));
        names_it.then(|| content.to_string())
    }
}

/// A robot that took another role.
#[derive(Clone, Debug)]
pub struct Change {
    pub at: SimTime,
    pub robot: ActorId,
    pub from: u8,
    pub to: u8,
    /// Whom it relied on until then.
    pub relied: Vec<ActorId>,
    /// What it read at that instant, but statuses.
    pub read: Vec<Read>,
}

/// All of a run.
#[derive(Debug, Default)]
pub struct Changes {
    pub roles: Vec<Change>,
    /// Since when which robot relies on which others.
    pub relies: Vec<(SimTime, ActorId, Vec<ActorId>)>,
    status: Option<Topic>,
    /// Of each robot its role, whom it relies on, when it last read something, and what.
    present: Vec<Present>,
    /// Of messages that are no statuses and have copies yet to be read: their payload and how many. Asked by key alone.
    said: HashMap<(ActorId, u32), (Vec<u8>, u64)>,
}

#[derive(Clone, Debug, Default)]
struct Present {
    role: u8,
    relies: Vec<ActorId>,
    read_at: SimTime,
    read: Vec<Read>,
}

impl Changes {
    /// Nothing yet, of a run with so many robots.
    pub fn begin(&mut self, robots: usize, status: Option<Topic>) {
        self.present = vec![Present::default(); robots];
        self.status = status;
    }

    pub fn sent(&mut self, message: &Sent<'_>) {
        if Some(message.topic) != self.status && message.copies > 0 {
            let key = (message.sender, message.sequence);
            self.said.insert(key, (message.payload.to_vec(), message.copies));
        }
    }

    /// A copy has met its fate, and was read at that instant if it was.
    pub fn settled(&mut self, copy: &Copy, read: Option<SimTime>) {
        if Some(copy.topic) == self.status {
            return;
        }
        let key = (copy.sender, copy.sequence);
        let Some((payload, left)) = self.said.get_mut(&key) else {
            return;
        };
        if let Some(read) = read {
            let present = &mut self.present[copy.receiver.index()];
            if present.read_at != read {
                present.read.clear();
                present.read_at = read;
            }
            present.read.push(Read {
                sender: copy.sender,
                topic: copy.topic,
                payload: payload.clone(),
            });
        }
        *left -= 1;
        if *left == 0 {
            self.said.remove(&key);
        }
    }

    pub fn noted(&mut self, now: SimTime, robot: ActorId, note: &Note) {
        let present = &mut self.present[robot.index()];
        match note {
            Note::Role(role) => {
                let from = std::mem::replace(&mut present.role, role.0);
                let read = if present.read_at == now {
                    present.read.clone()
                } else {
                    Vec::new()
                };
                self.roles.push(Change {
                    at: now,
                    robot,
                    from,
                    to: role.0,
                    relied: present.relies.clone(),
                    read,
                });
            }
            Note::Parents(parents) => {
                present.relies.clone_from(parents);
                self.relies.push((now, robot, parents.clone()));
            }
            _ => {}
        }
    }
}
