//! The policy service alone, for the tests of its inspections.

use std::process::ExitCode;

fn main() -> ExitCode {
    policy::run()
}
