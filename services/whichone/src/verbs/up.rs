//! `up`: start of a group.

use std::thread;
use std::time::{Duration, Instant};

use command_line::output::{Output, note};
use command_line::{Outcome, configuration};
use serde::Serialize;
use service::console_link;
use service::control::{CallError, Request};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::launch::{self, LaunchError, Options};
use service::status::GroupStatus;

use super::operate;
use crate::cli::{ConfigArgs, UpArgs, WaitFor};

/// Time for which a new supervisor waits for services of a killed one.
const EARLIER_SERVICES: Duration = Duration::from_secs(25);
/// Time that a killed supervisor may take to end.
const DYING: Duration = Duration::from_secs(1);
/// Interval at which a supervisor that is starting is looked for.
const LOOK_EVERY: Duration = Duration::from_millis(50);

/// A started group with `--json`.
#[derive(Serialize)]
struct Started {
    #[serde(flatten)]
    status: GroupStatus,
    console: Option<String>,
}

/// Starts the group: in the foreground, where this process becomes its supervisor, or detached.
pub(super) fn up(paths: &GroupPaths, args: &UpArgs, out: &mut Output<'_>) -> Outcome {
    refuse_twice(paths)?;
    let options = options(paths, &args.config, args.fresh)?;
    let name = paths.name();
    if !args.detach {
        // Its problems are printed without the supervisor's log around them.
        configuration::settings(&args.config)?;
        note(format_args!("group {name} starts; Ctrl-C or `whichone down` stops it"));
        out.flush()?;
        return Err(launch::foreground(&launch::program(), &options, paths).into());
    }
    let timeout = args.wait.map(|WaitFor::Ready| args.timeout);
    let (_, ready) = start(paths, &options, &args.config, timeout)?;
    let status = operate::status_of(paths)?;
    if out.is_json() {
        out.json(&Started { status, console: console_link::address(paths) })?;
    } else {
        let pid = status.supervisor_pid;
        out.line(format_args!("group {name} is up (supervisor {pid}): {ready}"))?;
        if let Some(link) = console_link::link(paths) {
            out.line(format_args!("console: {link}"))?;
        }
    }
    Ok(Exit::Ok)
}

/// Starts a detached group, for a verb that needs one, and returns its supervisor's process; none if another start was
/// quicker, also one that is not over yet: that group is not this verb's to stop.
pub(super) fn bring_up(paths: &GroupPaths, config: &ConfigArgs) -> Result<Option<u32>, Failure> {
    if await_start(paths)? {
        return Ok(None);
    }
    let options = options(paths, config, false)?;
    match start(paths, &options, config, None) {
        Ok((supervisor, _)) => Ok(Some(supervisor)),
        Err(_) if await_start(paths)? => Ok(None),
        Err(failure) => Err(failure),
    }
}

/// Waits until a supervisor that is starting answers. Returns whether one does.
fn await_start(paths: &GroupPaths) -> Result<bool, Failure> {
    loop {
        if is_running(paths)? {
            return Ok(true);
        }
        if launch::holder(paths).is_none() {
            return Ok(false);
        }
        thread::sleep(LOOK_EVERY);
    }
}

/// Waits until every service of a group is ready that was just started.
pub(super) fn wait_ready(paths: &GroupPaths) -> Result<(), Failure> {
    let ready = launch::wait_ready(paths, Duration::from_secs(30));
    ready.map(drop).map_err(|error| not_ready(error, paths))
}

/// Returns true if a supervisor answers for the group.
pub(super) fn is_running(paths: &GroupPaths) -> Result<bool, Failure> {
    match operate::ask(paths, &Request::Ping, Duration::ZERO) {
        Ok(_) => Ok(true),
        // One that ends while it is asked was just killed or stopped.
        Err(CallError::NoGroup(_) | CallError::Closed(_)) => Ok(false),
        Err(other) => Err(other.into()),
    }
}

/// Refuses a second start. A supervisor that was killed may hold the group for another moment.
fn refuse_twice(paths: &GroupPaths) -> Result<(), Failure> {
    let until = Instant::now() + DYING;
    while let Some(supervisor) = launch::holder(paths) {
        let runs = is_running(paths)?;
        if runs || Instant::now() > until {
            let (name, state) = (paths.name(), if runs { "running" } else { "starting" });
            let what = format!("group {name} is already {state} (supervisor {supervisor})");
            let help = "another --group may run beside it";
            return Err(Failure::new(Exit::NotReached, format!("{what}; {help}")));
        }
        thread::sleep(LOOK_EVERY);
    }
    Ok(())
}

/// Returns the supervisor's options.
fn options(paths: &GroupPaths, config: &ConfigArgs, fresh: bool) -> Result<Options, Failure> {
    Ok(Options {
        group: paths.name().clone(),
        config: configuration::folder(config)?,
        profile: config.profile.clone(),
        set: config.set.clone(),
        fresh,
    })
}

/// Starts a detached supervisor and waits until it listens, and until every service is ready
/// if requested. Returns the supervisor's process and message.
fn start(
    paths: &GroupPaths,
    options: &Options,
    config: &ConfigArgs,
    wait: Option<Duration>,
) -> Result<(u32, String), Failure> {
    let mut launched = launch::detached(&launch::program(), options, paths)?;
    launched.wait_listening(EARLIER_SERVICES).map_err(|error| explained(error, config))?;
    let ready = match wait {
        None => "services are starting".to_owned(),
        Some(timeout) => {
            launch::wait_ready(paths, timeout).map_err(|error| not_ready(error, paths))?
        }
    };
    Ok((launched.pid(), ready))
}

/// Returns why not everything is ready, and what becomes of the group.
fn not_ready(error: LaunchError, paths: &GroupPaths) -> Failure {
    if !is_running(paths).unwrap_or(false) {
        return error.into();
    }
    let name = paths.name();
    let left = "help: `whichone status` shows its state, `whichone down` stops it";
    Failure::new(error.exit(), format!("{error}; group {name} keeps running; {left}"))
}

/// Returns why a supervisor has ended. It checks the configuration, whose problems are printed here
/// without its log around them; a check of our own before its start would only take time.
fn explained(error: LaunchError, config: &ConfigArgs) -> Failure {
    let refused = error.exit() == Exit::Config;
    let problems = refused.then(|| configuration::settings(config).err()).flatten();
    problems.unwrap_or_else(|| error.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn group_that_was_never_started_is_not_running() {
        let (_home, paths) = super::super::lab();
        assert!(!is_running(&paths).unwrap());
        refuse_twice(&paths).unwrap();
    }
}
