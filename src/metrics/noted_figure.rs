//! Figures of what robots note under names of their own: each protocol says which it has.

use super::figures::{Better, Figure, Sample};
use super::noted::{Amount, Values};
use super::record::TrialRecord;
use crate::statistics::{Estimator, Part};

/// What keys of such figures begin with, so that they are told from others.
pub const PREFIX: &str = "noted.";

/// A figure of what robots [count](crate::protocol::Output::count) and [measure](crate::protocol::Output::measure).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotedFigure {
    /// Its key, of small letters, digits, `_` and dots, its unit last: `delay_s.mean`.
    pub key: &'static str,
    /// What reports call it.
    pub name: &'static str,
    /// Its unit, `1` for none.
    pub unit: &'static str,
    /// Which way is better.
    pub better: Better,
    reading: Reading,
}

/// How a figure is read off what was noted.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Reading {
    Mean(&'static str),
    Quantile(&'static str, f64),
    Share(&'static str, &'static str),
    PerRobot(&'static str),
    PerSecond(&'static str),
}

impl NotedFigure {
    /// The mean of what robots measured as `measured`: the sum over all robots and trials by their number. It may be negative.
    #[must_use]
    pub const fn mean(key: &'static str, name: &'static str, unit: &'static str, measured: &'static str) -> Self {
        Self::of(key, name, unit, Reading::Mean(measured))
    }

    /// The `q`-quantile, `q` from 0 to 1, of what all robots of a trial measured as `measured`, within 1/128; its mean over trials.
    #[must_use]
    pub const fn quantile(
        key: &'static str,
        name: &'static str,
        unit: &'static str,
        measured: &'static str,
        q: f64,
    ) -> Self {
        Self::of(key, name, unit, Reading::Quantile(measured, q))
    }

    /// What robots counted as `some` by what they counted as `all`, which must be no less: a share.
    #[must_use]
    pub const fn share(key: &'static str, name: &'static str, some: &'static str, all: &'static str) -> Self {
        Self::of(key, name, "1", Reading::Share(some, all))
    }

    /// What robots counted as `counted`, a robot and trial.
    #[must_use]
    pub const fn per_robot(key: &'static str, name: &'static str, counted: &'static str) -> Self {
        Self::of(key, name, "1", Reading::PerRobot(counted))
    }

    /// What the whole swarm counted as `counted`, a second.
    #[must_use]
    pub const fn per_second(key: &'static str, name: &'static str, counted: &'static str) -> Self {
        Self::of(key, name, "Hz", Reading::PerSecond(counted))
    }

    const fn of(key: &'static str, name: &'static str, unit: &'static str, reading: Reading) -> Self {
        Self {
            key,
            name,
            unit,
            better: Better::Lower,
            reading,
        }
    }

    /// The same figure, of which more is better: less is, if nobody says so.
    #[must_use]
    pub const fn higher(self) -> Self {
        Self {
            better: Better::Higher,
            ..self
        }
    }

    /// The figure as others have it.
    #[must_use]
    pub fn figure(&self) -> Figure {
        let (estimator, is_ratio) = match self.reading {
            Reading::Mean(_) => (Estimator::Signed, true),
            Reading::Quantile(..) => (Estimator::Signed, false),
            Reading::Share(..) => (Estimator::ShareOf, true),
            Reading::PerRobot(_) => (Estimator::Mean, false),
            Reading::PerSecond(_) => (Estimator::Rate, true),
        };
        Figure {
            key: format!("{PREFIX}{}", self.key),
            name: self.name.to_owned(),
            unit: self.unit.into(),
            better: self.better,
            is_ratio,
            estimator,
        }
    }

    /// What a trial tells of it. Where nobody noted anything of the kind, it tells nothing.
    ///
    /// # Panics
    /// If more was counted as a part of something than of the whole: the protocol's own counting is wrong.
    #[must_use]
    pub fn read(&self, record: &TrialRecord) -> Sample {
        match self.reading {
            Reading::Mean(name) => {
                let parts = values(record, name).map(|values| [values.sum, values.count as f64]);
                Sample::ratio(parts.fold([0.0; 2], added))
            }
            Reading::Quantile(name, q) => {
                let all = values(record, name).cloned().reduce(Values::and);
                Sample::plain(all.map(|all| all.quantile(q)))
            }
            Reading::Share(some, all) => {
                let (some_counted, counted) = (total(record, some), total(record, all));
                assert!(
                    some_counted <= counted,
                    "the figure `{}` has {some_counted} `{some}` of {counted} `{all}`, in trial {}",
                    self.key,
                    record.trial
                );
                Sample::ratio([some_counted as f64, counted as f64])
            }
            Reading::PerRobot(name) => {
                let robots = record.robots.len() as f64;
                Sample::plain((robots > 0.0).then(|| total(record, name) as f64 / robots))
            }
            Reading::PerSecond(name) => Sample::ratio([total(record, name) as f64, record.simulated.as_secs()]),
        }
    }
}

fn added(sum: Part, part: Part) -> Part {
    [sum[0] + part[0], sum[1] + part[1]]
}

/// What each robot measured under `name`.
fn values<'r>(record: &'r TrialRecord, name: &'r str) -> impl Iterator<Item = &'r Values> {
    let named = record.noted.iter().filter(move |noted| noted.name == name);
    named.filter_map(|noted| match &noted.amount {
        Amount::Values(values) => Some(values),
        Amount::Count(_) => None,
    })
}

/// What all robots counted under `name`.
fn total(record: &TrialRecord, name: &str) -> u64 {
    let named = record.noted.iter().filter(|noted| noted.name == name);
    let counts = named.filter_map(|noted| match noted.amount {
        Amount::Count(count) => Some(count),
        Amount::Values(_) => None,
    });
    counts.fold(0, u64::saturating_add)
}
