//! Numbers as people read them.

use crate::metrics::Estimate;
use crate::metrics::summary::Lasted;

/// What is not known.
pub const NOTHING: &str = "–";

/// A count, its thousands apart.
pub fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut grouped = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped
}

/// A figure that is not negative, with three digits that count, or all of those before the point.
pub fn figure(value: f64) -> String {
    match value {
        _ if value <= 0.0 => "0".to_owned(),
        _ if value >= 999.5 => count(value.round() as u64),
        _ if value >= 99.95 => format!("{value:.0}"),
        _ if value >= 9.995 => format!("{value:.1}"),
        _ if value >= 0.9995 => format!("{value:.2}"),
        _ if value >= 0.01 => format!("{value:.3}"),
        _ => format!("{value:.2e}"),
    }
}

/// A figure that may be negative: what robots measure, a power.
pub fn signed(value: f64) -> String {
    if value < 0.0 {
        format!("\u{2212}{}", figure(-value))
    } else {
        figure(value)
    }
}

/// A figure that may be missing.
pub fn maybe(value: Option<f64>) -> String {
    value.map_or_else(|| NOTHING.to_owned(), figure)
}

/// A share in percent; one that is nearly all is never rounded to all.
pub fn percent(share: f64) -> String {
    match share {
        _ if share <= 0.0 => "0 %".to_owned(),
        _ if share >= 1.0 => "100 %".to_owned(),
        _ => format!("{:.2} %", (share * 100.0).clamp(0.01, 99.99)),
    }
}

/// A duration in the unit that suits it.
#[must_use]
pub fn seconds(value: f64) -> String {
    match value {
        _ if value <= 0.0 => "0 s".to_owned(),
        _ if value < 1e-3 => format!("{} µs", figure(value * 1e6)),
        _ if value < 1.0 => format!("{} ms", figure(value * 1e3)),
        _ => format!("{} s", figure(value)),
    }
}

/// An estimate with its 95 % interval, where there is one, each number written by `write`.
pub fn estimate(estimate: &Estimate, write: impl Fn(f64) -> String) -> String {
    let end = |end: Option<f64>| end.map_or_else(|| NOTHING.to_owned(), &write);
    match (estimate.value, estimate.ci95) {
        (value, [None, None]) => end(value),
        (value, [low, high]) => format!("{} [{}, {}]", end(value), end(low), end(high)),
    }
}

/// How long something lasted on average, seconds, and what is known of what was cut off.
pub fn lasted(lasted: &Lasted) -> String {
    let mean = format!("{} s on average", estimate(&lasted.estimate, figure));
    let cut_off = match lasted.cut_off {
        0 => return mean,
        cut_off => format!("{mean}, {} cut off", count(cut_off)),
    };
    match lasted.restricted_to {
        Some(longest) if lasted.estimate.value.is_some() => {
            format!("{cut_off}, longer than {} counted as that", seconds(longest))
        }
        _ => cut_off,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_have_their_thousands_apart() {
        let written = [0, 999, 1_000, 1_234_567].map(count);
        assert_eq!(written, ["0", "999", "1,000", "1,234,567"]);
    }

    #[test]
    fn figures_keep_three_digits_that_count() {
        let written = [0.0, 0.001_234, 0.123_456, 1.0, 17.25, 99.97, 1400.4, 1_234_567.0].map(figure);
        assert_eq!(
            written,
            ["0", "1.23e-3", "0.123", "1.00", "17.2", "100", "1,400", "1,234,567"]
        );
    }

    #[test]
    fn nearly_all_is_not_all() {
        assert_eq!(
            [0.0, 0.5, 0.999_999, 1.0].map(percent),
            ["0 %", "50.00 %", "99.99 %", "100 %"]
        );
    }

    #[test]
    fn an_open_interval_shows_its_open_end() {
        let open = Estimate {
            value: Some(23.0),
            ci95: [Some(13.0), None],
            n: 21,
        };
        assert_eq!(estimate(&open, figure), "23.0 [13.0, –]");
        assert_eq!(estimate(&Estimate::default(), figure), "–");
    }
}
