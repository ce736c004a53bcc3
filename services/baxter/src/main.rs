//! The simulated Baxter: a service of a group, or, with the name of a drill, fault injection into one
//! that runs.

use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    match words.first().and_then(|word| baxter::fault_injection::kind(word)) {
        Some(kind) => baxter::fault_injection::run(kind, &words[1..]),
        None => service::service_loop::run::<baxter::shell::BaxterProgram>(),
    }
}
