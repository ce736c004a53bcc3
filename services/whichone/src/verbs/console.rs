//! `console`: the link to the console's page.

use std::os::unix::process::CommandExt;
use std::process::{Command, Stdio};
use std::time::Duration;

use command_line::Outcome;
use command_line::output::{Output, note};
use command_line::program::{command, failed};
use safe_files::{replace_private, replace_private_synced};
use serde::Serialize;
use service::console_link::{self, random_secret};
use service::control::Request;
use service::exit::{Exit, Failure};
use service::group::GroupPaths;

use super::operate;
use crate::cli::ConsoleArgs;

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
    if let Some(file) = &args.view {
        // In the place of this process, so that signals reach it.
        let mut viewer = command("console", "view");
        let error = viewer.arg(file).exec();
        return Err(failed(&viewer, &error));
    }
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

/// Replaces the token, and then has the console read it. The page is not touched where the new token cannot be
/// written.
fn renew(paths: &GroupPaths) -> Result<(), Failure> {
    operate::status_of(paths)?;
    let file = console_link::token_file(paths);
    let written =
        random_secret().and_then(|token| replace_private_synced(&file, format!("{token}\n")));
    written.map_err(|error| {
        let what = format!("{}: {error}; the former token stays", file.display());
        Failure::new(Exit::Storage, what)
    })?;
    let restart = Request::Restart {
        service: "console".to_owned(),
        original: false,
        wait_ms: PATIENCE.as_millis() as u64,
    };
    operate::ask(paths, &restart, PATIENCE)?;
    Ok(())
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
        let args = ConsoleArgs { open: false, renew: false, view: None };
        let error = console(&paths, &args, &mut Output::standard(false)).unwrap_err();
        assert!(error.to_string().contains("whichone start console"), "{error}");
    }
}
