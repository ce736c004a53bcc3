//! Hands over to the program whichone-link, which alone knows the network, and to whichone-gateway.

use std::ffi::OsString;
use std::io::ErrorKind;
use std::os::unix::process::CommandExt;

use service::exit::{Exit, Failure};
use service::group::{ENV_GROUP, GroupName};
use service::launch;

use crate::cli::LinkArgs;

/// Builds the program whichone-link.
const LINK_HELP: &str = "scripts/link build";

/// `whichone link …`; returns only if that fails.
pub(super) fn link(group: &GroupName, args: LinkArgs) -> Failure {
    // Without arguments the program is a service.
    let arguments = match args.arguments {
        none if none.is_empty() => vec!["--help".into()],
        some => some,
    };
    hand_over("link", LINK_HELP, arguments, Some(group))
}

/// `whichone fleet …`; returns only if that fails.
pub(super) fn fleet(args: LinkArgs, json: bool) -> Failure {
    let json = json.then(|| OsString::from("--json"));
    let arguments = std::iter::once("fleet".into()).chain(args.arguments).chain(json);
    hand_over("link", LINK_HELP, arguments.collect(), None)
}

/// `whichone gateway …`; returns only if that fails.
pub(super) fn gateway(args: LinkArgs) -> Failure {
    let arguments = match args.arguments {
        none if none.is_empty() => vec!["--help".into()],
        some => some,
    };
    hand_over("gateway", "cargo build --release -p gateway", arguments, None)
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
