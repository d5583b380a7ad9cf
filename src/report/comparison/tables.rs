//! The tables of a comparison.

use super::factors;
use super::rows::{effect_verdict, put};
use super::words::{can_differ, fitted, label, percent, probability};
use crate::metrics::comparison::{Comparison, Pair, Setting, Verdict};
use crate::metrics::figures::{Better, Figure};
use crate::report::layout::Page;
use crate::report::number::{NOTHING, count, figure as number};

fn compared(comparison: &Comparison) -> Vec<&Figure> {
    comparison
        .compared
        .iter()
        .filter_map(|key| comparison.figure(key))
        .collect()
}

fn title(figure: &Figure) -> String {
    let better = match figure.better {
        Better::Lower => "less is better",
        Better::Higher => "more is better",
    };
    match figure.unit.as_ref() {
        "1" => format!("{}\n{better}", figure.name),
        unit => format!("{}\n{unit}, {better}", figure.name),
    }
}

/// A table of settings × figures.
pub fn settings(page: &mut Page, comparison: &Comparison) {
    page.heading("Settings");
    let figures = compared(comparison);
    let header: Vec<String> = std::iter::once(factors(comparison))
        .chain(figures.iter().map(|figure| title(figure)))
        .collect();
    let rows = comparison.settings.iter().map(|setting| {
        let values = figures.iter().map(|figure| value(setting, figure));
        std::iter::once(marked(comparison, setting)).chain(values).collect()
    });
    put(page, &header, rows);
    let primary = |setting: &Setting| {
        setting
            .figures
            .0
            .iter()
            .any(|(_, figure)| figure.survival.as_ref().is_some_and(|survival| survival.censored > 0))
    };
    if comparison.settings.iter().any(primary) {
        page.gap();
        page.words("Means of steps are restricted: a trial that did not complete counts with the time limit.");
    }
}

fn factors(comparison: &Comparison) -> String {
    let names: Vec<&str> = comparison.factors.iter().map(|factor| factor.name.as_str()).collect();
    names.join(",\n")
}

fn marked(comparison: &Comparison, setting: &Setting) -> String {
    if comparison.reference.as_ref() == Some(&setting.name) {
        format!("{} (reference)", setting.label)
    } else {
        setting.label.clone()
    }
}

/// The value; of what may be cut off, also the median.
fn value(setting: &Setting, figure: &Figure) -> String {
    let Some(estimated) = setting.figure(&figure.key) else {
        return NOTHING.to_owned();
    };
    let mean = fitted(&estimated.estimate);
    match &estimated.survival {
        Some(survival) if survival.censored > 0 => {
            format!(
                "{mean}\nmedian {}, {} cut off",
                fitted(&survival.median),
                count(survival.censored)
            )
        }
        Some(survival) => format!("{mean}\nmedian {}", fitted(&survival.median)),
        None => mean,
    }
}

/// For each figure a table of what factors do, and one of the differences between settings.
pub fn differences(page: &mut Page, comparison: &Comparison) {
    for figure in compared(comparison) {
        factors::effects(page, comparison, figure);
        if comparison.pairs_in(&figure.key).next().is_none() {
            continue;
        }
        let against = comparison
            .reference
            .as_deref()
            .map_or("", |name| label(comparison, name));
        let heading = match comparison.reference {
            Some(_) => format!("Differences in {}, against {against}", figure.name),
            None => format!("Differences in {}, pair by pair", figure.name),
        };
        page.heading(&heading);
        let header = ["", "difference", "relative", "Cliff's δ", "p adjusted", ""].map(str::to_owned);
        let rows = comparison
            .pairs_in(&figure.key)
            .map(|pair| difference(comparison, pair));
        put(page, &header, rows);
    }
    if comparison
        .pairs
        .iter()
        .any(|pair| is_unclear(pair) && pair.plan.is_some())
    {
        page.gap();
        page.words(&format!(
            "Unclear: no detectable difference. Cannot tell: so few trials cannot show any. The number of trials is what would show one of {} of the other's value with 80 % power.",
            percent(Some(comparison.relevant))
        ));
    }
}

/// Whether a difference may be there that the trials did not show, or could not.
fn is_unclear(pair: &Pair) -> bool {
    can_differ(pair) && matches!(pair.verdict, Verdict::NoDetectableDifference | Verdict::CannotTell)
}

fn difference(comparison: &Comparison, pair: &Pair) -> Vec<String> {
    let setting = label(comparison, &pair.setting).to_owned();
    let name = match comparison.reference {
        Some(_) => setting,
        None => format!("{setting}\nless {}", label(comparison, &pair.against)),
    };
    let verdict = match &pair.plan {
        Some(plan) if is_unclear(pair) => format!("{}, {}", effect_verdict(pair.verdict), count(plan.trials)),
        _ if pair.verdict == Verdict::NoDetectableDifference && !can_differ(pair) => "the same".to_owned(),
        _ => effect_verdict(pair.verdict).to_owned(),
    };
    let delta = pair
        .cliffs_delta
        .value
        .map_or(NOTHING.to_owned(), |delta| format!("{delta:.2}").replace('-', "−"));
    vec![
        name,
        fitted(&pair.difference),
        percent(pair.relative),
        delta,
        probability(pair.p_adjusted),
        verdict,
    ]
}

/// What common random numbers gain, in the figure that the study is about.
pub fn gains(page: &mut Page, comparison: &Comparison) {
    let Some(figure) = comparison.figure(&comparison.primary) else {
        return;
    };
    let gains: Vec<_> = comparison
        .pairs_in(&figure.key)
        .filter_map(|pair| Some((pair, pair.gain.as_ref()?)))
        .collect();
    if gains.is_empty() {
        return;
    }
    page.heading(&format!(
        "Common random numbers: variance of differences in {}",
        figure.name
    ));
    let header = ["", "paired", "independent seeds", "gain"].map(str::to_owned);
    let rows = gains.iter().map(|(pair, gain)| {
        let name = format!(
            "{} − {}",
            label(comparison, &pair.setting),
            label(comparison, &pair.against)
        );
        let ratio = gain
            .ratio
            .map_or(NOTHING.to_owned(), |ratio| format!("× {}", number(ratio)));
        vec![
            name,
            number(gain.paired_variance),
            number(gain.independent_variance),
            ratio,
        ]
    });
    put(page, &header, rows);
}

/// The settings that no other beats in two figures.
pub fn pareto(page: &mut Page, comparison: &Comparison) {
    let Some(pareto) = &comparison.pareto else { return };
    let [x, y] = [&pareto.x, &pareto.y].map(|key| comparison.figure(key));
    let (Some(x), Some(y)) = (x, y) else { return };
    page.heading("Pareto front");
    let front: Vec<&str> = pareto
        .points
        .iter()
        .filter(|point| point.on_front)
        .map(|point| label(comparison, &point.setting))
        .collect();
    page.words(&format!(
        "No other setting beats these in both {} and {}: {}.",
        x.name,
        y.name,
        front.join("; ")
    ));
}
