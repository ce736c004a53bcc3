//! `whichone`: the program that people and scripts use.

use std::process::ExitCode;

fn main() -> ExitCode {
    whichone::run(std::env::args_os()).code()
}
