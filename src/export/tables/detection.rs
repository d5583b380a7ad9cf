//! `detection.parquet`: a row for each suspicion, and for each failure and robot that observed it.

use super::super::table::Column;
use crate::engine::{SimTime, Span};
use crate::metrics::TrialRecord;
use crate::metrics::detection::{FailureOutcome, ObservedFailure, Suspicion};
use crate::radio::LossCause;

/// A suspicion or an observed failure of one trial.
pub struct Row {
    trial: u32,
    event: Event,
}

enum Event {
    Suspicion(Suspicion),
    Failure(ObservedFailure),
}

/// First the suspicions, then the failures, each in order of time.
pub fn rows(record: &TrialRecord) -> impl Iterator<Item = Row> {
    let suspicions = record.detection.suspicions.iter().map(Event::Suspicion);
    let failures = record.detection.failures.iter().map(Event::Failure);
    let trial = record.trial;
    suspicions.chain(failures).map(move |event| Row { trial, event })
}

impl Row {
    fn suspicion(&self) -> Option<&Suspicion> {
        match &self.event {
            Event::Suspicion(suspicion) => Some(suspicion),
            Event::Failure(_) => None,
        }
    }

    /// What one holds or the other.
    fn either<T>(&self, suspicion: impl FnOnce(&Suspicion) -> T, failure: impl FnOnce(&ObservedFailure) -> T) -> T {
        match &self.event {
            Event::Suspicion(event) => suspicion(event),
            Event::Failure(event) => failure(event),
        }
    }
}

type Col = Column<Row>;

pub fn columns() -> Vec<Column<Row>> {
    let mut columns = vec![
        Col::id("trial", |row| row.trial),
        Col::text("event", |row| row.either(|_| "suspicion", |_| "failure").into()),
        Col::id("observer", |row| {
            row.either(|event| event.observer, |event| event.observer).0
        }),
        Col::id("subject", |row| {
            row.either(|event| event.subject, |event| event.subject).0
        }),
        Col::f64("time_s", |row| row.either(|event| event.at, |event| event.at).as_secs()),
        Col::text("verdict", |row| {
            row.either(|event| event.verdict().name(), |event| event.outcome.name())
                .into()
        }),
        Col::text("cause", |row| {
            row.either(|event| event.cause.name(), |_| "failure").into()
        }),
        Col::optional_f64("heard_s", |row| row.suspicion().map(|event| event.heard.as_secs())),
        Col::optional_f64("trusted_s", |row| row.suspicion()?.until.map(SimTime::as_secs)),
        Col::optional_f64("mistake_duration_s", |row| row.suspicion()?.duration.map(Span::as_secs)),
        Col::optional_id("mistake_cut_off", |row| {
            row.suspicion()
                .filter(|event| event.duration.is_some())
                .map(|event| event.cut_off.into())
        }),
        Col::optional_f64("detection_time_s", |row| match &row.event {
            Event::Failure(ObservedFailure {
                outcome: FailureOutcome::Detected(after),
                ..
            }) => Some(after.as_secs()),
            _ => None,
        }),
        Col::optional_f64("watched_s", |row| match &row.event {
            Event::Failure(failure) => Some(failure.watched.as_secs()),
            Event::Suspicion(_) => None,
        }),
    ];
    columns.extend(LossCause::ALL.iter().enumerate().map(|(index, cause)| {
        Col::optional_id(format!("missed_{}", cause.name()), move |row| {
            row.suspicion().map(|event| event.missed.lost[index])
        })
    }));
    columns.push(Col::optional_id("missed_out_of_range", |row| {
        row.suspicion().map(|event| event.missed.out_of_range)
    }));
    columns.push(Col::optional_id("missed_under_way", |row| {
        row.suspicion().map(|event| event.missed.under_way)
    }));
    columns
}
