//! SWIM with its suspicion mechanism and Lifeguard's awareness.
//!
//! Once a probe interval a robot pings one of those it knows. Without an acknowledgement within the probe timeout it asks
//! others to ping that robot too and to pass the acknowledgement on. If none comes by the end of the interval, the robot is
//! suspected, and everybody is told; if it does not deny that in time, with a higher incarnation, it is taken for down (Das,
//! Gupta and Motivala, *SWIM: scalable weakly-consistent infection-style process group membership protocol*, DSN 2002). A robot
//! whose own probes fail, or that has to deny a suspicion, is perhaps itself not well: it stretches its intervals until its
//! probes succeed again (Dadgar, Phillips and Currey, *Lifeguard: local health awareness for more accurate failure detection*,
//! DSN-W 2018; its nacks and its shrinking suspicion timeout are left out).
//!
//! On a radio, with robots that move, this is how it differs:
//! - All messages are broadcasts. One request names all whom it asks; the news in a message is for whoever hears it.
//! - A robot probes those that it has heard, for whom it cannot hear it cannot probe. One that it has not heard for the leave
//!   timeout counts as out of range: down, but nobody is told.
//! - A robot that is down is back as soon as a frame of it arrives: own ears beat hearsay.
//!
//! What the detector notes and what a protocol asks it for is who is *down*; a suspicion as SWIM has it is not visible yet.

mod config;
mod gossip;
mod members;
mod message;
#[cfg(test)]
mod tests;

pub use config::SwimConfig;
pub use message::{Call, Claim, News, Probe};

use std::borrow::Borrow;

use rand_philox::Philox;

use super::{Circumstances, Monitored, Sign, TIMER};
use crate::engine::{ActorId, SimTime, Span};
use crate::protocol::control::{Phases, Rhythm};
use crate::protocol::{Evidence, Output, Reception};
use gossip::Gossip;
use members::{Belief, Member, Members};

/// One robot's side of SWIM.
#[derive(Debug)]
pub struct Swim {
    id: ActorId,
    interval: Span,
    /// From the first robot heard until the first ping.
    phase: Span,
    timeout: Span,
    /// What the interval leaves to others once they are asked.
    patience: Span,
    leave: Span,
    suspicion: Span,
    indirect_checks: usize,
    max_awareness: u64,
    /// How often the robot denied that it was down.
    incarnation: u32,
    /// Lifeguard's local health multiplier less one: 0 in good health.
    awareness: u64,
    members: Members,
    gossip: Gossip,
    probe: Option<Ongoing>,
    /// Number of the last ping.
    number: u16,
    /// Pings on behalf of others.
    errands: Vec<Errand>,
    /// When the timer fires.
    armed: SimTime,
}

/// The probe of this period.
#[derive(Debug)]
struct Ongoing {
    /// Who is probed; nobody in the period before the first.
    target: Option<ActorId>,
    number: u16,
    acknowledged: bool,
    /// When others are asked; `NEVER` once they were.
    ask: SimTime,
    end: SimTime,
}

/// A ping on behalf of another robot.
#[derive(Debug)]
struct Errand {
    /// Number of the ping.
    number: u16,
    asker: ActorId,
    /// Number of the asker's probe.
    for_number: u16,
    /// When nobody waits for it any more.
    until: SimTime,
}

impl Swim {
    /// The side of robot `id`, which knows nobody yet.
    pub fn new(config: &SwimConfig, circumstances: Circumstances, phases: Phases, id: ActorId) -> Self {
        let robots = circumstances.robots;
        let (interval_s, timeout_s) = (config.probe_interval.get(), config.probe_timeout.get());
        let interval = Span::from_secs(interval_s);
        Self {
            id,
            interval,
            phase: phases.span(id, Rhythm::Probe, interval),
            timeout: Span::from_secs(timeout_s),
            patience: Span::from_secs(interval_s - timeout_s),
            leave: Span::from_secs(config.leave_timeout.get()),
            suspicion: config.suspicion_timeout(robots),
            indirect_checks: config.indirect_checks.into(),
            max_awareness: config.max_awareness.into(),
            incarnation: 0,
            awareness: 0,
            members: Members::default(),
            gossip: Gossip::new(config.retransmits(robots), config.news_per_message.into()),
            probe: None,
            number: 0,
            errands: Vec::new(),
            armed: SimTime::NEVER,
        }
    }

    /// When `robot` came to be taken for down; `NEVER` if it is not.
    pub fn suspected_since(&self, robot: ActorId) -> SimTime {
        match self.members.get(robot).map(|member| member.belief) {
            Some(Belief::Down(since)) => since,
            Some(Belief::Alive | Belief::Suspected(_)) | None => SimTime::NEVER,
        }
    }

    /// Takes in what has arrived by `now`, and answers.
    pub fn read<H, M>(&mut self, now: SimTime, inbox: &[Reception<H>], output: &mut Output<M>)
    where
        H: Borrow<M>,
        M: Monitored,
    {
        for reception in inbox {
            let sign = reception.frame.message.borrow().sign();
            if matches!(sign, Sign::Other) {
                continue;
            }
            if self.members.hear(reception, output) {
                self.gossip.forget(reception.frame.sender);
                self.begin(now);
            }
            if let Sign::Probe(probe) = sign {
                for news in &probe.news {
                    self.learn(now, *news, output);
                }
                self.answer(now, reception.frame.sender, probe, output);
            }
        }
        self.arm(output);
    }

    /// The timer fired, and the robot has read all that arrived.
    pub fn expire<M: Monitored>(&mut self, now: SimTime, random: &mut Philox, output: &mut Output<M>) {
        self.armed = SimTime::NEVER;
        self.give_up(now, output);
        if self.probe.as_ref().is_some_and(|probe| probe.ask <= now) {
            self.ask_others(now, random, output);
        }
        if self.probe.as_ref().is_some_and(|probe| probe.end <= now) {
            self.conclude(now, output);
            self.ping_next(now, random, output);
        }
        self.arm(output);
    }

    /// Begins to probe, if it has not yet, at the robot's phase of its interval.
    fn begin(&mut self, now: SimTime) {
        if self.probe.is_none() {
            self.probe = Some(Ongoing {
                target: None,
                number: self.number,
                acknowledged: true,
                ask: SimTime::NEVER,
                end: now + self.phase,
            });
        }
    }

    /// Pings the next member, and ends the last period.
    fn ping_next<M: Monitored>(&mut self, now: SimTime, random: &mut Philox, output: &mut Output<M>) {
        let target = self.members.next_target(random);
        let stretch = self.awareness + 1;
        let number = self.next_number();
        self.probe = target.map(|target| Ongoing {
            target: Some(target),
            number,
            acknowledged: false,
            ask: now + self.timeout * stretch,
            end: now + self.interval * stretch,
        });
        if let Some(to) = target {
            self.ping(to, number, output);
        }
    }

    fn ping<M: Monitored>(&mut self, to: ActorId, number: u16, output: &mut Output<M>) {
        // Who is suspected has to hear of it, or it cannot deny it.
        let target = self.members.get(to);
        let suspicion = target.filter(|member| matches!(member.belief, Belief::Suspected(_)));
        let first = suspicion.map(Member::news);
        self.say(Call::Ping { to }, number, first, output);
    }

    fn ask_others<M: Monitored>(&mut self, now: SimTime, random: &mut Philox, output: &mut Output<M>) {
        let Some(probe) = &mut self.probe else { return };
        probe.ask = SimTime::NEVER;
        // A robot that was asleep meanwhile gives them time all the same.
        probe.end = probe.end.max(now + self.patience);
        let (number, acknowledged) = (probe.number, probe.acknowledged);
        let Some(target) = probe.target.filter(|_| !acknowledged) else {
            return;
        };
        let to = self.members.proxies(target, self.indirect_checks, random);
        if !to.is_empty() {
            self.say(Call::Request { to, target }, number, None, output);
        }
    }

    /// The period is over.
    fn conclude<M: Monitored>(&mut self, now: SimTime, output: &mut Output<M>) {
        let Some(probe) = &self.probe else { return };
        let (target, acknowledged) = (probe.target, probe.acknowledged);
        self.errands.retain(|errand| errand.until > now);
        let Some(target) = target.filter(|_| !acknowledged) else {
            return;
        };
        self.doubt_itself();
        let Some(member) = self.members.get_mut(target) else {
            return;
        };
        if member.belief == Belief::Alive {
            member.belief = Belief::Suspected(now + self.suspicion);
            self.gossip.spread(member.news());
            self.give_up(now, output);
        }
    }

    /// Takes those for down whose time to deny it is over, and those that have not been heard for long.
    fn give_up<M: Monitored>(&mut self, now: SimTime, output: &mut Output<M>) {
        for member in self.members.iter_mut() {
            match member.belief {
                Belief::Suspected(until) if until <= now => {
                    member.bury(now, Evidence::Probes, output);
                    self.gossip.spread(member.news());
                }
                Belief::Alive | Belief::Suspected(_) if member.heard + self.leave <= now => {
                    member.bury(now, Evidence::Silence, output);
                }
                Belief::Alive | Belief::Suspected(_) | Belief::Down(_) => {}
            }
        }
    }

    /// Takes in a claim, and passes it on if it is new.
    fn learn<M>(&mut self, now: SimTime, news: News, output: &mut Output<M>) {
        if news.about == self.id {
            if news.claim != Claim::Alive && news.incarnation >= self.incarnation {
                self.deny(news.incarnation);
            }
            return;
        }
        // Whom it never heard it cannot judge.
        let Some(member) = self.members.get_mut(news.about).filter(|member| !member.is_down()) else {
            return;
        };
        let is_newer = news.incarnation > member.incarnation;
        let is_suspected = member.belief != Belief::Alive;
        let holds = match news.claim {
            Claim::Alive => is_newer,
            Claim::Suspected => is_newer || (news.incarnation == member.incarnation && !is_suspected),
            Claim::Down => news.incarnation >= member.incarnation,
        };
        if !holds {
            return;
        }
        member.incarnation = news.incarnation;
        match news.claim {
            Claim::Alive => member.belief = Belief::Alive,
            Claim::Suspected => member.belief = Belief::Suspected(now + self.suspicion),
            Claim::Down => member.bury(now, Evidence::Probes, output),
        }
        self.gossip.spread(news);
    }

    /// Denies that it is down, as was claimed of its `incarnation`.
    fn deny(&mut self, incarnation: u32) {
        self.incarnation = incarnation.saturating_add(1);
        self.doubt_itself();
        self.gossip.spread(News {
            about: self.id,
            claim: Claim::Alive,
            incarnation: self.incarnation,
        });
    }

    fn doubt_itself(&mut self) {
        self.awareness = (self.awareness + 1).min(self.max_awareness.saturating_sub(1));
    }

    /// Does what `sender` asks, if it asks this robot, and takes in what it answers.
    fn answer<M: Monitored>(&mut self, now: SimTime, sender: ActorId, probe: &Probe, output: &mut Output<M>) {
        let number = probe.number;
        match &probe.call {
            Call::Ping { to } if *to == self.id => self.say(Call::Ack { to: sender }, number, None, output),
            Call::Request { to, target } if to.contains(&self.id) => {
                let errand = Errand {
                    number: self.next_number(),
                    asker: sender,
                    for_number: number,
                    until: now + self.interval * self.max_awareness,
                };
                self.ping(*target, errand.number, output);
                self.errands.push(errand);
            }
            Call::Ack { to } if *to == self.id => self.acknowledged(number, output),
            Call::Ping { .. } | Call::Request { .. } | Call::Ack { .. } => {}
        }
    }

    /// The ping with this number was acknowledged, or another robot's on this one's behalf.
    fn acknowledged<M: Monitored>(&mut self, number: u16, output: &mut Output<M>) {
        if let Some(errand) = self.errands.iter().position(|errand| errand.number == number) {
            let Errand { asker, for_number, .. } = self.errands.swap_remove(errand);
            self.say(Call::Ack { to: asker }, for_number, None, output);
        }
        if let Some(probe) = self.probe.as_mut().filter(|probe| probe.number == number)
            && !std::mem::replace(&mut probe.acknowledged, true)
        {
            probe.ask = SimTime::NEVER;
            self.awareness = self.awareness.saturating_sub(1);
        }
    }

    fn say<M: Monitored>(&mut self, call: Call, number: u16, first: Option<News>, output: &mut Output<M>) {
        let news = self.gossip.for_message(first);
        output.broadcasts.push(M::probe(Probe { call, number, news }));
    }

    fn next_number(&mut self) -> u16 {
        self.number = self.number.wrapping_add(1);
        self.number
    }

    /// Has the timer fire no later than anything is due. What was put off meanwhile is found out then.
    fn arm<M>(&mut self, output: &mut Output<M>) {
        let probe = self.probe.as_ref().map(|probe| probe.ask.min(probe.end));
        let beliefs = self.members.iter().filter_map(|member| match member.belief {
            Belief::Alive => Some(member.heard + self.leave),
            Belief::Suspected(until) => Some(until.min(member.heard + self.leave)),
            Belief::Down(_) => None,
        });
        let due = beliefs.chain(probe).min().unwrap_or(SimTime::NEVER);
        if due < self.armed {
            self.armed = due;
            output.timers.push((TIMER, Some(due)));
        }
    }
}
