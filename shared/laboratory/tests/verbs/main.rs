//! The verbs as scripts call them, with the shipped configuration.
#![allow(clippy::unwrap_used, reason = "this is test code")]

use std::sync::Once;

use clap::Parser;
use command_line::output::Output;
use laboratory::Verb;
use service::exit::{Exit, Failure};
use service::group::{GroupName, GroupPaths};

mod arm;
mod batch;
mod study;

/// The folder of the repository.
const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

#[derive(Parser)]
struct Line {
    #[arg(long, global = true)]
    json: bool,
    #[command(subcommand)]
    verb: Verb,
}

/// What a verb has printed, and how it ended.
struct Ended {
    exit: Exit,
    out: Vec<u8>,
    error: String,
}

impl Ended {
    #[track_caller]
    fn succeeded(self) -> Vec<u8> {
        assert_eq!(self.exit, Exit::Ok, "{}", self.error);
        self.out
    }

    #[track_caller]
    fn failed(self, exit: Exit, part: &str) {
        assert_eq!(self.exit, exit, "{}", self.error);
        assert!(self.error.contains(part), "{part}: {}", self.error);
        assert!(self.out.is_empty(), "{}", String::from_utf8_lossy(&self.out));
    }
}

/// Runs a line of words in the folder of the repository.
fn run(words: &[&str]) -> Ended {
    static IN_ROOT: Once = Once::new();
    IN_ROOT.call_once(|| std::env::set_current_dir(ROOT).unwrap());
    let line = match Line::try_parse_from([&["whichone"], words].concat()) {
        Ok(line) => line,
        Err(error) => {
            return Ended { exit: Exit::Usage, out: Vec::new(), error: error.to_string() };
        }
    };
    let mut out = Vec::new();
    let paths = || GroupPaths::resolve(&GroupName::new("laboratory")?);
    let ended = laboratory::run(line.verb, paths, &mut Output::to(&mut out, line.json));
    match ended {
        Ok(exit) => Ended { exit, out, error: String::new() },
        Err(Failure { exit, message }) => Ended { exit, out, error: message },
    }
}
