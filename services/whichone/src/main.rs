//! `whichone`: the command line program.

use std::process::ExitCode;

fn main() -> ExitCode {
    whichone::run(std::env::args_os()).code()
}
