//! The link's program: a service of a robot's group, and the commands of `whichone link`.

use std::process::ExitCode;

fn main() -> ExitCode {
    link::cli::run()
}
