//! The `desim` command.

use std::process::ExitCode;

use desim::cli::{self, log};
use mimalloc::MiMalloc;

/// Of a swarm of tens of thousands the memory lies in huge pages, which takes a sixth off a delivery.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

fn main() -> ExitCode {
    match cli::arguments(std::env::args_os()) {
        Ok(arguments) => {
            log::to_stderr();
            cli::exit(cli::run(arguments.command))
        }
        Err(status) => status,
    }
}
