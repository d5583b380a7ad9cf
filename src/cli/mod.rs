//! The command line: the only place that prints and the only exit code.

pub mod check;
pub mod schema;
