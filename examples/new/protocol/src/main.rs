//! The `desim` command with a protocol of one's own beside those that it ships.

mod protocol;

use std::process::ExitCode;

fn main() -> ExitCode {
    desim::kinds::add::<protocol::MyProtocol>();
    desim::cli::main()
}
