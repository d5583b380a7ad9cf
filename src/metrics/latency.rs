//! Latencies as a histogram of fixed relative width.

/// Counts of latencies.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LatencyHistogram;
