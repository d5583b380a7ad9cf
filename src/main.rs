//! The `desim` command.
fn main() {}
