//! Verbs that send requests to the supervisor: start, stop, restart, hold, release, reload, swap, down.

use std::os::fd::OwnedFd;
use std::time::Duration;

use command_line::Outcome;
use command_line::output::Output;
use laboratory::args::{RecordVerb, RecorderArgs};
use laboratory::recordings;
use messages::Service;
use rustix::event::{PollFd, PollFlags, poll};
use rustix::process::{Pid, PidfdFlags, Signal, pidfd_open, pidfd_send_signal};
use rustix::time::Timespec;
use serde::Serialize;
use service::control::{CallError, DownReport, Reply, Request, Target, call};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::launch;
use service::status::GroupStatus;

use super::{leftovers, words};
use crate::cli::{ReloadArgs, RestartArgs, ServiceArgs, SwapArgs};

/// Timeout of the supervisor's answer, beyond the requested wait.
const ANSWER_PATIENCE: Duration = Duration::from_secs(5);

/// Sends a request to the group's supervisor; `wait` is the timeout of the request itself.
pub(super) fn ask(
    paths: &GroupPaths,
    request: &Request,
    wait: Duration,
) -> Result<Reply, CallError> {
    call(&paths.control_socket(), request, wait + ANSWER_PATIENCE)
}

pub(super) fn status_of(paths: &GroupPaths) -> Result<GroupStatus, CallError> {
    match ask(paths, &Request::Status, Duration::ZERO)? {
        Reply::Status(status) => Ok(*status),
        other => Err(unintelligible(paths, &other)),
    }
}

/// Sends a request about one service.
pub(super) fn on_service(
    paths: &GroupPaths,
    request: impl FnOnce(Target) -> Request,
    ServiceArgs { service, timeout }: ServiceArgs,
    out: &mut Output<'_>,
) -> Outcome {
    order(paths, &request(Target { service, wait_ms: ms(timeout) }), timeout, out)
}

/// Starts or stops the recorder, or shows its files.
pub(super) fn recorder(paths: &GroupPaths, verb: RecordVerb, out: &mut Output<'_>) -> Outcome {
    let service = || Service::Recorder.name().to_owned();
    let args = |RecorderArgs { timeout }| ServiceArgs { service: service(), timeout };
    match verb {
        RecordVerb::Start(of) => on_service(paths, Request::Start, args(of), out),
        RecordVerb::Stop(of) => on_service(paths, Request::Stop, args(of), out),
        RecordVerb::List => recordings::list(paths, out),
        RecordVerb::Open(of) => recordings::open(paths, &of, out),
    }
}

/// Stops a service and starts it again.
pub(super) fn restart(paths: &GroupPaths, args: RestartArgs, out: &mut Output<'_>) -> Outcome {
    let RestartArgs { service, original, timeout } = args;
    order(paths, &Request::Restart { service, original, wait_ms: ms(timeout) }, timeout, out)
}

/// Reloads the configuration, with another scene where one is named.
pub(super) fn reload(paths: &GroupPaths, args: ReloadArgs, out: &mut Output<'_>) -> Outcome {
    let (timeout, wait_ms) = (args.timeout, ms(args.timeout));
    let request = match args.scene {
        Some(scene) => Request::UseScene { scene, wait_ms },
        None => Request::Reload { wait_ms },
    };
    order(paths, &request, timeout, out)
}

/// Replaces a service's program.
pub(super) fn swap(paths: &GroupPaths, args: SwapArgs, out: &mut Output<'_>) -> Outcome {
    let directory = std::env::current_dir()
        .map_err(|error| Failure::new(Exit::NotReached, format!("the current folder: {error}")))?;
    let SwapArgs { service, command, timeout } = args;
    order(paths, &Request::Swap { service, command, directory }, timeout, out)
}

/// Stops the group. One that does not run is down already; what a killed one has left is removed.
pub(super) fn down(paths: &GroupPaths, timeout: Duration, out: &mut Output<'_>) -> Outcome {
    let supervisor = supervisor(paths);
    let report = match ask(paths, &Request::Down, timeout) {
        Ok(Reply::Down(report)) => report,
        Ok(other) => return Err(unintelligible(paths, &other).into()),
        Err(CallError::NoGroup(_)) => match launch::holder(paths) {
            Some(pid) => return starting(paths, pid, timeout, out),
            None => return not_running(paths, timeout, out),
        },
        Err(other) => return Err(other.into()),
    };
    supervisor.iter().for_each(await_end);
    if out.is_json() {
        out.json(&report)?;
    } else {
        print_down_report(paths, &report, out)?;
    }
    Ok(Exit::Ok)
}

/// The supervisor's process, to wait for its end; none where it does not run.
fn supervisor(paths: &GroupPaths) -> Option<OwnedFd> {
    let pid = status_of(paths).ok()?.supervisor_pid;
    pidfd_open(Pid::from_raw(i32::try_from(pid).ok()?)?, PidfdFlags::empty()).ok()
}

/// Waits until the process has ended, which the supervisor does right after its last reply: a script
/// may look for leftovers, or start the group again, at once.
fn await_end(process: &OwnedFd) {
    let patience = Timespec { tv_sec: ANSWER_PATIENCE.as_secs().cast_signed(), tv_nsec: 0 };
    // Where this fails the group is down all the same; only a hurried caller would notice.
    let _ = poll(&mut [PollFd::new(process, PollFlags::IN)], Some(&patience));
}

fn print_down_report(
    paths: &GroupPaths,
    report: &DownReport,
    out: &mut Output<'_>,
) -> Result<(), Failure> {
    let after = words::time(report.seconds);
    out.line(format_args!("group {} is down after {after}", paths.name()))?;
    let remarks = [
        ("did not end when asked and were killed", &report.killed),
        ("left behind by services and killed", &report.orphans),
        ("left in shared memory and removed", &report.leftovers),
    ];
    for (what, names) in remarks.into_iter().filter(|(_, names)| !names.is_empty()) {
        out.line(format_args!("  {what}: {}", names.join(", ")))?;
    }
    Ok(())
}

/// Ends a supervisor that does not listen yet: it has started no service.
fn starting(paths: &GroupPaths, pid: u32, timeout: Duration, out: &mut Output<'_>) -> Outcome {
    let process = i32::try_from(pid).ok().and_then(Pid::from_raw);
    let process = process.and_then(|pid| pidfd_open(pid, PidfdFlags::empty()).ok());
    // Only now the number is surely its own.
    if let Some(process) = process.filter(|_| launch::holder(paths) == Some(pid)) {
        // It may have ended meanwhile.
        let _ = pidfd_send_signal(&process, Signal::TERM);
        let patience = Timespec { tv_sec: timeout.as_secs().cast_signed(), tv_nsec: 0 };
        let _ = poll(&mut [PollFd::new(&process, PollFlags::IN)], Some(&patience));
    }
    let name = paths.name();
    if launch::holder(paths) == Some(pid) {
        let what = format!("group {name}: supervisor {pid}, which was starting, does not end");
        return Err(Failure::new(Exit::NotReached, what));
    }
    if !out.is_json() {
        out.line(format_args!("group {name} was starting; its supervisor {pid} is ended"))?;
    }
    not_running(paths, timeout, out)
}

fn not_running(paths: &GroupPaths, timeout: Duration, out: &mut Output<'_>) -> Outcome {
    let removed = leftovers::remove(paths, timeout)?;
    if out.is_json() {
        let leftovers = removed.iter().map(|path| path.display().to_string()).collect();
        out.json(&DownReport { leftovers, ..DownReport::default() })?;
        return Ok(Exit::Ok);
    }
    let name = paths.name();
    match removed.len() as u64 {
        0 => out.line(format_args!("group {name} is not running"))?,
        files => {
            let files = scene::count(files, "file");
            out.line(format_args!("group {name} is not running; {files} of it removed"))?;
        }
    }
    Ok(Exit::Ok)
}

/// A fulfilled request with `--json`.
#[derive(Serialize)]
struct Done {
    message: String,
}

/// A reload with `--json`.
#[derive(Serialize)]
struct Reloaded {
    restarted: Vec<String>,
}

/// Sends one request and prints its result.
fn order(paths: &GroupPaths, request: &Request, wait: Duration, out: &mut Output<'_>) -> Outcome {
    match ask(paths, request, wait)? {
        Reply::Done { message } if out.is_json() => out.json(&Done { message })?,
        Reply::Done { message } => out.line(message)?,
        Reply::Reloaded { restarted } if out.is_json() => {
            out.json(&Reloaded { restarted })?;
        }
        Reply::Reloaded { restarted } if restarted.is_empty() => {
            out.line("the configuration is in force; no service had to be restarted")?;
        }
        Reply::Reloaded { restarted } => {
            let names = restarted.join(", ");
            out.line(format_args!("the configuration is in force; restarted: {names}"))?;
        }
        other => return Err(unintelligible(paths, &other).into()),
    }
    Ok(Exit::Ok)
}

/// A wait in milliseconds, as requests carry it.
fn ms(time: Duration) -> u64 {
    u64::try_from(time.as_millis()).unwrap_or(u64::MAX)
}

fn unintelligible(paths: &GroupPaths, reply: &Reply) -> CallError {
    CallError::unintelligible(&paths.control_socket(), format!("{reply:?}"))
}

#[cfg(test)]
mod tests;
