//! `console`: the link to the console's page.

use std::fs;
use std::io;
use std::process::{Command, Stdio};
use std::time::Duration;

use serde::Serialize;
use service::console_link::{self, replace_private};
use service::control::{Request, Target};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;

use super::operate;
use crate::Outcome;
use crate::cli::ConsoleArgs;
use crate::output::{Output, note};

/// Time for which the console may take to stop or to start.
const PATIENCE: Duration = Duration::from_secs(20);

#[derive(Serialize)]
struct Printed {
    console: Option<String>,
    token: Option<String>,
    link: String,
}

/// Prints the link, or opens it.
pub(super) fn console(paths: &GroupPaths, args: &ConsoleArgs, out: &mut Output<'_>) -> Outcome {
    if args.renew {
        renew(paths)?;
    }
    let link = console_link::link(paths).ok_or_else(|| {
        let help = "help: start it with `whichone up` or `whichone start console`";
        Failure::new(Exit::NotReached, format!("no page is served; {help}"))
    })?;
    if args.open {
        open(paths, &link)?;
        note("the page is opened in the browser");
    } else if out.is_json() {
        let (console, token) = (console_link::address(paths), console_link::token(paths));
        out.json(&Printed { console, token, link })?;
    } else {
        out.line(link)?;
    }
    Ok(Exit::Ok)
}

/// Replaces the token: the console makes a new one when it starts without its file.
fn renew(paths: &GroupPaths) -> Result<(), Failure> {
    let target = || Target { service: "console".to_owned(), wait_ms: PATIENCE.as_millis() as u64 };
    operate::ask(paths, &Request::Stop(target()), PATIENCE)?;
    let file = console_link::token_file(paths);
    let removed = match fs::remove_file(&file) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    };
    // It is started again in any case.
    operate::ask(paths, &Request::Start(target()), PATIENCE)?;
    let failed = |error| Failure::new(Exit::Storage, format!("{}: {error}", file.display()));
    removed.map_err(failed)
}

/// Opens the link by a file that only the owner can read: every user can read the arguments with which
/// a browser is started.
fn open(paths: &GroupPaths, link: &str) -> Result<(), Failure> {
    let file = paths.run().join("console.html");
    let page = format!("<!doctype html><meta http-equiv=\"refresh\" content=\"0;url={link}\">\n");
    let failed = |error| Failure::new(Exit::Storage, format!("{}: {error}", file.display()));
    replace_private(&file, &page).map_err(failed)?;
    let mut browser = Command::new("xdg-open");
    browser.arg(&file).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let opened = browser.status().is_ok_and(|status| status.success());
    if opened {
        return Ok(());
    }
    let what = format!("no browser was opened; help: open {} in one", file.display());
    Err(Failure::new(Exit::NotReached, what))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn link_needs_a_page_that_is_served() {
        let (_home, paths) = super::super::lab();
        let args = ConsoleArgs { open: false, renew: false };
        let error = console(&paths, &args, &mut Output::standard(false)).unwrap_err();
        assert!(error.to_string().contains("whichone start console"), "{error}");
    }
}
