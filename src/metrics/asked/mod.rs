//! What is kept only where a scenario asks for it: pairs (`metrics: (pairs: true)`) and the tables of `metrics: (record: [...])`. Whether anything is, is
//! decided once, so that a run that asks for nothing pays for nothing.

mod delays;
mod delivery;
mod record;
mod traffic;
mod windows;

pub use record::{Asked, DegreeSample, DelayEntry, DeliveryBand, Hop, RoleChange, TrafficEntry};

use crate::engine::{ActorId, SimTime};
use crate::happenings::Copy;
use crate::protocol::{Note, Role, Topic};
use crate::radio::LossCause;
use crate::spool::{Scratch, Spool};

use super::config::{AskedTable, MetricsConfig};
use super::connectivity::Graph;
use super::pairs::{PairRecord, Pairs};
use super::traffic::Traffic;
use delays::Delays;
use delivery::Delivery;
use traffic::TrafficOverTime;

/// The books of what a scenario asks for. They are told of copies by value, and rarely: by reference every copy of every run would have to be in memory.
#[derive(Debug)]
pub(super) struct Books {
    pairs: Option<Pairs>,
    delivery: Option<Delivery>,
    delays: Option<Delays>,
    degree: Option<Spool<DegreeSample>>,
    hops: Option<Spool<Hop>>,
    traffic: Option<TrafficOverTime>,
    roles: Option<Spool<RoleChange>>,
}

impl Books {
    /// Those that `config` asks for, if it asks for any, of so many robots and topics; robots send statuses on the topic `status` if they do.
    pub(super) fn new(
        config: &MetricsConfig,
        robots: usize,
        topics: usize,
        status: Option<Topic>,
        scratch: &Scratch,
    ) -> Option<Box<Self>> {
        let asks = |table: AskedTable| config.record.contains(&table);
        (config.pairs || !config.record.is_empty()).then(|| {
            Box::new(Self {
                pairs: config.pairs.then(|| Pairs::new(robots, status)),
                delivery: asks(AskedTable::Delivery).then(|| Delivery::new(robots, topics)),
                delays: asks(AskedTable::Delays).then(|| Delays::new(topics, scratch)),
                degree: asks(AskedTable::Degree).then(|| Spool::new(scratch)),
                hops: asks(AskedTable::Hops).then(|| Spool::new(scratch)),
                traffic: asks(AskedTable::Traffic).then(|| TrafficOverTime::new(robots * topics, scratch)),
                roles: asks(AskedTable::Roles).then(|| starts(robots, scratch)),
            })
        })
    }

    /// Whether it wants to know of copies when they are offered.
    pub(super) fn heeds_offers(&self) -> bool {
        self.delivery.is_some()
    }

    /// A copy is offered, at a distance, metres.
    pub(super) fn offered(&mut self, copy: Copy, distance: f64) {
        if let Some(delivery) = &mut self.delivery {
            delivery.offered(&copy, distance);
        }
    }

    /// A copy arrived at `at`, and was read if it `is_read`: then in order of arrivals.
    #[cold]
    pub(super) fn delivered(&mut self, copy: Copy, at: SimTime, is_read: bool) {
        if let Some(pairs) = &mut self.pairs {
            pairs.delivered(copy, at, is_read);
        }
        if let Some(delivery) = &mut self.delivery {
            delivery.delivered(&copy);
        }
        if let Some(delays) = &mut self.delays {
            delays.delivered(copy.topic, copy.latency(at));
        }
    }

    /// A copy was lost.
    #[cold]
    pub(super) fn lost(&mut self, copy: Copy, cause: LossCause) {
        if let Some(pairs) = &mut self.pairs {
            pairs.lost(copy);
        }
        if let Some(delivery) = &mut self.delivery {
            delivery.lost(&copy, cause);
        }
    }

    /// A copy is still under way at the end.
    #[cold]
    pub(super) fn in_flight(&mut self, copy: Copy) {
        if let Some(pairs) = &mut self.pairs {
            pairs.in_flight(copy);
        }
        if let Some(delivery) = &mut self.delivery {
            delivery.in_flight(&copy);
        }
    }

    /// `robot`, in the role `before`, noted something.
    pub(super) fn noted(&mut self, now: SimTime, robot: ActorId, before: Role, note: &Note) {
        if let (Some(roles), Note::Role(role)) = (&mut self.roles, note)
            && *role != before
        {
            roles.push(&RoleChange {
                at: now,
                robot,
                before: Some(before.0),
                role: role.0,
            });
        }
    }

    /// A robot came to know a rumour.
    pub(super) fn informed(&mut self, hop: &Hop) {
        if let Some(hops) = &mut self.hops {
            hops.push(hop);
        }
    }

    /// Whether it wants to know whom robots have in range.
    pub(super) fn heeds_degrees(&self) -> bool {
        self.degree.is_some()
    }

    /// At `now` the live ones of so many robots form a `graph`, of which the vertices are the robots `who`.
    pub(super) fn sampled(&mut self, now: SimTime, robots: usize, graph: &Graph, who: &[ActorId]) {
        let Some(degree) = &mut self.degree else { return };
        let mut neighbours = vec![None; robots];
        for (robot, edges) in who.iter().zip(graph.degrees()) {
            neighbours[robot.index()] = Some(edges);
        }
        degree.push(&DegreeSample { at: now, neighbours });
    }

    /// A window of time ends at `now`.
    pub(super) fn window_ends(&mut self, now: SimTime, traffic: &Traffic) {
        if let Some(delays) = &mut self.delays {
            delays.window_ends(now);
        }
        if let Some(over_time) = &mut self.traffic {
            over_time.window_ends(now, traffic);
        }
    }

    /// Closes the books of a run that ended at `end`.
    pub(super) fn into_records(self, end: SimTime, traffic: &Traffic) -> (Vec<PairRecord>, Asked) {
        let asked = Asked {
            delivery: self.delivery.map_or_else(Vec::new, Delivery::into_records),
            delays: self.delays.map(|delays| delays.into_entries(end)).unwrap_or_default(),
            degree: self.degree.unwrap_or_default(),
            hops: self.hops.unwrap_or_default(),
            traffic: self
                .traffic
                .map(|over_time| over_time.into_entries(end, traffic))
                .unwrap_or_default(),
            roles: self.roles.unwrap_or_default(),
        };
        (self.pairs.map_or_else(Vec::new, Pairs::into_records), asked)
    }
}

/// The roles that robots start in: the first.
fn starts(robots: usize, scratch: &Scratch) -> Spool<RoleChange> {
    let mut roles = Spool::new(scratch);
    roles.extend((0..robots as u32).map(|robot| RoleChange {
        at: SimTime::ZERO,
        robot: ActorId(robot),
        before: None,
        role: Role::default().0,
    }));
    roles
}
