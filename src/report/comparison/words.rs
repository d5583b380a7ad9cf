//! What the words of a comparison share: figures as long as they make sense, names, probabilities.

use crate::metrics::Estimate;
use crate::metrics::comparison::{Comparison, Pair, Stopping, Verdict};
use crate::metrics::figures::Figure;
use crate::report::number::{NOTHING, count, figure as number};

/// The value, with as many digits as its interval makes sense of.
pub fn fitted(estimate: &Estimate) -> String {
    let Some(value) = estimate.value else {
        return NOTHING.to_owned();
    };
    let half = match estimate.ci95 {
        // A width that is all rounding is none.
        [Some(low), Some(high)] if high - low > 1e-9 * value.abs() => (high - low) / 2.0,
        _ => return signed(value, &number(value.abs())),
    };
    let digits = (-half.log10().floor()).max(0.0) as usize + usize::from(half < 1.0);
    let write = |value: f64| {
        let written = format!("{:.digits$}", value.abs());
        let grouped = if digits == 0 {
            count(value.abs().round() as u64)
        } else {
            written
        };
        signed(value, &grouped)
    };
    let [low, high] = estimate.ci95.map(|end| end.map_or(NOTHING.to_owned(), write));
    format!("{} [{low}, {high}]", write(value))
}

pub fn signed(value: f64, written: &str) -> String {
    let is_zero = !written.contains(|digit: char| ('1'..='9').contains(&digit));
    if value < 0.0 && !is_zero {
        format!("−{written}")
    } else {
        written.to_owned()
    }
}

/// A figure's value with its unit.
pub fn with_unit(value: &str, figure: &Figure) -> String {
    match figure.unit.as_ref() {
        "1" => value.to_owned(),
        unit => format!("{value} {unit}"),
    }
}

/// A p-value.
pub fn probability(p: Option<f64>) -> String {
    match p {
        None => NOTHING.to_owned(),
        Some(p) if p < 0.001 => "<0.001".to_owned(),
        Some(p) => format!("{p:.3}"),
    }
}

/// A relative difference in percent.
pub fn percent(share: Option<f64>) -> String {
    share.map_or(NOTHING.to_owned(), |share| {
        let percent = share.abs() * 100.0;
        let written = match percent {
            _ if percent < 9.95 => format!("{percent:.1}"),
            _ => count(percent.round() as u64),
        };
        format!("{} %", signed(share, &written))
    })
}

/// What people call a setting.
pub fn label<'a>(comparison: &'a Comparison, name: &'a str) -> &'a str {
    comparison.setting(name).map_or(name, |setting| setting.label.as_str())
}

/// The difference itself: `lower by 12.3 [11.0, 13.1] B/step (45 % less)`.
pub fn change(difference: &Estimate, relative: Option<f64>, figure: &Figure) -> String {
    let falls = difference.value.is_some_and(|value| value < 0.0);
    let [low, high] = difference.ci95;
    let size = Estimate {
        value: difference.value.map(f64::abs),
        ci95: if falls {
            [high.map(|end| -end), low.map(|end| -end)]
        } else {
            [low, high]
        },
        n: difference.n,
    };
    let (way, less) = if falls { ("lower", "less") } else { ("higher", "more") };
    let relative = relative.map_or(String::new(), |share| {
        format!(" ({} {less})", percent(Some(share.abs())))
    });
    format!("{way} by {}{relative}", with_unit(&fitted(&size), figure))
}

/// How many trials would show a difference worth finding; nothing where the two are the same in every trial.
pub fn planned(comparison: &Comparison, pair: &Pair, figure: &Figure) -> String {
    let plan = pair.plan.as_ref().filter(|_| can_differ(pair));
    plan.map_or(String::new(), |plan| {
        let size = with_unit(&number(plan.size), figure);
        format!(
            "; {} trials would show one of {} ({size}) with {:.0} % power",
            count(plan.trials),
            percent(Some(comparison.relevant)),
            plan.power * 100.0
        )
    })
}

/// Whether a pair differs in any trial.
pub fn can_differ(pair: &Pair) -> bool {
    pair.p_adjusted.is_some() || pair.verdict == Verdict::CannotTell
}

/// How adding trials ended.
pub fn stopping(stopping: &Stopping, comparison: &Comparison) -> String {
    let name = comparison
        .figure(&stopping.figure)
        .map_or(stopping.figure.as_str(), |figure| figure.name.as_str());
    let (widest, trials) = (
        stopping.widest.map_or(NOTHING.to_owned(), number),
        count(stopping.trials.into()),
    );
    let asked = number(stopping.width);
    if stopping.reached {
        format!(
            "after {trials} trials of each setting: no interval of {name} is wider than {widest}, and {asked} was asked for"
        )
    } else {
        format!(
            "at the cap of {trials} trials of each setting: the widest interval of {name} is {widest}, and {asked} was asked for"
        )
    }
}
