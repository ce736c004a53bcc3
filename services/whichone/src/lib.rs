//! The command line of users and scripts.
//!
//! A verb that talks to a group holds no state of its own: it asks the supervisor over its control
//! socket, or is one more client of the group's topics, and can be killed at any moment without
//! harm. Verbs for evaluation, development and authors of scenes are in `laboratory`; what both share
//! is in `command_line`.

use std::ffi::OsString;

use clap::error::ErrorKind;
use command_line::output::{Output, print_error, print_json_error};
use command_line::shipped;
use service::exit::{Exit, Failure};

use crate::cli::Cli;

pub mod cli;

pub mod verbs;

/// Prints the identity of this build.
fn print_version(json: bool) -> Exit {
    let (mut out, build) = (Output::standard(json), build_info::current());
    let printed = match json {
        true => out.json(build),
        false => out.line(format_args!("whichone {build}")),
    };
    printed.map_or_else(|failure| failure.exit, |()| Exit::Ok)
}

/// Runs the command line `arguments`, program name first, and returns the exit code of the process. The
/// configuration in `files` is built in.
pub fn run(arguments: impl IntoIterator<Item = OsString>, files: shipped::Files) -> Exit {
    shipped::provide(files);
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let json = arguments.iter().take_while(|word| *word != "--").any(|word| word == "--json");
    let cli = match Cli::parse_line(arguments) {
        Ok(cli) => cli,
        Err(error) => {
            if error.kind() == ErrorKind::DisplayVersion {
                return print_version(json);
            }
            let exit = if error.use_stderr() { Exit::Usage } else { Exit::Ok };
            if exit == Exit::Usage && json {
                let text = error.to_string();
                let text = text.trim_end().trim_start_matches("error: ");
                print_json_error(&Failure::new(exit, text));
            }
            // Nothing to do if the output is closed.
            let _ = error.print();
            return exit;
        }
    };
    let mut out = Output::standard(cli.common.json);
    let ended = verbs::run(cli, &mut out).and_then(|exit| out.flush().map(|()| exit));
    drop(out);
    ended.unwrap_or_else(|failure| {
        if json {
            print_json_error(&failure);
        }
        print_error(&failure);
        failure.exit
    })
}
