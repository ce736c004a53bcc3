//! Runs one hot path a number of times, for a tool that counts its instructions: `instructions NAME TIMES`.
//! Without arguments it lists the paths, each with a number of times that takes some ten million instructions.
//!
//! Every run does the same work, so the difference between two numbers of times is that of the path
//! alone, without what prepares it.

#![allow(clippy::print_stdout, reason = "a program for the tests")]

mod decisions;
mod kinematics;
mod messages;

use std::process::ExitCode;

/// A path: its name, a number of times, and what prepares and then runs it so many times.
type Path = (&'static str, u32, fn(u32));

const PATHS: [Path; 10] = [
    ("belief update, 6 objects", 100_000, |times| decisions::update(6, times)),
    ("belief update, 1000 objects", 2_000, |times| decisions::update(1_000, times)),
    ("decision of lookahead, six bowls", 20, decisions::lookahead),
    ("reading of four utterances", 500, decisions::read),
    ("policy's steps for a request and its cancellation", 100, messages::step),
    ("inverse kinematics, Baxter", 1_000, kinematics::baxter),
    ("inverse kinematics, UR5e", 1_000, kinematics::ur5e),
    ("forward kinematics and Jacobian", 10_000, kinematics::jacobian),
    ("fixed message, written and read", 5_000, messages::fixed),
    ("postcard message, written and read", 5_000, messages::encoded),
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let chosen = |name: &str| PATHS.iter().find(|(own, ..)| *own == name);
    match arguments.as_slice() {
        [] => PATHS.iter().for_each(|(name, times, _)| println!("{times} {name}")),
        [name, times] => match (chosen(name), times.parse()) {
            (Some((.., run)), Ok(times)) => run(times),
            _ => return ExitCode::from(64),
        },
        _ => return ExitCode::from(64),
    }
    ExitCode::SUCCESS
}
