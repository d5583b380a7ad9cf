//! What robots' trees make together, seen from outside: no robot knows it.

use bytes::BytesMut;
use tokio_util::codec::Decoder as _;

use super::message::{Message, MessageCodec};
use super::tree;
use crate::engine::{ActorId, SimTime};
use crate::faults::{Change, Subject};
use crate::geometry::Vec2;
use crate::happenings::{Observer, Sent};
use crate::metrics::{Graph, Noted, NotedFigure, TrialRecord};

/// Whether the links that either end has in its tree, and those that both have, hold the live robots in one piece; the share of links that one end
/// alone has; and how long they all are, by the length of the minimum spanning tree of the swarm. At each sample from when robots have heard whom they can.
#[derive(Debug)]
pub struct Measure {
    /// Whom each robot has in its tree, as it last said.
    trees: Vec<Vec<ActorId>>,
    live: Vec<bool>,
    /// When robots have heard whom they can.
    from: SimTime,
    either: Vec<f64>,
    both: Vec<f64>,
    one_sided: Vec<f64>,
    length: Vec<f64>,
}

const EITHER: &str = "links_either_connected";
const BOTH: &str = "links_both_connected";
const ONE_SIDED: &str = "links_one_sided";
const LENGTH: &str = "links_length";

impl Measure {
    /// Of a swarm of so many robots, from `from` on.
    pub fn new(robots: usize, from: SimTime) -> Self {
        Self {
            trees: vec![Vec::new(); robots],
            live: vec![true; robots],
            from,
            either: Vec::new(),
            both: Vec::new(),
            one_sided: Vec::new(),
            length: Vec::new(),
        }
    }

    /// The figures of what it notes.
    pub fn figures() -> Vec<NotedFigure> {
        vec![
            NotedFigure::mean(
                "links_either_connected",
                "connected by links in the tree of either end",
                "1",
                EITHER,
            )
            .higher(),
            NotedFigure::mean(
                "links_both_connected",
                "connected by links in the trees of both ends",
                "1",
                BOTH,
            )
            .higher(),
            NotedFigure::mean("links_one_sided", "links in the tree of one end alone", "1", ONE_SIDED),
            NotedFigure::mean(
                "links_length",
                "length of links, by the least that connects all",
                "1",
                LENGTH,
            ),
        ]
    }

    /// Adds what it saw to the record.
    pub fn note(self, record: &mut TrialRecord) {
        for (name, values) in [
            (EITHER, self.either),
            (BOTH, self.both),
            (ONE_SIDED, self.one_sided),
            (LENGTH, self.length),
        ] {
            if !values.is_empty() {
                record.note(Noted::measured(name, ActorId(0), values));
            }
        }
    }

    /// The links, each once, and whether both of its ends have it; between live robots.
    fn links(&self) -> Vec<([u32; 2], bool)> {
        let mut links = Vec::new();
        for (robot, kept) in self.trees.iter().enumerate().filter(|(robot, _)| self.live[*robot]) {
            for other in kept.iter().filter(|other| self.live[other.index()]) {
                let mutual = self.trees[other.index()].contains(&ActorId(robot as u32));
                // One that both have is met twice, and counted from its lower end.
                if !mutual || robot < other.index() {
                    links.push(([robot as u32, other.0], mutual));
                }
            }
        }
        links
    }
}

impl Observer for Measure {
    fn sent(&mut self, message: &Sent<'_>) {
        let mut payload = BytesMut::from(message.payload);
        if let Ok(Some(Message { tree, .. })) = MessageCodec.decode(&mut payload) {
            self.trees[message.sender.index()] = tree;
        }
    }

    fn fault(&mut self, _: SimTime, change: &Change, _: &[Vec2]) {
        if let Subject::Robot { robot, health, .. } = change.subject {
            self.live[robot.index()] = health.sends && health.hears && health.acts;
        }
    }

    fn sample(&mut self, now: SimTime, positions: &[Vec2]) {
        if now < self.from {
            return;
        }
        let live: Vec<tree::Placed> = (0..)
            .map(ActorId)
            .zip(positions.iter().copied())
            .filter(|(robot, _)| self.live[robot.index()])
            .collect();
        if live.len() < 2 {
            return;
        }
        let links = self.links();
        let dead = positions.len() - live.len();
        // The dead have no links and are a piece each.
        let connected =
            |edges: Vec<[u32; 2]>| f64::from(u8::from(Graph::new(positions.len(), edges).components() == 1 + dead));
        self.either
            .push(connected(links.iter().map(|(link, _)| *link).collect()));
        self.both.push(connected(
            links
                .iter()
                .filter(|(_, mutual)| *mutual)
                .map(|(link, _)| *link)
                .collect(),
        ));
        if !links.is_empty() {
            let one_sided = links.iter().filter(|(_, mutual)| !mutual).count();
            self.one_sided.push(one_sided as f64 / links.len() as f64);
        }
        let least = tree::length(&live);
        if least > 0.0 {
            let ends = links
                .iter()
                .map(|([a, b], _)| (positions[*a as usize] - positions[*b as usize]).norm());
            self.length.push(ends.sum::<f64>() / least);
        }
    }
}
