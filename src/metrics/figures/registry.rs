//! The figures of a protocol, and how each is read off a trial.

use std::rc::Rc;

use super::figure::{Better, Figure, Sample};
use super::samples::Samples;
use crate::metrics::noted_figure::NotedFigure;
use crate::metrics::record::TrialRecord;
use crate::metrics::unit::SECONDS;
use crate::statistics::{Estimate, Estimator, Part, Times};

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

/// A figure over trials.
#[derive(Clone, Debug)]
pub struct Estimated<'a> {
    /// Which.
    pub figure: &'a Figure,
    /// Whether it stands in the general list of summaries and reports, and not at a place of its own.
    pub is_listed: bool,
    /// The estimate.
    pub estimate: Estimate,
    /// How many values were cut off: of times, of the times themselves, else of the trials.
    pub cut_off: u64,
    /// What a mean of times is restricted to: the longest, if it was cut off.
    pub restricted_to: Option<f64>,
}

impl Entry {
    /// Summaries and reports have no place of their own for it: it stands in their general list.
    pub(super) fn list(&mut self) {
        self.is_listed = true;
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

    /// The figures, each with what all trials tell of it: `samples` has that of each figure, in order.
    ///
    /// # Panics
    /// If it has fewer figures.
    pub fn estimate<'a>(&'a self, samples: &'a Samples) -> impl Iterator<Item = Estimated<'a>> {
        self.entries.iter().enumerate().map(|(place, entry)| {
            let pooled = samples.of(place);
            let lasting = pooled.lasting.unwrap_or_default();
            Estimated {
                figure: &entry.figure,
                is_listed: entry.is_listed,
                estimate: pooled.estimate(&entry.figure),
                cut_off: match entry.figure.estimator {
                    Estimator::Times => lasting.cut_off,
                    _ => pooled.cut_off(),
                },
                restricted_to: lasting.restricted_to,
            }
        })
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
