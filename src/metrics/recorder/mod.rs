//! The recorder: told of everything that happens in a run, it leaves a [`TrialRecord`].

mod closing;
mod layout;
mod observer;

pub use layout::{Layout, RunEnd};

use crate::engine::{ActorId, SimTime, Span};
use crate::faults::{Change, Subject};
use crate::geometry::Vec2;
use crate::happenings::Inbox;
use crate::motion::World;
use crate::protocol::{MessageSize, Note, Topic};
use crate::radio::{LossCause, Reach};
use crate::spool::Spool;

use closing::{ledger, robots};

use super::air::Air;
use super::asked::{Books, Hop};
use super::completion::{Hearing, Judge, Progress};
use super::config::MetricsConfig;
use super::connectivity::Graph;
use super::detection::{Scorer, Watching};
use super::faults::Failures;
use super::healing::Healing;
use super::latency::LatencyHistogram;
use super::mission::Scene;
use super::noted::Notes;
use super::record::{ConnectivitySample, Outcome, TrialRecord};
use super::reports::Reports;
use super::series::Series;
use super::spread::Spread;
use super::traffic::Traffic;

/// Accounts for one run.
#[derive(Debug)]
pub struct Recorder {
    roles: usize,
    reach: Reach,
    control_period: Span,
    traffic: Traffic,
    latency: LatencyHistogram,
    /// Copies offered, by topic: counted at the transmission, so that the fates can be checked against it.
    offered: Vec<u64>,
    in_flight: Vec<u64>,
    reports: Reports,
    failures: Failures,
    healing: Healing,
    detection: Scorer,
    status: Option<Topic>,
    judge: Option<Judge>,
    spread: Spread,
    notes: Notes,
    /// What only some scenarios ask for.
    asked: Option<Box<Books>>,
    /// Begun when the radio tells something.
    air: Option<Box<Air>>,
    robots: usize,
    links: bool,
    /// How far the rumours have come, if there are any.
    everyone_knows: Option<Hearing>,
    connectivity: Spool<ConnectivitySample>,
    series: Series,
    trajectories: Spool<(SimTime, Vec<[f32; 2]>)>,
    /// The last sample's graph and its λ₂, which stands as long as no edge changes.
    last_graph: Option<(Graph, f64)>,
}

impl Recorder {
    /// A recorder for a run of this shape, before its start.
    #[must_use]
    pub fn new(layout: Layout, config: &MetricsConfig) -> Self {
        let Layout {
            rumors,
            completion,
            control_period,
            scratch,
            ..
        } = layout;
        Self {
            roles: layout.roles,
            control_period: layout.control_period,
            traffic: Traffic::new(layout.robots, layout.roles, layout.topics, layout.headers),
            latency: LatencyHistogram::default(),
            offered: vec![0; layout.topics],
            in_flight: vec![0; layout.topics],
            reports: Reports::new(layout.robots),
            failures: Failures::new(layout.robots),
            healing: Healing::new(layout.topics),
            detection: Scorer::new(
                layout.robots,
                Watching {
                    memory: layout.status_memory,
                    patience: layout.patience,
                    reach: layout.reach.clone(),
                },
                &scratch,
            ),
            reach: layout.reach,
            status: layout.status,
            judge: layout
                .mission
                .map(|mission| Judge::new(mission, completion, control_period)),
            spread: Spread::new(layout.rumors, layout.robots),
            notes: Notes::default(),
            air: None,
            robots: layout.robots,
            links: config.links,
            asked: Books::new(config, layout.robots, layout.topics, layout.status, &scratch),
            everyone_knows: (rumors > 0).then(|| Hearing::new(rumors, completion, control_period)),
            connectivity: Spool::new(&scratch),
            series: Series::new(config.series_every, &scratch),
            trajectories: Spool::new(&scratch),
            last_graph: None,
        }
    }

    /// `sender` transmitted a frame, however many robots hear it.
    #[inline]
    pub fn transmitted(&mut self, sender: ActorId, topic: Topic, size: MessageSize) {
        self.traffic.sent(sender, topic, size);
        if self.healing.is_open() {
            let target = self.reports.targets[sender.index()];
            self.healing.sent(target, topic, size.payload_bytes.into());
        }
    }

    /// A transmission was offered to `copies` robots in range. Each copy's fate is told in its own time.
    #[inline]
    pub fn offered(&mut self, topic: Topic, copies: u64) {
        self.offered[usize::from(topic.0)] += copies;
    }

    /// A copy meant for `receiver` was lost.
    #[allow(clippy::inline_always)]
    #[inline(always)]
    pub fn lost(&mut self, receiver: ActorId, topic: Topic, cause: LossCause, size: MessageSize) {
        self.traffic.lost(receiver, topic, cause, size);
    }

    /// A copy arrived at `receiver`, `latency` after its transmission began.
    #[allow(clippy::inline_always)]
    #[inline(always)]
    pub fn delivered(&mut self, receiver: ActorId, topic: Topic, size: MessageSize, latency: Span) {
        self.traffic.received(receiver, topic, size);
        self.latency.record(latency);
    }

    /// A copy is still under way at the end of the run, which it would have arrived `latency` after it was sent. It counts
    /// among the latencies: those of the copies that made it in time are too short. `None` if it is open whether it would have arrived.
    #[inline]
    pub fn in_flight(&mut self, topic: Topic, latency: Option<Span>) {
        self.in_flight[usize::from(topic.0)] += 1;
        if let Some(latency) = latency {
            self.latency.record(latency);
        }
    }

    /// `robot` reported a change.
    ///
    /// # Panics
    /// If it reports a role, a parent or a rumour that the run does not have.
    pub fn note(&mut self, robot: ActorId, note: &Note) {
        match *note {
            Note::Role(role) => self.traffic.enter(robot, role),
            Note::Duplicate { topic, size } => self.traffic.duplicate(robot, topic, size),
            Note::Informed { rumor, at, from } => self.informed(robot, rumor, at, from),
            Note::Count { name, n } => self.notes.count(robot, name, n),
            Note::Value { name, value } => self.notes.value(robot, name, value),
            _ => {}
        }
        self.reports.note(robot, note);
    }

    fn informed(&mut self, robot: ActorId, rumor: u16, at: SimTime, parent: Option<ActorId>) {
        let hops = self.spread.inform(robot, rumor, at, parent);
        if let (Some(hops), Some(asked)) = (hops, &mut self.asked) {
            asked.informed(&Hop {
                rumor,
                robot,
                at,
                parent,
                hops,
            });
        }
    }

    /// A fault began or ended at `now`, with every robot at its place in `positions`.
    pub fn fault(&mut self, now: SimTime, change: &Change, positions: &[Vec2]) {
        let scene = Scene::new(&self.reports, &self.failures, positions, &self.reach);
        let mission = self.judge.as_ref().map(|judge| &judge.mission);
        let blows = mission.map_or_else(Vec::new, |mission| Healing::brace(change, mission, scene));
        self.failures.change(now, change, &self.reports);
        if let Some(mission) = mission {
            let scene = Scene::new(&self.reports, &self.failures, positions, &self.reach);
            for blow in &blows {
                self.healing.strike(now, change.fault, blow, mission, scene);
            }
        }
        if let Subject::Robot { robot, health, .. } = change.subject {
            self.detection.fault(now, robot, health);
        }
    }

    /// `sender` sent a status, its frame number `sequence`: to one robot alone, or to all in range.
    pub fn status_sent(&mut self, now: SimTime, sender: ActorId, sequence: u32, to: Option<ActorId>) {
        self.detection.sent(now, sender, sequence, to);
    }

    /// The copy of a status that was meant for `receiver` was lost, which [`lost`](Self::lost) is told as well.
    #[inline]
    pub fn status_lost(&mut self, receiver: ActorId, sender: ActorId, sequence: u32, cause: LossCause) {
        self.detection.lost(receiver, sender, sequence, cause);
    }

    /// `observer` may have reported a belief about another robot, with these frames at hand.
    ///
    /// # Panics
    /// If it believes something of a robot that it does not watch.
    pub fn belief<M>(&mut self, now: SimTime, observer: ActorId, note: &Note, inbox: &Inbox<'_, M>) {
        self.detection.belief(now, observer, note, inbox);
    }

    /// The run begins, with robots where `world` says.
    pub fn begin(&mut self, world: &World) {
        self.detection.begin(world);
    }

    /// Robots go on to where `world` says, at each of its ticks.
    pub fn tick(&mut self, world: &World) {
        self.detection.tick(world);
    }

    /// Samples the graph of the live robots, the traffic since the sample before, and where everyone is, `positions` in order of ids.
    pub fn sample(&mut self, now: SimTime, positions: &[Vec2]) {
        let robots = (0..).map(ActorId).zip(positions.iter().copied());
        let live = robots.filter(|(robot, _)| self.failures.is_live(*robot));
        let graph = match &mut self.asked {
            Some(asked) if asked.heeds_degrees() => {
                let (graph, who) = Graph::with_robots(live, &self.reach);
                asked.sampled(now, positions.len(), &graph, &who);
                graph
            }
            _ => Graph::of_reach(live, &self.reach),
        };
        let (components, neighbours) = (graph.components() as u32, graph.mean_degree());
        let lambda2 = self.lambda2(graph);
        let scene = Scene::new(&self.reports, &self.failures, positions, &self.reach);
        self.connectivity.push(&ConnectivitySample {
            at: now,
            lambda2,
            components,
            neighbours,
            roles: self.reports.count_roles(self.roles),
            links: self
                .judge
                .as_ref()
                .map_or_else(Vec::new, |judge| judge.mission.links(scene)),
            targets: self
                .judge
                .as_ref()
                .map_or_else(Vec::new, |judge| judge.mission.stands(scene)),
        });
        let window_ends = self.series.sample(now, &self.traffic);
        if let (true, Some(asked)) = (window_ends, &mut self.asked) {
            asked.window_ends(now, &self.traffic);
        }
        self.trajectories
            .push(&(now, positions.iter().map(|p| [p.x, p.y].map(for_pictures)).collect()));
    }

    /// λ₂ of `graph`, computed only if the graph differs from the last sample's.
    fn lambda2(&mut self, graph: Graph) -> f64 {
        match &self.last_graph {
            Some((last, lambda2)) if *last == graph => *lambda2,
            _ => {
                let lambda2 = graph.algebraic_connectivity();
                self.last_graph = Some((graph, lambda2));
                lambda2
            }
        }
    }

    /// Judges the mission, or how far rumours have come, at control step number `step`, from 0, with every robot at its place
    /// in `positions`.
    pub fn observe(&mut self, step: u64, positions: &[Vec2]) -> Progress {
        if let Some(everyone_knows) = &mut self.everyone_knows {
            return everyone_knows.observe(step, &self.spread, &self.failures);
        }
        let Some(judge) = &mut self.judge else {
            return Progress::Underway;
        };
        let scene = Scene::new(&self.reports, &self.failures, positions, &self.reach);
        if self.healing.is_open() {
            let now = SimTime::ZERO + self.control_period * step;
            self.healing.observe(now, &judge.mission, scene);
        }
        judge.observe(step, scene)
    }

    /// The book of what the radio tells.
    #[inline]
    fn air(&mut self) -> &mut Air {
        self.air
            .get_or_insert_with(|| Box::new(Air::new(self.robots, self.links)))
    }

    /// Closes the books.
    ///
    /// # Panics
    /// If on some topic the copies offered are not those delivered, lost and in flight: the simulator itself is wrong.
    #[must_use]
    pub fn finish(self, end: RunEnd) -> TrialRecord {
        let asked = self.asked.map(|asked| asked.into_records(end.simulated, &self.traffic));
        let (pairs, asked) = asked.unwrap_or_default();
        let traffic = self.traffic.rows();
        let ledger = ledger(&self.offered, &self.in_flight, &traffic);
        for (topic, fates) in ledger.iter().enumerate() {
            assert!(
                fates.is_balanced(),
                "frames were not conserved on topic {topic}: {fates}"
            );
        }
        let ended = |completed: Option<u64>| completed.map_or(Outcome::Censored, |step| Outcome::Completed { step });
        let outcome = match (&self.everyone_knows, &self.judge) {
            (Some(everyone_knows), _) => ended(everyone_knows.completed_at()),
            (None, Some(judge)) => ended(judge.completed_at()),
            (None, None) => Outcome::NoMission,
        };
        TrialRecord {
            trial: end.trial,
            seed: end.seed,
            outcome,
            steps: end.steps,
            control_period: self.control_period,
            simulated: end.simulated,
            events: end.events,
            digest: end.digest,
            ledger,
            traffic,
            latency: self.latency,
            detection: self.detection.finish(end.simulated),
            trace: None,
            faults: self.failures.into_episodes(),
            healing: self.healing.into_episodes(),
            spread: self.spread.into_records(),
            noted: self.notes.into_records(),
            pairs,
            air: self.air.map(|air| air.into_record()),
            asked,
            connectivity: self.connectivity,
            series: self.series.into_entries(),
            robots: robots(self.reports, end.poses, &end.robot_steps),
            trajectories: self.trajectories,
        }
    }
}

/// A coordinate as pictures have it. One beyond what they can hold stays finite: a record must be read back.
fn for_pictures(coordinate: f64) -> f32 {
    coordinate.clamp(f32::MIN.into(), f32::MAX.into()) as f32
}

#[cfg(test)]
mod tests;
