//! The trials of a page: of all of them what takes a few bytes, of some of them the whole record.

use std::{fmt, mem};

use crate::metrics::figures::{Figure, Pooled, Registry, Samples};
use crate::metrics::{AirRecord, Asked, LatencyHistogram, TrialRecord};
use crate::scenario::Scenario;
use crate::spool::Spooled;
use crate::statistics::{Observation, Times};

/// Whole records that a page is drawn from: a chart shows no more of more.
const MOST: usize = 1_000;
/// Bytes of them in memory, where they are more than a few.
const MOST_BYTES: usize = 64 << 20;
const FEW: usize = 100;

/// The trials of a page, gathered one by one. Where there are thousands of them, or their records are large, charts of whole records are
/// drawn from some, spread evenly over all; what takes a few bytes a trial is of every one.
pub struct PageTrials {
    registry: Registry,
    samples: Samples,
    numbers: Vec<u32>,
    seeds: Vec<u64>,
    latency: LatencyHistogram,
    /// Every so many trials, from the first on, what charts need of the record.
    records: Vec<TrialRecord>,
    every: usize,
}

impl PageTrials {
    /// No trials of `scenario` yet.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        let registry = scenario.figures();
        Self {
            samples: Samples::new(registry.figures().count()),
            registry,
            numbers: Vec::new(),
            seeds: Vec::new(),
            latency: LatencyHistogram::default(),
            records: Vec::new(),
            every: 1,
        }
    }

    /// The trials of `scenario` that left `records`.
    #[must_use]
    pub fn of(scenario: &Scenario, records: impl IntoIterator<Item = TrialRecord>) -> Self {
        let mut trials = Self::new(scenario);
        records.into_iter().for_each(|record| trials.add(record));
        trials
    }

    /// Takes in the next trial.
    pub fn add(&mut self, record: TrialRecord) {
        self.samples.push(&self.registry.read(&record));
        self.latency.merge(&record.latency);
        if self.seeds.last() != Some(&record.seed) {
            self.seeds.push(record.seed);
        }
        let place = self.numbers.len();
        self.numbers.push(record.trial);
        if place.is_multiple_of(self.every) {
            self.records.push(drawn(record));
            while self.is_much() {
                self.every *= 2;
                let mut place = 0..;
                self.records
                    .retain(|_| place.next().is_some_and(|place: usize| place.is_multiple_of(2)));
            }
        }
    }

    fn is_much(&self) -> bool {
        let bytes = || self.records.iter().map(bytes).sum::<usize>();
        self.records.len() > MOST || (self.records.len() > FEW && bytes() > MOST_BYTES)
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.numbers.len()
    }

    /// Their seeds, in order, each once where it is that of several in a row.
    pub(super) fn seeds(&self) -> &[u64] {
        &self.seeds
    }

    /// The latencies of all of them.
    pub(super) fn latency(&self) -> &LatencyHistogram {
        &self.latency
    }

    /// The records that charts are drawn from.
    pub(super) fn records(&self) -> &[TrialRecord] {
        &self.records
    }

    /// The figures, and what all trials tell of each.
    pub(super) fn figures(&self) -> impl Iterator<Item = (&Figure, impl FnOnce() -> Pooled)> {
        let numbered = self.registry.figures().enumerate();
        numbered.map(move |(place, figure)| (figure, move || self.samples.of(place)))
    }

    /// The numbers of all of them.
    pub(super) fn numbers(&self) -> &[u32] {
        &self.numbers
    }

    /// The values of the figure called `key` that trials have, in order.
    pub(super) fn values(&self, key: &str) -> Vec<Observation> {
        let found = self.place(key).map(|place| self.samples.of(place));
        let told = found.iter().flat_map(|pooled| pooled.told(&self.numbers));
        let seen = told.map(|told| Observation {
            time: told.value,
            happened: !told.is_censored,
        });
        seen.collect()
    }

    /// The times of which the figure called `key` is the mean, trial by trial.
    pub(super) fn times(&self, key: &str) -> Times {
        let found = self.place(key).map(|place| self.samples.times(place).clone());
        found.unwrap_or_default()
    }

    fn place(&self, key: &str) -> Option<usize> {
        self.registry.figures().position(|figure| figure.key == key)
    }
}

impl fmt::Debug for PageTrials {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PageTrials")
            .field("trials", &self.count())
            .field("records", &self.records)
            .finish_non_exhaustive()
    }
}

/// What charts are drawn from.
fn drawn(mut record: TrialRecord) -> TrialRecord {
    record.latency = LatencyHistogram::default();
    record.asked = Asked::default();
    (record.pairs, record.noted) = (Vec::new(), Vec::new());
    if let Some(air) = &mut record.air {
        *air = AirRecord {
            bands: mem::take(&mut air.bands),
            ..AirRecord::default()
        };
    }
    record
}

/// Bytes of what of a record grows with robots and time.
fn bytes(record: &TrialRecord) -> usize {
    let lists: [&dyn Spooled; 4] = [
        &record.detection.suspicions,
        &record.detection.failures,
        &record.connectivity,
        &record.series,
    ];
    let pairs = record.spread.iter().map(|rumor| rumor.informed.len());
    lists.into_iter().map(|list| list.shape().bytes()).sum::<usize>()
        + size_of_val(&record.traffic[..])
        + size_of_val(&record.robots[..])
        + size_of_val(&record.faults[..])
        + size_of_val(&record.healing[..])
        + 24 * pairs.sum::<usize>()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use tokio_util::sync::CancellationToken;

    use super::*;
    use crate::experiment::run_trial;
    use crate::scenario::{Override, load};
    use crate::simulation::DriverKind;

    /// A trial of a scenario with two robots, and the scenario.
    fn made_up() -> (Scenario, TrialRecord) {
        let settings = ["trials=1", "time_limit=2.0", "swarm.robots=2"].map(str::parse);
        let settings: Result<Vec<Override>, _> = settings.into_iter().collect();
        let file = Path::new("scenarios/heartbeat.ron");
        let scenario = load(file, &settings.expect("settings")).expect("a scenario");
        let record = run_trial(&scenario, 0, DriverKind::default(), &CancellationToken::new());
        (scenario, record.expect("a trial"))
    }

    fn of(trials: u32, change: impl Fn(&mut TrialRecord)) -> PageTrials {
        let (scenario, record) = made_up();
        let numbered = |trial: u32| {
            let mut record = TrialRecord {
                trial,
                ..record.clone()
            };
            change(&mut record);
            record
        };
        PageTrials::of(&scenario, (0..trials).map(numbered))
    }

    #[test]
    fn a_thousand_trials_are_all_drawn_and_of_more_every_second_or_fourth_and_so_on() {
        for (trials, drawn, every) in [
            (1, 1, 1),
            (1_000, 1_000, 1),
            (1_001, 501, 2),
            (2_000, 1_000, 2),
            (2_001, 501, 4),
        ] {
            let page = of(trials, |_| {});
            let numbers: Vec<u32> = page.records().iter().map(|record| record.trial).collect();
            assert_eq!(numbers, (0..trials).step_by(every).collect::<Vec<_>>());
            assert_eq!((page.count(), numbers.len()), (trials as usize, drawn));
        }
    }

    #[test]
    fn of_large_records_fewer_are_drawn_but_never_fewer_than_a_few() {
        let large = |record: &mut TrialRecord| {
            let row = record.robots[0].clone();
            record.robots = vec![row; 1 << 14];
        };
        let page = of(260, large);
        assert!(
            (FEW / 2..=FEW).contains(&page.records().len()),
            "{}",
            page.records().len()
        );
        assert_eq!(of(FEW as u32, large).records().len(), FEW);
    }
}
