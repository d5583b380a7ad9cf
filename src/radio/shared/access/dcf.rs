//! The distributed coordination function of IEEE 802.11 (2020, 10.3): count idle slots down, send at none.
//!
//! No event tells a robot that the channel has become busy or clear. It is stepped when its count would end if nothing came between, and
//! then looks back at what did: so a burst costs each contender one step, however many there are.

use super::{Answering, Next, Outcome, Scheme, Station, Step};
use crate::engine::{ActorId, SimTime, Span};
use crate::radio::shared::burst::{BurstId, Content};

/// Its numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Timing {
    pub slot: Span,
    pub sifs: Span,
    pub difs: Span,
    /// In place of DIFS behind a frame that was heard and not understood: SIFS, an acknowledgement at the lowest rate, DIFS.
    pub eifs: Span,
    /// The contention window at first and at most: of so many slots and none one is drawn.
    pub least_window: u32,
    pub most_window: u32,
    /// How often a frame is sent at most.
    pub attempts: u32,
    /// How long a burst is on air before others notice.
    pub latency: Span,
    /// How long an acknowledgement is on air.
    pub acknowledgement: Span,
    /// From the end of a frame until its sender gives up waiting for the beginning of an acknowledgement.
    pub patience: Span,
    /// Whether frames to one robot are acknowledged.
    pub acknowledges: bool,
}

/// Where a robot is on its way to the medium.
#[derive(Clone, Copy, Debug)]
struct Way {
    window: u32,
    /// Whether it counts, with a frame to send or behind one that it has sent.
    counts: bool,
    /// Slots to go, counted from `from` on.
    slots: u32,
    from: SimTime,
    /// The bursts before this one are dealt with.
    seen: BurstId,
}

/// All robots' ways.
pub(super) struct Dcf {
    timing: Timing,
    ways: Vec<Way>,
}

impl Dcf {
    pub fn new(timing: Timing, robots: usize) -> Self {
        let way = Way {
            window: timing.least_window,
            counts: false,
            slots: 0,
            from: SimTime::ZERO,
            seen: BurstId(0),
        };
        Self {
            timing,
            ways: vec![way; robots],
        }
    }

    /// Begins to count a random number of slots, from `from` on at the earliest; what went on air before `seen` is over.
    fn back_off(&mut self, from: SimTime, station: &mut Station<'_>) {
        let window = self.ways[station.robot.index()].window;
        let slots = station.count(window);
        let way = &mut self.ways[station.robot.index()];
        way.counts = true;
        way.slots = slots;
        way.from = from;
    }

    /// Deals with what was on air up to `now`: slots before it are counted, and the others begin anew behind it.
    fn look_back(&mut self, now: SimTime, station: &mut Station<'_>) {
        let timing = self.timing;
        let way = &mut self.ways[station.robot.index()];
        let mut over = true;
        let mut next = way.seen;
        let since = way.seen;
        for place in station.ear.from(since) {
            let heard = *station.ear.at(place);
            let noticed = heard.begins + timing.latency;
            let is_own = heard.power == f64::INFINITY;
            if noticed >= now && !is_own {
                break;
            }
            if !is_own && !station.receiver.is_carrier(&heard) {
                if over {
                    next = BurstId(heard.burst.0 + 1);
                }
                continue;
            }
            let busy_from = if is_own { heard.begins } else { noticed };
            let counted = busy_from.since(way.from).as_nanos() / timing.slot.as_nanos();
            way.slots -= counted.min(u64::from(way.slots)) as u32;
            let mut clear = heard.ends + timing.difs;
            if heard.ends > now {
                over = false;
            } else if !is_own && let Some(burst) = station.bursts.get(heard.burst) {
                let understood = station.understands(place, burst);
                if understood == Some(false) {
                    clear = heard.ends + timing.eifs;
                } else if understood == Some(true)
                    && timing.acknowledges
                    && is_to_another(&burst.content, station.robot)
                {
                    // It says that an acknowledgement follows, whether that can be heard here or not.
                    clear = clear + timing.sifs + timing.acknowledgement;
                }
            }
            way.from = way.from.max(clear);
            if over {
                next = BurstId(heard.burst.0 + 1);
            }
        }
        way.seen = next;
    }
}

fn is_to_another(content: &Content, robot: ActorId) -> bool {
    matches!(content, Content::Frame { to: Some(to), .. } if *to != robot)
}

impl Scheme for Dcf {
    fn step(&mut self, now: SimTime, station: &mut Station<'_>) -> Step {
        let robot = station.robot.index();
        if !self.ways[robot].counts {
            if station.head.is_none() {
                return Step::Rest;
            }
            // Since DIFS, or for as long as what it did not understand asks for, nothing: it may send at once.
            self.ways[robot].slots = 0;
            self.ways[robot].from = SimTime::ZERO;
            self.look_back(now, station);
            if self.ways[robot].from <= now {
                return Step::Send(now);
            }
            let from = self.ways[robot].from;
            self.back_off(from, station);
        }
        self.look_back(now, station);
        let way = &mut self.ways[robot];
        let ends = way.from + self.timing.slot * u64::from(way.slots);
        if ends > now {
            return Step::Wait(ends);
        }
        way.counts = false;
        if station.head.is_some() {
            Step::Send(now)
        } else {
            Step::Rest
        }
    }

    fn after(&mut self, now: SimTime, outcome: Outcome, station: &mut Station<'_>) -> Next {
        let attempts = station.head.map_or(0, |head| head.attempt) + 1;
        let again = outcome == Outcome::Unanswered && attempts < self.timing.attempts;
        let way = &mut self.ways[station.robot.index()];
        way.window = if again {
            (2 * way.window + 1).min(self.timing.most_window)
        } else {
            self.timing.least_window
        };
        self.back_off(now, station);
        if again { Next::Again(now) } else { Next::Done(now) }
    }

    fn answering(&self) -> Option<Answering> {
        self.timing.acknowledges.then_some(Answering {
            after: self.timing.sifs,
            patience: self.timing.patience,
        })
    }

    /// The longest count, and what may come between.
    fn memory(&self) -> Span {
        self.timing.slot * u64::from(self.timing.most_window) + self.timing.eifs * 2
    }

    fn reset(&mut self, robot: ActorId) {
        let way = &mut self.ways[robot.index()];
        way.counts = false;
        way.window = self.timing.least_window;
    }
}
