//! What a robot answers: messages, timers, a velocity, and notes for the metrics.

use crate::engine::{ActorId, SimTime};
use crate::geometry::Vec2;

use super::names::{MessageSize, Role, TimerId, Topic};

/// What a robot answers when it has woken. `M` is [`Protocol::Message`](super::Protocol::Message).
///
/// ```
/// use desim::engine::{ActorId, SimTime, Span};
/// use desim::protocol::{Output, TimerId};
///
/// const AGAIN: TimerId = TimerId(0);
///
/// fn answer(now: SimTime, output: &mut Output<&'static str>) {
///     output.broadcast("hello"); // to all in range
///     output.send(ActorId(3), "you too"); // to robot 3
///     output.set_timer(AGAIN, now + Span::from_secs(2.5)); // wakes with `Wake::Timer(AGAIN)`
///     output.count("greetings", 2); // read by a `NotedFigure`
///     output.measure("battery_V", 11.7);
/// }
/// # answer(SimTime::ZERO, &mut Output::default());
/// ```
#[derive(Debug)]
pub struct Output<M> {
    /// Messages to broadcast, in order.
    pub broadcasts: Vec<M>,
    /// Messages to one robot each, in order; each knows its place among the broadcasts.
    pub sends: Vec<Directed<M>>,
    /// The velocity it wants from now on, in the arena's axes, m/s; `None` keeps the last one. The robot goes as fast as `motion.max_speed`
    /// lets it; one that is not finite asks to stand.
    pub velocity: Option<Vec2>,
    /// Timers to set (`Some`, replacing the pending one of that id) or to cancel (`None`).
    pub timers: Vec<(TimerId, Option<SimTime>)>,
    /// What the metrics should know.
    pub notes: Vec<Note>,
}

impl<M> Default for Output<M> {
    fn default() -> Self {
        Self {
            broadcasts: Vec::new(),
            sends: Vec::new(),
            velocity: None,
            timers: Vec::new(),
            notes: Vec::new(),
        }
    }
}

impl<M> Output<M> {
    /// Broadcasts `message` to all in range.
    pub fn broadcast(&mut self, message: M) {
        self.broadcasts.push(message);
    }

    /// Sends `message` to the robot `to`, another one of the swarm: the run ends with an error else. It crosses the air as a
    /// broadcast does and arrives at `to` alone, unless robots [overhear](super::Protocol::OVERHEARS). Broadcasts and sends go out in the order in
    /// which they were said. Whether it arrived nobody tells over the disk radio; what a shared radio knows of it, a robot
    /// that [heeds outcomes](super::Protocol::HEEDS_OUTCOMES) learns.
    pub fn send(&mut self, to: ActorId, message: M) {
        self.sends.push(Directed {
            to,
            after: self.broadcasts.len(),
            message,
        });
    }

    /// Enters `role`, one of the protocol's [`ROLES`](super::Protocol::ROLES) by its place there: traffic is accounted by it, and faults can
    /// choose robots by it.
    pub fn enter(&mut self, role: Role) {
        self.notes.push(Note::Role(role));
    }

    /// Sets the timer `id`, or moves it: the robot wakes once at `at`, at once if that is past, with
    /// [`Wake::Timer`](super::Wake::Timer).
    pub fn set_timer(&mut self, id: TimerId, at: SimTime) {
        self.timers.push((id, Some(at)));
    }

    /// Cancels the timer `id`, if it is set.
    pub fn cancel_timer(&mut self, id: TimerId) {
        self.timers.push((id, None));
    }

    /// Adds `n` to what this robot counts under `name`, for figures ([`NotedFigure`](crate::metrics::NotedFigure)) and the table of notes.
    pub fn count(&mut self, name: &'static str, n: u64) {
        self.notes.push(Note::Count { name, n });
    }

    /// Notes a `value` of what this robot measures as `name`, for figures ([`NotedFigure`](crate::metrics::NotedFigure)) and the table of
    /// notes: in whatever unit, but finite, or the run ends with an error.
    pub fn measure(&mut self, name: &'static str, value: f64) {
        self.notes.push(Note::Value { name, value });
    }

    /// Whether it says anything.
    #[must_use]
    pub fn says(&self) -> bool {
        !(self.broadcasts.is_empty() && self.sends.is_empty())
    }

    /// Takes out what it says, in the order in which it was said: each message, and the robot that it is for if it is for one.
    pub fn drain_said(&mut self) -> impl Iterator<Item = (Option<ActorId>, M)> {
        let mut broadcasts = self.broadcasts.drain(..);
        let mut sends = self.sends.drain(..).peekable();
        let mut said = 0;
        std::iter::from_fn(move || {
            let one = sends.next_if(|send| send.after <= said);
            if one.is_none() {
                said += 1;
            }
            one.map(Directed::into_said)
                .or_else(|| Some((None, broadcasts.next()?)))
                .or_else(|| sends.next().map(Directed::into_said))
        })
    }

    /// Empties it and keeps its buffers.
    pub fn clear(&mut self) {
        self.broadcasts.clear();
        self.sends.clear();
        self.velocity = None;
        self.timers.clear();
        self.notes.clear();
    }
}

/// A message to one robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Directed<M> {
    /// For whom.
    pub to: ActorId,
    /// How many broadcasts of the same wake go before it.
    pub after: usize,
    /// What it says.
    pub message: M,
}

impl<M> Directed<M> {
    fn into_said(self) -> (Option<ActorId>, M) {
        (Some(self.to), self.message)
    }
}

/// Something about a robot that metrics follow. A robot reports a change once, when it happens.
#[derive(Clone, Debug, PartialEq)]
pub enum Note {
    /// It now has this role.
    Role(Role),
    /// It now works for this target (an index into the mission's targets), or for none.
    Target(Option<u16>),
    /// These are now the robots that it relies on to reach the root: a worker has one a link, a relay one.
    Parents(Vec<ActorId>),
    /// It heard this robot for the first time, and has its failure detector watch and trust it from now on.
    Watches(ActorId),
    /// It now believes that a robot that it watches is down.
    Suspects {
        /// Which.
        robot: ActorId,
        /// When that robot's last status arrived; with a detector that probes, its last frame.
        heard: SimTime,
        /// The newest of that robot's frames that arrived, by its number among them.
        sequence: u32,
        /// What it goes by.
        evidence: Evidence,
    },
    /// It believes so no longer.
    Trusts(ActorId),
    /// It read a message that told it nothing new ([`Reception::duplicate`](super::Reception::duplicate)), in the role that it had last reported: to be noted
    /// before a change of role.
    Duplicate {
        /// Its topic.
        topic: Topic,
        /// How long it is.
        size: MessageSize,
    },
    /// It knows this rumour since then.
    Informed {
        /// The rumour, from 0.
        rumor: u16,
        /// When it arrived, or was begun here.
        at: SimTime,
        /// Whom it heard it from; `None` if it was begun here.
        from: Option<ActorId>,
    },
    /// Something happened `n` times more ([`Output::count`]).
    Count {
        /// What it is called.
        name: &'static str,
        /// How often.
        n: u64,
    },
    /// It measured something ([`Output::measure`]).
    Value {
        /// What it is called.
        name: &'static str,
        /// How much it is, a finite number.
        value: f64,
    },
}

/// What a suspicion goes by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evidence {
    /// The robot was not heard for too long.
    Silence,
    /// The robot did not answer probes in time, or others say so.
    Probes,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_goes_out_in_the_order_in_which_it_was_said() {
        let mut output = Output::default();
        output.send(ActorId(5), 'a');
        output.broadcast('b');
        output.broadcast('c');
        output.send(ActorId(7), 'd');
        output.send(ActorId(5), 'e');
        output.broadcast('f');
        output.send(ActorId(6), 'g');
        assert!(output.says());
        let said: Vec<_> = output.drain_said().collect();
        let to = |robot| Some(ActorId(robot));
        let expected = [
            (to(5), 'a'),
            (None, 'b'),
            (None, 'c'),
            (to(7), 'd'),
            (to(5), 'e'),
            (None, 'f'),
            (to(6), 'g'),
        ];
        assert_eq!(said, expected);
        assert!(!output.says());
    }

    #[test]
    fn a_send_whose_broadcasts_were_taken_back_is_said_all_the_same() {
        let mut output = Output::default();
        output.broadcast('a');
        output.broadcast('b');
        output.send(ActorId(1), 'c');
        output.broadcasts.clear();
        let said: Vec<_> = output.drain_said().collect();
        assert_eq!(said, [(Some(ActorId(1)), 'c')]);
    }
}
