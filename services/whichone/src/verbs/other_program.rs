//! Verbs that hand over to another program of the group: the link, the gateway, the simulated Baxter.

use std::ffi::OsString;
use std::io::ErrorKind;
use std::os::unix::process::CommandExt;

use service::exit::{Exit, Failure};
use service::group::{ENV_GROUP, GroupName};
use service::launch;

use crate::cli::OtherProgramArgs;

/// Builds the program whichone-link, which alone knows the network.
const LINK_HELP: &str = "scripts/link build";

/// `whichone link …`; returns only if that fails.
pub(super) fn link(group: &GroupName, args: OtherProgramArgs) -> Failure {
    hand_over("link", LINK_HELP, or_help(args), Some(group))
}

/// `whichone fleet …`; returns only if that fails.
pub(super) fn fleet(args: OtherProgramArgs, json: bool) -> Failure {
    let json = json.then(|| OsString::from("--json"));
    let arguments = std::iter::once("fleet".into()).chain(args.arguments).chain(json);
    hand_over("link", LINK_HELP, arguments.collect(), None)
}

/// `whichone gateway …`; returns only if that fails.
pub(super) fn gateway(args: OtherProgramArgs) -> Failure {
    hand_over("gateway", "cargo build --release -p gateway", or_help(args), None)
}

/// `whichone baxter …`; returns only if that fails.
pub(super) fn baxter(group: &GroupName, args: OtherProgramArgs) -> Failure {
    hand_over("baxter", "cargo build --release", or_help(args), Some(group))
}

/// Without arguments the program would be a service.
fn or_help(args: OtherProgramArgs) -> Vec<OsString> {
    if args.arguments.is_empty() { vec!["--help".into()] } else { args.arguments }
}

fn hand_over(
    program: &str,
    help: &str,
    arguments: Vec<OsString>,
    group: Option<&GroupName>,
) -> Failure {
    let program = launch::program_of(program);
    let mut command = launch::command(&program);
    command.args(arguments);
    if let Some(group) = group {
        command.env(ENV_GROUP, group.as_str());
    }
    let error = command.exec();
    let what = match error.kind() {
        ErrorKind::NotFound => {
            format!("{}: no such program; help: build it with `{help}`", program.display())
        }
        _ => format!("{}: {error}", program.display()),
    };
    Failure::new(Exit::NotReached, what)
}
