//! Trials of one scenario: in parallel, interruptible, resumable.
