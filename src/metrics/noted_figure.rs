//! Figures of what robots note under names of their own: each protocol says which it has.

use super::figures::{Better, Figure, Sample};
use super::noted::{Amount, Values};
use super::record::TrialRecord;
use crate::statistics::{Estimator, Part};

/// What keys of such figures begin with, so that they are told from others.
pub const PREFIX: &str = "noted.";

/// A figure of what robots [count](crate::protocol::Output::count) and [measure](crate::protocol::Output::measure): a kind says which it has
/// ([`Kind::figures`](crate::kind::Kind::figures)). It stands in the summary, in reports and on pages, with an interval over trials, and
/// a study names it as `noted.<key>`.
///
/// ```
/// use desim::metrics::NotedFigure;
///
/// let figures = [
///     // of `output.measure("delay", ...)`, in seconds
///     NotedFigure::mean("delay_s", "delay of an answer", "s", "delay"),
///     NotedFigure::quantile("delay_s.p95", "delay of an answer, 95 %", "s", "delay", 0.95),
///     // of `output.count("answered", 1)` and `output.count("asked", 1)`
///     NotedFigure::share("success", "questions answered", "answered", "asked").higher(),
///     NotedFigure::per_robot("questions", "questions of a robot", "asked"),
///     NotedFigure::per_second("questions_hz", "questions of the swarm", "asked"),
/// ];
/// assert_eq!(figures[2].figure().key, "noted.success");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotedFigure {
    /// Its key, of small letters, digits, `_` and dots, its unit last: `delay_s.mean`.
    pub key: &'static str,
    /// What reports call it.
    pub name: &'static str,
    /// Its unit, as reports show it, such as `s` or `m`; `1` for none.
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

    /// The `q`-quantile, `q` from 0 to 1, of what all robots of a trial measured as `measured`, less than 1/128 nearer to zero; its
    /// mean over trials. With a `q` of 0 it is the least, with one of 1 the greatest, both exactly.
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

    /// What robots counted as `some` by what they counted as `all`, over all robots and trials: a share, from 0 to 1. A trial in which
    /// they counted more of `some` than of `all` ends with an error ([`fault`](Self::fault)).
    #[must_use]
    pub const fn share(key: &'static str, name: &'static str, some: &'static str, all: &'static str) -> Self {
        Self::of(key, name, "1", Reading::Share(some, all))
    }

    /// What robots counted as `counted`, a robot and trial; its mean over trials.
    #[must_use]
    pub const fn per_robot(key: &'static str, name: &'static str, counted: &'static str) -> Self {
        Self::of(key, name, "1", Reading::PerRobot(counted))
    }

    /// What the whole swarm counted as `counted`, a simulated second, in Hz.
    #[must_use]
    pub const fn per_second(key: &'static str, name: &'static str, counted: &'static str) -> Self {
        Self::of(key, name, "Hz", Reading::PerSecond(counted))
    }

    /// The same figure in another unit, such as `bit/s` for what is counted in bits.
    #[must_use]
    pub const fn in_unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
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

    /// What is wrong with what robots counted for it in `record`, if something is: more of a part than of the whole. A run that a
    /// scenario asked for ends with an error then.
    #[must_use]
    pub fn fault(&self, record: &TrialRecord) -> Option<String> {
        let Reading::Share(some, all) = self.reading else {
            return None;
        };
        let [part, whole] = [some, all].map(|name| total(record, name));
        (part > whole).then(|| {
            format!(
                "robots counted {part} `{some}` and {whole} `{all}`, of which the figure `{}` is to be the share: the protocol counts wrongly",
                self.key
            )
        })
    }

    /// What a trial tells of it. Where nobody noted anything of the kind, or there is a [fault](Self::fault) in it, it tells nothing.
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
                let parts = [some, all].map(|name| total(record, name) as f64);
                Sample::ratio(if self.fault(record).is_none() { parts } else { [0.0; 2] })
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
