//! A swarm over a radio that a test scripts.

use std::collections::BTreeMap;

use crate::engine::{ActorId, SimTime, Span};
use crate::geometry::Vec2;
use crate::protocol::{Address, Protocol};

use super::solo::{Answer, Said, Solo};

/// What becomes of a copy of a message.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fate {
    /// It arrives after so many seconds.
    Arrives(f64),
    /// It does not.
    Lost,
}

/// Says what becomes of the copy of a message: when it is sent, by whom, for whose radio, and what it says.
type Radio<M> = dyn FnMut(SimTime, ActorId, ActorId, &M) -> Fate;

/// What was said: when, by whom, and what.
type Log<M> = Vec<(SimTime, ActorId, Said<M>)>;

/// A message on its way: to whom, from whom, as whose, and what it says.
struct Copy<M> {
    to: ActorId,
    from: ActorId,
    address: Address,
    message: M,
    displacement: Vec2,
}

/// A swarm whose robots hear each other as a test says. All take their control steps together.
///
/// [The module](super) has an example, and so has [the crate's page](crate#test-it). There are no bodies: velocities and what is near are
/// left out, and robots stay where they are [placed](Self::place). Methods that are given the number of a robot that does not exist panic.
///
/// At one instant what arrives is in the inboxes first, then timers run out, then control steps are taken; all robots that wake
/// at one instant answer before any is heard.
pub struct Swarm<P: Protocol> {
    robots: Vec<Solo<P>>,
    is_off: Vec<bool>,
    period: Span,
    steps: u64,
    now: SimTime,
    radio: Box<Radio<P::Heard>>,
    /// By time, and by the order in which they were sent.
    under_way: BTreeMap<(SimTime, u64), Copy<P::Heard>>,
    sent: u64,
    said: Log<P::Heard>,
}

impl<P: Protocol> Swarm<P> {
    /// These robots, numbered from 0, with control steps 0.1 s apart, and a radio over which everybody hears everybody after a
    /// millisecond.
    #[must_use]
    pub fn new(robots: Vec<P>) -> Self {
        let number = robots.len();
        let robots: Vec<Solo<P>> = (0..)
            .zip(robots)
            .map(|(id, robot)| Solo::new(ActorId(id), number, robot))
            .collect();
        Self {
            is_off: vec![false; number],
            robots,
            period: Span::from_secs(0.1),
            steps: 0,
            now: SimTime::ZERO,
            radio: Box::new(|_, _, _, _| Fate::Arrives(0.001)),
            under_way: BTreeMap::new(),
            sent: 0,
            said: Vec::new(),
        }
    }

    /// Sets the time between control steps. To be called before the start.
    ///
    /// # Panics
    /// If it is not above 0.
    pub fn period(&mut self, seconds: f64) {
        self.period = Span::from_secs(seconds);
        assert!(self.period > Span::ZERO, "control steps must be some time apart");
    }

    /// From now on `radio` says what becomes of each copy: when it is sent, by whom, to whom, and what it says.
    pub fn radio(&mut self, radio: impl FnMut(SimTime, ActorId, ActorId, &P::Heard) -> Fate + 'static) {
        self.radio = Box::new(radio);
    }

    /// Puts robot `robot` to a place, metres from the centre.
    pub fn place(&mut self, robot: ActorId, x: f64, y: f64) {
        self.robots[robot.index()].pose.position = Vec2::new(x, y);
    }

    /// Switches a robot off: it takes no step, says and hears nothing. A copy that arrives meanwhile is lost;
    /// what arrived before is read when it is on again.
    pub fn fail(&mut self, robot: ActorId) {
        self.is_off[robot.index()] = true;
    }

    /// Switches it on again, as a run does: it remembers what it knew, and timers that ran out meanwhile wake it at once.
    pub fn recover(&mut self, robot: ActorId) {
        self.is_off[robot.index()] = false;
    }

    /// A robot.
    #[must_use]
    pub fn robot(&self, robot: ActorId) -> &P {
        self.robots[robot.index()].robot()
    }

    /// All robots, in order of their numbers.
    #[must_use]
    pub fn robots(&self) -> Vec<&P> {
        self.robots.iter().map(Solo::robot).collect()
    }

    /// The swarm's time.
    #[must_use]
    pub const fn now(&self) -> SimTime {
        self.now
    }

    /// Everything that was said: when, by whom, and what.
    #[must_use]
    pub fn said(&self) -> &[(SimTime, ActorId, Said<P::Heard>)] {
        &self.said
    }

    /// Runs for so many seconds, to the end of the instant at which they are over.
    pub fn run_for(&mut self, seconds: f64) {
        self.run_until(seconds, |_| false);
    }

    /// Runs until `is_done` of the robots, which is asked after every instant at which one woke: at what time that was, seconds
    /// from the start; `None` if it was not so within so many `seconds` from now.
    pub fn run_until(&mut self, seconds: f64, mut is_done: impl FnMut(&[&P]) -> bool) -> Option<f64> {
        let end = self.now + Span::from_secs(seconds);
        loop {
            let next = self.next();
            if next > end {
                self.now = end;
                return None;
            }
            self.now = next;
            if self.take(next) && is_done(&self.robots()) {
                return Some(next.as_secs());
            }
        }
    }

    /// When something happens next.
    fn next(&self) -> SimTime {
        let arrival = self.under_way.keys().next().map(|(at, _)| *at);
        let timers = self.awake().filter_map(|robot| robot.next_timer().map(|(_, at)| at));
        let step = SimTime::ZERO + self.period * self.steps;
        timers
            .chain(arrival)
            .min()
            .unwrap_or(SimTime::NEVER)
            .min(step)
            .max(self.now)
    }

    fn awake(&self) -> impl Iterator<Item = &Solo<P>> {
        let all = self.robots.iter().zip(&self.is_off);
        all.filter(|(_, is_off)| !**is_off).map(|(robot, _)| robot)
    }

    /// Everything that happens at `now`; whether a robot woke.
    fn take(&mut self, now: SimTime) -> bool {
        while let Some(first) = self.under_way.first_entry() {
            if first.key().0 > now {
                break;
            }
            let copy = first.remove();
            if !self.is_off[copy.to.index()] {
                let robot = &mut self.robots[copy.to.index()];
                robot.go_to(now);
                robot.receive(copy.from, copy.address, copy.message, copy.displacement);
            }
        }
        let is_step = SimTime::ZERO + self.period * self.steps <= now;
        self.steps += u64::from(is_step);
        let mut answers: Vec<(ActorId, Answer<P::Heard>)> = Vec::new();
        for (id, (robot, is_off)) in (0..).zip(self.robots.iter_mut().zip(&self.is_off)) {
            robot.go_to(now);
            if *is_off {
                continue;
            }
            let mut done = robot.expire(now);
            if is_step {
                done.push(robot.control_step());
            }
            answers.extend(done.into_iter().map(|answer| (ActorId(id), answer)));
        }
        let woke = !answers.is_empty();
        for (from, answer) in answers {
            for said in answer.said {
                self.send(now, from, said);
            }
        }
        woke
    }

    fn send(&mut self, now: SimTime, from: ActorId, said: Said<P::Heard>) {
        let here = self.robots[from.index()].pose.position;
        for to in (0..self.robots.len() as u32).map(ActorId).filter(|to| *to != from) {
            let address = match said.to {
                None => Address::Everyone,
                Some(meant) if meant == to => Address::Me,
                Some(_) if P::OVERHEARS => Address::Another,
                Some(_) => continue,
            };
            let Fate::Arrives(seconds) = (self.radio)(now, from, to, &said.message) else {
                continue;
            };
            let copy = Copy {
                to,
                from,
                address,
                message: said.message.clone(),
                displacement: here - self.robots[to.index()].pose.position,
            };
            self.under_way.insert((now + Span::from_secs(seconds), self.sent), copy);
            self.sent += 1;
        }
        self.said.push((now, from, said));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::{Input, Output, Serialised, TimerId, Wake};

    /// Says a number each second, by its timer.
    struct Clock(u8);

    impl Protocol for Clock {
        type Message = u8;
        type Heard = u8;
        type Codec = Serialised<u8>;
        const TOPICS: &'static [&'static str] = &["time"];
        const ROLES: &'static [&'static str] = &["clock"];

        fn step(&mut self, now: SimTime, input: &mut Input<u8>, output: &mut Output<u8>) {
            if input.wake == Wake::Timer(TimerId(0)) || self.0 == 0 {
                self.0 += 1;
                output.broadcast(self.0);
                output.set_timer(TimerId(0), now + Span::from_secs(1.0));
            }
        }
    }

    #[test]
    fn who_recovers_wakes_at_once_for_timers_that_ran_out_meanwhile_and_goes_on() {
        let mut swarm = Swarm::new(vec![Clock(0), Clock(0)]);
        swarm.run_for(1.5);
        swarm.fail(ActorId(0));
        swarm.run_for(3.0);
        swarm.recover(ActorId(0));
        swarm.run_for(1.2);
        let said = swarm.said().iter().filter(|(_, from, _)| *from == ActorId(0));
        let times: Vec<f64> = said.map(|(at, _, _)| at.as_secs()).collect();
        assert_eq!(times, [0.0, 1.0, 4.5, 5.5]);
    }
}
