//! The way of a service's program into its main loop: recovery, topics, the first pass.

use std::process::ExitCode;

use config::Settings;
use journal::Journal;
use runtime::port_failures::PortFailures;

use super::{In, Loop, Program, Record, wall_ns};
use crate::bus::{Bus, Identity, WakeListener};
use crate::clock;
use crate::commit::Commit;
use crate::exit::{Exit, Failure};
use crate::flight::{Head, Ring, Tap};
use crate::inspection;
use crate::lifecycle::{Environment, Lifecycle, drive};
use crate::logging;
use crate::notify::Notifier;
use crate::service_loop::{Context, Shell};
use crate::worker_channel::{self, DeviceSender};
use crate::{Effects, Event, Node, SetAside, journal_set};

/// Runs the service until it is asked to shut down, or the inspection that the arguments name.
pub fn run<P: Program>() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let Some(exit) = inspection::run::<P>(&arguments) {
        return exit.code();
    }
    program(P::SERVICE.name(), P::ABOUT, serve::<P>)
}

/// Runs a service's program: prints `--help` with its name and `about`, or initialises logging,
/// calls `serve` with the arguments and returns its exit code.
pub fn program(
    name: &str,
    about: &str,
    serve: impl FnOnce(Vec<String>) -> Result<(), Failure>,
) -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|a| a == "--help" || a == "-h") {
        return help(name, about);
    }
    let _log = logging::init();
    logging::identify();
    match serve(arguments) {
        Ok(()) => Exit::Ok.code(),
        Err(failure) => {
            tracing::error!(exit = failure.exit as u8, "{failure}");
            if failure.exit == Exit::Storage
                && let Ok(mut supervisor) = Notifier::from_environment()
            {
                supervisor.say(&format!("X_SHORTAGE={failure}"));
            }
            failure.exit.code()
        }
    }
}

fn help(name: &str, about: &str) -> ExitCode {
    use std::io::Write;
    let text = format!(
        "whichone-{name}: {about}\n\nStarted by the group's supervisor (whichone up); put your own in \
         its place with:\n  whichone swap {name} -- COMMAND…\n"
    );
    // A closed pipe is the reader's choice.
    let _ = std::io::stdout().write_all(text.as_bytes());
    Exit::Ok.code()
}

fn serve<P: Program>(arguments: Vec<String>) -> Result<(), Failure> {
    let environment = Environment::read(arguments)?;
    let lifecycle = Lifecycle::begin(&environment.paths)?;
    let settings = Settings::load_snapshot(&environment.paths.run())?;
    let config = P::config(&environment, &settings)?;
    let (journal, records, set_aside) = open_journal::<P>(&environment)?;
    let tap = start_tap::<P>(&environment, &settings, &records);
    let node = P::Node::recover(config, records)?;
    let failed = |e: std::io::Error| Failure::new(Exit::NotReached, e.to_string());
    let file = environment.paths.journal_file(P::SERVICE.name());
    let commit = Commit::start(journal, &file).map_err(failed)?;
    let identity = Identity { epoch: environment.epoch, incarnation: environment.incarnation };
    let (devices, inbox) = worker_channel::channel().map_err(failed)?;
    let (bus, shell, wake_listener) = open_topics::<P>(&environment, identity, &settings, devices)?;
    let mut service = Loop::<P> {
        node,
        shell,
        commit,
        inbox,
        wake_listener,
        effects: Effects::default(),
        tap,
        port_error: None,
        port_failures: PortFailures::default(),
        bus,
    };
    if let Some(set_aside) = set_aside {
        service.feed(Event::SetAside(set_aside));
    }
    service.feed(Event::Started);
    service.commit()?;
    service.tap.end_pass();
    drive(lifecycle, &mut service)
}

/// Starts recording this start of the service.
fn start_tap<P: Program>(
    environment: &Environment,
    settings: &Settings,
    records: &[Record<P>],
) -> Tap {
    let config::Flight { enabled, bytes_max, free_min } = settings.group.flight;
    if !enabled || !P::RECORDS_FLIGHTS {
        return Tap::default();
    }
    let head = Head::of::<P>(environment, settings, clock::now(), wall_ns());
    let ring = Ring { folder: environment.paths.flights(), bytes_max, free_min };
    Tap::start(ring, &head, records)
}

fn open_topics<P: Program>(
    environment: &Environment,
    identity: Identity,
    settings: &Settings,
    devices: DeviceSender<In<P>>,
) -> Result<(Bus, P::Shell, WakeListener), Failure> {
    let bus = Bus::open(&environment.paths, P::SERVICE.name(), identity)?;
    let wake_listener = bus.wake_listener(P::SERVICE)?;
    let shell = P::Shell::open(&Context { bus: &bus, settings, devices, environment })?;
    Ok((bus, shell, wake_listener))
}

/// The journal of a service, if it has one, its records, and the numbers that are over.
type Recovered<P> = (Option<Journal<Record<P>>>, Vec<Record<P>>, Option<SetAside>);

fn open_journal<P: Program>(environment: &Environment) -> Result<Recovered<P>, Failure> {
    let Some(record) = P::RECORD else { return Ok((None, Vec::new(), None)) };
    let (journal, recovered, set_aside) =
        journal_set::open(environment, P::SERVICE.name(), record, P::OLDER_RECORDS)?;
    if recovered.truncated_bytes > 0 {
        tracing::warn!(bytes = recovered.truncated_bytes, "torn tail cut off");
    }
    tracing::info!(records = recovered.records.len(), "journal recovered");
    Ok((Some(journal), recovered.records, set_aside))
}
