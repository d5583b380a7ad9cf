//! The protocol of the crate's page, with every command: `cargo run --example roll_call -- scenario examples/roll_call/roll_call.ron`.

mod kind;
mod robot;

use std::process::ExitCode;

fn main() -> ExitCode {
    desim::kinds::add::<kind::RollCall>();
    desim::cli::main()
}
