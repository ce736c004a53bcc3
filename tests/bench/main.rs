//! Benchmarks of the decision core, of the arm and of the running group: what a decision and a
//! belief update cost and how good decisions are; how often and how fast poses are reached, beside
//! other solvers; how fast the group starts and recovers, how long an utterance
//! takes to become a decision and where the time goes, what it costs when nothing happens, how
//! steadily joint states come, and how much of spoken sentences is understood.
//!
//! Machines are noisy: each figure stands beside a peer that was measured in the same run, and no
//! test rests on one.

mod arm;
mod core;
mod idle;
mod jitter;
mod latency;
mod peers;
mod report;
mod speech;
mod start;

use report::Report;
use std::process::ExitCode;

const HELP: &str = "Usage: bench [--quick] [--core] [--kinematics] [--joints] [--speech]

  --quick       fewer repetitions and smaller series: a minute in place of several
  --core        only the decision core, without starting a group
  --kinematics  only the arm: inverse kinematics, motions and clearances beside other solvers
  --joints      only how steadily joint states come
  --speech      only spoken input: what is understood of spoken sentences, how late
";

const OPTIONS: [&str; 5] = ["--quick", "--core", "--kinematics", "--joints", "--speech"];

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if words.iter().any(|word| word == "--help" || word == "-h") {
        report::print(HELP);
        return ExitCode::SUCCESS;
    }
    if let Some(unknown) = words.iter().find(|word| !OPTIONS.contains(&word.as_str())) {
        report::print(&format!("{unknown} is no option\n\n{HELP}"));
        return ExitCode::from(64);
    }
    let asked = |word: &str| words.iter().any(|known| known == word);
    let mut report = Report::default();
    let [core_only, arm_only, joints_only, speech_only] =
        ["--core", "--kinematics", "--joints", "--speech"].map(asked);
    let all = !core_only && !arm_only && !joints_only && !speech_only;
    if all || core_only {
        peers::measure(&mut report);
        let effort = if asked("--quick") { core::Effort::QUICK } else { core::Effort::FULL };
        core::measure(&mut report, effort);
    }
    if all || arm_only {
        arm::measure(&mut report, asked("--quick"));
    }
    if all {
        start::measure(&mut report);
        latency::measure(&mut report);
        idle::measure(&mut report);
    }
    if all || joints_only {
        jitter::measure(&mut report);
    }
    if all || speech_only {
        speech::measure(&mut report, asked("--quick"));
    }
    match report.write() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            report::print(&format!("target/bench: {error}"));
            ExitCode::from(74)
        }
    }
}
