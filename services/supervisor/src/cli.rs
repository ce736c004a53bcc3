//! The command line of `whichone-supervisor`: runs one group of services until it is stopped.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use service::exit::Exit;
use service::group::{GroupName, GroupPaths};
use service::launch::Options;
use service::lifecycle::survive_long_files;

use crate::Supervisor;
use crate::configuration::from_settings;

/// Starts, watches, restarts and stops the services of one group.
///
/// Started by `whichone up`, or by an init system, whose sd_notify protocol it speaks. TERM and INT
/// stop the group in order; `whichone status`, `swap`, `reload` and others talk to it meanwhile.
#[derive(Debug, Parser)]
#[command(name = "whichone-supervisor", version)]
struct Arguments {
    /// Name of the group.
    #[arg(long, default_value = GroupName::DEFAULT, env = service::group::ENV_GROUP)]
    group: GroupName,
    /// Folder of the configuration.
    #[arg(long, default_value = "config", value_name = "DIR")]
    config: PathBuf,
    /// A profile of the configuration, laid over it.
    #[arg(long, value_name = "NAME")]
    profile: Option<String>,
    /// Override a configuration value, e.g. group.scene=tools.
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_and_value)]
    set: Vec<(String, String)>,
    /// Start with new journals; the old ones are kept.
    #[arg(long)]
    fresh: bool,
    /// Leave the terminal's session.
    #[arg(long)]
    detached: bool,
}

fn key_and_value(text: &str) -> Result<(String, String), String> {
    let (key, value) = text.split_once('=').ok_or("expected KEY=VALUE")?;
    Ok((key.trim().to_owned(), value.trim().to_owned()))
}

/// Runs the supervisor as the command line says; returns its exit code.
pub fn run() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Nothing to do if standard error is closed.
            let _ = error.print();
            return if error.use_stderr() { Exit::Usage.code() } else { Exit::Ok.code() };
        }
    };
    // Also of what the services create: they inherit it.
    rustix::process::umask(rustix::fs::Mode::RWXG | rustix::fs::Mode::RWXO);
    let _log = service::logging::init();
    end_on_panic();
    allow_descriptors();
    // Before the first segment of shared memory, which is a file too.
    if let Err(error) = survive_long_files() {
        tracing::warn!(%error, "SIGXFSZ is not taken over");
    }
    if arguments.detached
        && let Err(error) = rustix::process::setsid()
    {
        tracing::warn!(%error, "the terminal's session was not left");
    }
    supervise(arguments).code()
}

fn supervise(arguments: Arguments) -> Exit {
    let paths = match GroupPaths::resolve(&arguments.group) {
        Ok(paths) => paths,
        Err(error) => {
            tracing::error!("{error}");
            return Exit::Usage;
        }
    };
    let Arguments { group, config, profile, set, fresh, .. } = arguments;
    let load = from_settings(Options { group, config, profile, set, fresh });
    match Supervisor::start(paths, load, fresh) {
        Ok(supervisor) => supervisor.run(),
        Err(error) => {
            tracing::error!("{error}");
            error.exit()
        }
    }
}

/// Raises the limit of descriptors as far as allowed, for the services, which inherit it: shells and desktops set it low.
fn allow_descriptors() {
    let Rlimit { maximum, .. } = getrlimit(Resource::Nofile);
    if let Err(error) = setrlimit(Resource::Nofile, Rlimit { current: maximum, maximum }) {
        tracing::debug!(%error, "the limit of descriptors stays");
    }
}

/// A broken invariant ends the process with the code that says so. The services notice that their
/// lifeline has ended and end by themselves.
fn end_on_panic() {
    let report = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        report(panic);
        std::process::exit(i32::from(Exit::Invariant as u8));
    }));
}
