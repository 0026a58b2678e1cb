//! The program `rocking`.

use std::process::ExitCode;

fn main() -> ExitCode {
    rocking_cli::main()
}
