//! The catalogue: the figures that desim ships.

use super::registry::Registry;
use super::{bandwidth, connectivity, detection, gossip, healing, mission, pairs, radio};

impl Registry {
    /// The figures of a protocol that gives its topics these names.
    #[must_use]
    pub fn of(topics: &[&str]) -> Self {
        let mut registry = Self::default();
        mission::declare(&mut registry);
        connectivity::declare(&mut registry);
        radio::declare(&mut registry);
        bandwidth::declare(&mut registry, topics);
        detection::declare(&mut registry);
        healing::declare(&mut registry);
        gossip::declare(&mut registry, topics);
        pairs::declare(&mut registry);
        registry
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::figures::Better;

    #[test]
    fn every_figure_knows_which_way_is_better() {
        let higher = [
            "completion_ratio",
            "lambda2_min",
            "connected_share",
            "neighbours",
            "pairs.delivery_ratio",
            "delivery_ratio",
            "detection.mistake_recurrence_s",
            "detection.query_accuracy",
            "healing.healed_ratio",
            "spread.informed_ratio",
        ];
        let registry = Registry::of(&["status", "probe"]);
        let mut found: Vec<&str> = registry
            .figures()
            .filter(|figure| figure.better == Better::Higher)
            .map(|figure| figure.key.as_str())
            .collect();
        found.sort_unstable();
        let mut higher = higher.to_vec();
        higher.sort_unstable();
        assert_eq!(
            found, higher,
            "of every other figure less is better: bytes, duplicates, latencies, steps, times of mistakes"
        );
        assert!(
            registry
                .figures()
                .any(|figure| figure.key == "duplicates" && figure.better == Better::Lower)
        );
    }
}
