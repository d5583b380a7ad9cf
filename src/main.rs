//! The `desim` command.

use std::process::ExitCode;

use clap::Parser;
use desim::cli::{self, Cli, log};

fn main() -> ExitCode {
    let arguments = Cli::parse();
    log::to_stderr();
    cli::exit(cli::run(arguments.command))
}
