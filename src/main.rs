//! The `desim` command.

use std::process::ExitCode;

use clap::Parser;
use desim::cli::{self, Cli, log};
use mimalloc::MiMalloc;

/// Of a swarm of tens of thousands the memory lies in huge pages, which takes a sixth off a delivery.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

fn main() -> ExitCode {
    let arguments = Cli::parse();
    log::to_stderr();
    cli::exit(cli::run(arguments.command))
}
