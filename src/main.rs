//! The `desim` command, with the kinds of protocols that desim ships.

use std::process::ExitCode;

use mimalloc::MiMalloc;

/// Of a swarm of tens of thousands the memory lies in huge pages, which takes a sixth off a delivery.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

fn main() -> ExitCode {
    desim::cli::main()
}
