//! What happens in a scenario, as upper bounds in closed form: who hears whom, what is sent, suspected and kept.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use super::super::Scenario;
use crate::engine::Span;
use crate::faults::{LastsConfig, WhenConfig};
use crate::metrics::AskedTable;
use crate::motion::DeployConfig;
use crate::protocol::control::WakeConfig;
use crate::protocol::detector::DetectorConfig;
use crate::quantity::{Finite, Probability};
use crate::radio::{LossChain, LossConfig};

/// Of a status sent lately, and of a lost copy of it, in lists that have room to spare.
const STATUS: f64 = 32.0;
const LOST: f64 = 16.0;
/// Vectors that an iteration to λ₂ keeps.
const ITERATED: f64 = 30.0;
/// Of a failed robot at an observer, and of a failure.
const OBSERVED: f64 = 250.0;
const FAILURE: f64 = 1500.0;

/// What several of these bounds need to know.
pub struct View<'a> {
    scenario: &'a Scenario,
    pub robots: f64,
    time_limit: f64,
    /// Robots that hear a broadcast at the start.
    neighbours: f64,
    /// Ordered pairs of robots that hear each other at some time of a trial.
    pub pairs: f64,
    /// How often pairs come into each other's range in a trial.
    meetings: f64,
    pub samples: f64,
    /// Seconds from one status of a robot to the next; none where it sends none.
    status_s: Option<f64>,
}

impl<'a> View<'a> {
    pub fn of(scenario: &'a Scenario) -> Self {
        let robots = f64::from(scenario.swarm.robots);
        let time_limit = scenario.time_limit.get();
        let (width, height) = (scenario.arena.size.0.get(), scenario.arena.size.1.get());
        let neighbours = neighbours(scenario).min(robots - 1.0).max(0.0);
        // What robots of speed v, 4/π as fast against each other, sweep with their range in a trial.
        let swept = 2.0 * scenario.radio.disk().range.get() * 4.0 / PI * scenario.wander.speed() * time_limit;
        let met = robots * (robots - 1.0) * swept / (width * height);
        let sample_interval = scenario.metrics.sample_interval.get();
        let period = Span::from_secs(scenario.control.period.get());
        let interval = || (period * scenario.gossip.status.timing(period).every()).as_secs();
        let status_s = scenario.protocol.has_statuses().then(interval);
        Self {
            scenario,
            robots,
            time_limit,
            neighbours,
            pairs: (robots * neighbours + met).min(robots * (robots - 1.0)),
            meetings: met,
            samples: if sample_interval > 0.0 {
                time_limit / sample_interval + 1.0
            } else {
                0.0
            },
            status_s,
        }
    }

    /// Pairs of robots of which the scenario wants to know what passes between them.
    pub fn between(&self) -> f64 {
        if self.scenario.metrics.pairs { self.pairs } else { 0.0 }
    }

    /// Links of which the scenario wants to know what became of copies.
    pub fn links(&self) -> f64 {
        let wanted = self.scenario.metrics.links && self.scenario.radio.shared().is_some();
        if wanted { self.pairs } else { 0.0 }
    }

    /// Rows of each table that the scenario asks for, but for those that are short or follow robots' words.
    pub fn asked(&self) -> impl Iterator<Item = f64> {
        let topics = self.topics() - 1.0;
        let windows = self.entries() + 1.0;
        let tables = [
            (AskedTable::Delays, windows * topics),
            (AskedTable::Degree, self.samples * self.robots),
            (AskedTable::Hops, self.robots),
            (AskedTable::Traffic, windows * topics * self.robots),
            (AskedTable::Roles, self.robots),
        ];
        let wanted = |(table, _): &(AskedTable, f64)| self.scenario.metrics.record.contains(table);
        tables.into_iter().filter(wanted).map(|(_, rows)| rows)
    }

    /// Copies under way at once whose distance is kept.
    pub fn placed(&self) -> f64 {
        let wanted = self.scenario.metrics.record.contains(&AskedTable::Delivery);
        if wanted { self.copies() } else { 0.0 }
    }

    /// Numbers in the factor that λ₂ is found by, and in what is iterated with it: of each robot, as many as stand in a strip across a square
    /// swarm that is as wide as the range.
    pub fn factor(&self) -> f64 {
        let strip = (self.robots * self.neighbours / PI).sqrt();
        if self.samples > 0.0 {
            self.robots * (strip + ITERATED)
        } else {
            0.0
        }
    }

    fn moves(&self) -> bool {
        self.scenario.moves()
    }

    pub fn topics(&self) -> f64 {
        (self.scenario.protocol.all_topics().len() + 1) as f64
    }

    pub fn entries(&self) -> f64 {
        let every = f64::from(self.scenario.metrics.series_every);
        if every > 0.0 { self.samples / every } else { 0.0 }
    }

    /// Intervals that a detector remembers of each robot.
    pub fn window(&self) -> f64 {
        match (&self.scenario.detector, self.status_s) {
            (DetectorConfig::PhiAccrual(phi), Some(interval)) => {
                f64::from(phi.window).min(self.time_limit / interval + 2.0)
            }
            _ => 0.0,
        }
    }

    /// Frames that a robot sends in a second.
    fn rate(&self) -> f64 {
        let statuses = self.status_s.map_or(0.0, |interval| 1.0 / interval);
        let own = self.scenario.protocol.frames_a_second(&self.scenario.sections());
        statuses + own + self.probes()
    }

    /// Probes, their answers and those through others that a robot sends in a second.
    fn probes(&self) -> f64 {
        match (&self.scenario.detector, self.status_s) {
            (DetectorConfig::Swim(swim), Some(_)) => {
                (2.0 + 4.0 * f64::from(swim.indirect_checks)) / swim.probe_interval.get()
            }
            _ => 0.0,
        }
    }

    /// Seconds that an arrival waits at most until its receiver wakes.
    fn waits(&self) -> f64 {
        let period = self.scenario.control.period.get();
        match self.scenario.control.wake {
            WakeConfig::OnReception => 0.0,
            WakeConfig::ControlStep => {
                let sooner = self.scenario.protocol.wakes_within(&self.scenario.sections());
                sooner.map_or(period, |seconds| period.min(seconds))
            }
        }
    }

    /// Copies under way or waiting to be read at once: all that is sent until they are read, and one.
    pub fn copies(&self) -> f64 {
        let latency = self.scenario.radio.disk().latency.mean().min(self.time_limit);
        let sent = self.rate() * (latency + self.waits());
        self.robots * self.neighbours * (1.0 + sent)
    }

    /// Bytes of the statuses of late.
    pub fn log(&self) -> f64 {
        let Some(interval) = self.status_s else { return 0.0 };
        let silence = self.scenario.detector.longest_silence(self.scenario.circumstances());
        let span = (3.0 * silence.as_secs()).min(self.time_limit);
        let range = self.scenario.radio.disk().range.get();
        let lost = self.scenario.radio.disk().loss.mean_loss(range, range);
        self.robots * span / interval * (STATUS + self.neighbours * lost * LOST)
    }

    /// Suspicions of a trial: of robots in range by the losses that they take, of others once a meeting.
    pub fn suspicions(&self) -> f64 {
        let Some(interval) = self.status_s else { return 0.0 };
        // Whoever moves may leave whom it heard from the start, too.
        let parting = if self.moves() {
            self.robots * self.neighbours
        } else {
            0.0
        };
        let once = parting + self.meetings;
        let in_range = self.robots * self.neighbours * self.time_limit;
        let scenario = self.scenario;
        let often = match &scenario.detector {
            DetectorConfig::None => return 0.0,
            DetectorConfig::Swim(swim) => {
                let range = scenario.radio.disk().range.get();
                let failing = swim.probe_failure(scenario.radio.disk().loss.mean_loss(range, range));
                in_range * failing / swim.probe_interval.get()
            }
            detector => {
                let silence = detector.shortest_silence(scenario.circumstances());
                in_range * self.mistakes(interval, silence.unwrap_or(Span::ZERO).as_secs())
            }
        };
        once + often
    }

    /// Suspicions a second between two robots in range: an arrival, and then no other for `silence`. Of the statuses that are sent
    /// early enough to arrive within it, were they no later than some latency, each is lost or later than that; the latency that
    /// bounds this best is taken.
    fn mistakes(&self, interval: f64, silence: f64) -> f64 {
        let radio = self.scenario.radio.disk();
        let latencies = radio.latency.quantiles(200);
        let number = latencies.len();
        let range = radio.range.get();
        // Where loss grows with distance, neither the nearest nor the farthest err most.
        let distances = [0.25, 0.5, 0.75, 0.9, 1.0].map(|share| share * range);
        let rates = distances.map(|distance| {
            let bounds = [0.5, 0.75, 0.9, 0.975, 1.0].map(|share| {
                let place = ((share * number as f64) as usize).clamp(1, number) - 1;
                let spread = latencies[place] - latencies[0];
                let later = if number == 1 {
                    0.0
                } else {
                    1.0 - (place as f64 + 0.5) / number as f64
                };
                let losses = ((silence - spread) / interval - 1e-9).floor().max(0.0);
                let Some(mut run) = thinned(&radio.loss, distance, range, later).after_arrival() else {
                    return 0.0;
                };
                run.lose_all(losses as u64);
                run.probability()
            });
            let silent = bounds.into_iter().fold(1.0, f64::min);
            radio.loss.chain(distance, range).arriving() * silent / interval
        });
        rates.into_iter().fold(0.0, f64::max)
    }

    /// Bytes of the failures, of those who notice them, and of what becomes of their links.
    pub fn failures(&self) -> f64 {
        let steps = self.time_limit / self.scenario.control.period.get();
        let counts = self.scenario.faults.iter().map(|fault| {
            let Some(robots) = fault.of_robots() else { return 1.0 };
            let again = match robots.lasts {
                LastsConfig::ForGood => 1.0,
                LastsConfig::For(seconds) => 1.0 + self.time_limit / seconds.get(),
            };
            let chances = match robots.when {
                WhenConfig::At(_) => 1.0,
                WhenConfig::Hazard { per_step, .. } => steps * per_step.get(),
                // Roles are taken anew a few times in a trial, not in every step.
                WhenConfig::OnJoin { probability, .. } => 100.0 * probability.get(),
            };
            self.robots * chances.min(again)
        });
        counts.sum::<f64>() * (FAILURE + self.neighbours * OBSERVED)
    }

    /// Events of a trial.
    pub fn events(&self) -> f64 {
        let scenario = self.scenario;
        let steps = self.time_limit / scenario.control.period.get();
        let ticks = self.time_limit / scenario.motion.tick.get();
        let moved = if self.moves() { self.robots } else { 1.0 };
        let sent = self.rate() * self.time_limit;
        let sampled = self.samples * (1.0 + self.neighbours);
        ticks * moved + self.robots * (steps + sent * (1.0 + self.neighbours) + sampled)
    }
}

/// The losses between robots at `distance` metres where a share `later` of what arrives counts as lost too.
fn thinned(loss: &LossConfig, distance: f64, range: f64, later: f64) -> LossChain {
    let thin = |loss: f64| Probability::new((1.0 - (1.0 - loss) * (1.0 - later)).clamp(0.0, 1.0));
    let thinned = match *loss {
        LossConfig::GilbertElliott {
            good_to_bad,
            bad_to_good,
            good_loss,
            bad_loss,
        } => LossConfig::GilbertElliott {
            good_to_bad,
            bad_to_good,
            good_loss: thin(good_loss.get()),
            bad_loss: thin(bad_loss.get()),
        },
        LossConfig::None | LossConfig::Bernoulli(_) | LossConfig::Distance { .. } => {
            LossConfig::Bernoulli(thin(loss.mean_loss(distance, range)))
        }
    };
    thinned.chain(distance, range)
}

/// Places in the nine cells around each of `places`, on average, where cells are as wide as `range`: no fewer than lie within it.
fn around(places: &[(Finite, Finite)], range: f64) -> f64 {
    let cell = |metres: Finite| (metres.get() / range).floor().clamp(-1e15, 1e15) as i64;
    let mut cells: BTreeMap<(i64, i64), f64> = BTreeMap::new();
    for (x, y) in places {
        *cells.entry((cell(*x), cell(*y))).or_default() += 1.0;
    }
    let pairs = cells.iter().map(|(&(x, y), here)| {
        let near = (-1..=1).flat_map(|right| (-1..=1).map(move |up| (x + right, y + up)));
        here * near.filter_map(|cell| cells.get(&cell)).sum::<f64>()
    });
    pairs.sum::<f64>() / (places.len() as f64).max(1.0)
}

/// Robots that hear a broadcast at the start, an upper bound: as dense as they are deployed, and never overlapping.
fn neighbours(scenario: &Scenario) -> f64 {
    let robots = f64::from(scenario.swarm.robots);
    let range = scenario.radio.disk().range.get();
    let (width, height) = (scenario.arena.size.0.get(), scenario.arena.size.1.get());
    let packed = (range / scenario.motion.body_radius.get() + 1.0).powi(2);
    let within = |area: f64| robots * PI * range * range / area;
    let expected = match &scenario.swarm.deploy {
        DeployConfig::Cluster { radius } => within((PI * radius.get() * radius.get()).min(width * height)),
        DeployConfig::Uniform => within(width * height),
        DeployConfig::At(places) => around(places, range),
    };
    expected.min(packed).min(robots)
}
