//! Heartbeats and status timeouts on their own: the workload that failure detectors are measured on.
