//! The `bowling` program: everything is in the library beside it.

use std::process::ExitCode;

fn main() -> ExitCode {
    bowling_app::run(std::env::args_os())
}
