//! The figures of a protocol, and how each is read off a trial.

use std::rc::Rc;

use super::figure::{Better, Figure, Sample, pool};
use crate::metrics::noted_figure::NotedFigure;
use crate::metrics::record::TrialRecord;
use crate::metrics::unit::SECONDS;
use crate::statistics::{Estimate, Estimator, Lasting, Part, Times};

/// How a figure is read off a trial.
type Reading = Rc<dyn Fn(&TrialRecord) -> Sample>;

/// The figures of a protocol.
#[derive(Default)]
pub struct Registry {
    entries: Vec<Entry>,
}

/// A figure and how it is read.
pub(super) struct Entry {
    figure: Figure,
    reading: Reading,
    /// Whether it stands in the general list of summaries and reports, and not at a place of its own.
    is_listed: bool,
}

impl Entry {
    /// Summaries and reports have no place of their own for it: it stands in their general list.
    pub(super) fn list(&mut self) {
        self.is_listed = true;
    }

    fn read(&self, records: &[TrialRecord]) -> (Vec<Sample>, Lasting) {
        let mut samples: Vec<Sample> = records.iter().map(|record| (self.reading)(record)).collect();
        let lasting = pool(&mut samples).unwrap_or_default();
        (samples, lasting)
    }

    fn estimate(&self, records: &[TrialRecord]) -> (Estimate, Lasting) {
        let (samples, lasting) = self.read(records);
        (self.figure.estimate(&samples), lasting)
    }
}

impl Registry {
    /// What the figures are, in order.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.entries.iter().map(|entry| &entry.figure)
    }

    /// What a trial tells of each figure, in order.
    #[must_use]
    pub fn read(&self, record: &TrialRecord) -> Vec<Sample> {
        self.entries.iter().map(|entry| (entry.reading)(record)).collect()
    }

    /// The figure called `key` over the trials of `records`, and what is known of its times if it is their mean. Nothing where there is no
    /// such figure.
    #[must_use]
    pub fn estimate(&self, key: &str, records: &[TrialRecord]) -> (Estimate, Lasting) {
        let entry = self.entries.iter().find(|entry| entry.figure.key == key);
        entry.map(|entry| entry.estimate(records)).unwrap_or_default()
    }

    /// The figures of the general list over the trials of `records`, in order, with how many values were cut off: of times, of the times
    /// themselves, else of the trials.
    #[must_use]
    pub fn listed(&self, records: &[TrialRecord]) -> Vec<(&Figure, Estimate, u64)> {
        let listed = self.entries.iter().filter(|entry| entry.is_listed);
        let estimated = listed.map(|entry| {
            let (samples, lasting) = entry.read(records);
            let cut_off = match entry.figure.estimator {
                Estimator::Times => lasting.cut_off,
                _ => samples.iter().filter(|sample| sample.is_censored).count() as u64,
            };
            (&entry.figure, entry.figure.estimate(&samples), cut_off)
        });
        estimated.collect()
    }

    /// Adds a figure, read off a trial by `reading`. It stands in the general list of summaries and reports, and among the figures that
    /// studies compare. Its key names it in files: letters, digits, `_` and `.`.
    ///
    /// # Panics
    /// If there is a figure with this key.
    pub fn add_figure(&mut self, figure: Figure, reading: impl Fn(&TrialRecord) -> Sample + 'static) {
        self.put(figure, reading).list();
    }

    /// The same, and the figures of what a protocol's robots note.
    #[must_use]
    pub fn noting(mut self, noted: &[NotedFigure]) -> Self {
        for &noted in noted {
            self.add_figure(noted.figure(), move |record| noted.read(record));
        }
        self
    }

    fn put(&mut self, figure: Figure, reading: impl Fn(&TrialRecord) -> Sample + 'static) -> &mut Entry {
        let key = &figure.key;
        assert!(
            self.figures().all(|known| known.key != *key),
            "two figures have the key {key}"
        );
        self.entries.push_mut(Entry {
            figure,
            reading: Rc::new(reading),
            is_listed: false,
        })
    }

    pub(super) fn add(
        &mut self,
        key: &str,
        name: &str,
        (unit, better, estimator): Kind,
        reading: impl Fn(&TrialRecord) -> Sample + 'static,
    ) -> &mut Entry {
        let figure = Figure {
            key: key.to_owned(),
            name: name.to_owned(),
            unit: unit.into(),
            better,
            is_ratio: false,
            estimator,
        };
        self.put(figure, reading)
    }

    pub(super) fn add_plain(
        &mut self,
        key: &str,
        name: &str,
        kind: Kind,
        reading: impl Fn(&TrialRecord) -> Option<f64> + 'static,
    ) -> &mut Entry {
        self.add(key, name, kind, move |record| Sample::plain(reading(record)))
    }

    pub(super) fn add_ratio(
        &mut self,
        key: &str,
        name: &str,
        kind: Kind,
        reading: impl Fn(&TrialRecord) -> Part + 'static,
    ) -> &mut Entry {
        self.add_as_ratio(key, name, kind, move |record| Sample::ratio(reading(record)))
    }

    pub(super) fn add_times(
        &mut self,
        key: &str,
        name: &str,
        reading: impl Fn(&TrialRecord) -> Times + 'static,
    ) -> &mut Entry {
        let kind = (SECONDS, Better::Lower, Estimator::Times);
        self.add_as_ratio(key, name, kind, move |record| Sample::times(reading(record)))
    }

    pub(super) fn add_as_ratio(
        &mut self,
        key: &str,
        name: &str,
        kind: Kind,
        reading: impl Fn(&TrialRecord) -> Sample + 'static,
    ) -> &mut Entry {
        let entry = self.add(key, name, kind, reading);
        entry.figure.is_ratio = true;
        entry
    }
}

/// Unit, which way is better, and how it is estimated.
pub(super) type Kind = (&'static str, Better, Estimator);
