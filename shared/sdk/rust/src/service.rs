//! A service of a new kind: its topics, and what it does with them.
//!
//! The configuration of the group adds it by a name of its own:
//!
//! ```toml
//! [services.labels]
//! command = ["/opt/lab/labels"]
//! reads = ["policy/act"]       # topics that wake it
//! writes = ["labels/latest"]   # its own topics begin with its name
//! ```

use std::ops::ControlFlow;
use std::process::ExitCode;
use std::rc::Rc;

use messages::Service as Name;
use runtime::bus::{Bus, Identity, WakeListener};
use runtime::clock;
use runtime::exit::{Exit, Failure};
use runtime::group::{ENV_SERVICE, GroupPaths};
use runtime::lifecycle::{Cycle, Environment, Health, Lifecycle, Ready, Sources, drive};
use runtime::notify::Notifier;
use runtime::{Span, Time};
use scene::Scene;

use crate::settings;

/// Shortest time from one pass to the next that a service can ask for.
const PASS_MIN: Span = Span::from_ms(1);

/// A service. One pass follows another: on every wake-up, when the time comes that the last one returned, and at a
/// signal. Heartbeats are sent between passes only, so that a pass must not wait: what takes longer than a second
/// belongs on a thread.
pub trait Service: Sized {
    /// Opens the topics and whatever else the service needs.
    ///
    /// # Errors
    /// Something that it needs is missing. [`Exit::Config`] and [`Exit::Usage`] mean that a restart does not help.
    fn open(context: &Context) -> Result<Self, Failure>;

    /// Reads what waits, decides, and writes. Returns when the next pass is due at the latest.
    ///
    /// # Errors
    /// Something that it needs is lost; its supervisor restarts it.
    fn pass(&mut self, now: Time) -> Result<Time, Failure>;

    /// Returns whether it can do its work; it is reported as ready once it can, and after a second in any case.
    fn is_ready(&self) -> bool {
        true
    }

    /// Brings it to rest; the process ends after it. Journals and devices are closed here.
    fn shut_down(&mut self) {}
}

/// A service's surroundings.
#[derive(Debug)]
pub struct Context {
    environment: Environment,
    name: Name,
    bus: Rc<Bus>,
    scene: Scene,
}

impl Context {
    /// The group's shared memory, of which topics are opened.
    pub fn bus(&self) -> &Bus {
        &self.bus
    }

    pub(crate) fn bus_handle(&self) -> Rc<Bus> {
        Rc::clone(&self.bus)
    }

    /// The scene in force. The service is restarted when it changes.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The service's name in the configuration.
    pub fn name(&self) -> &'static str {
        self.name.name()
    }

    /// Arguments of the program.
    pub fn arguments(&self) -> &[String] {
        &self.environment.arguments
    }

    /// The group's folders.
    pub fn paths(&self) -> &GroupPaths {
        &self.environment.paths
    }

    /// Number of this start of the service, from 1.
    pub fn incarnation(&self) -> u32 {
        self.environment.incarnation.0
    }
}

/// Runs the service until its supervisor ends it. Returns the exit code.
pub fn run<S: Service>() -> ExitCode {
    serve(|context| {
        Ok(Process {
            listener: context.bus.wake_listener(context.name)?,
            bus: context.bus_handle(),
            service: S::open(context)?,
            due: clock::now(),
            is_ending: false,
        })
    })
}

/// Begins logging, takes part in the group, and drives what `open` returns.
pub(crate) fn serve<C: Cycle>(open: impl FnOnce(&Context) -> Result<C, Failure>) -> ExitCode {
    crate::init_log();
    match serve_until_end(open) {
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

fn serve_until_end<C: Cycle>(
    open: impl FnOnce(&Context) -> Result<C, Failure>,
) -> Result<(), Failure> {
    let environment = Environment::read(std::env::args().skip(1).collect())?;
    let lifecycle = Lifecycle::begin(&environment.paths)?;
    let name = std::env::var(ENV_SERVICE).map_err(|_| {
        Failure::new(Exit::Usage, format!("{ENV_SERVICE}: expected the service's name, found none"))
    })?;
    let name = Name::named(&name);
    let scene = settings::scene(&environment.paths)?;
    let Environment { epoch, incarnation, .. } = environment;
    let bus = Bus::open(&environment.paths, name.name(), Identity { epoch, incarnation })?;
    let context = Context { environment, name, bus: Rc::new(bus), scene };
    let mut cycle = open(&context)?;
    drive(lifecycle, &mut cycle)
}

/// A service between passes.
struct Process<S> {
    listener: WakeListener,
    bus: Rc<Bus>,
    service: S,
    due: Time,
    is_ending: bool,
}

impl<S: Service> Cycle for Process<S> {
    fn listener(&self) -> &WakeListener {
        &self.listener
    }

    fn wake(&self, _: Time) -> (Sources<'_>, Time) {
        ([None, None, None], self.due)
    }

    fn is_ready(&self) -> bool {
        self.service.is_ready()
    }

    fn shut_down(&mut self) {
        self.is_ending = true;
        self.service.shut_down();
    }

    fn pass(&mut self, ready: Ready) -> Result<ControlFlow<()>, Failure> {
        if ready.by_wake
            && let Some(joined) = self.listener.take()
        {
            self.bus.connect(joined);
        }
        if self.is_ending {
            return Ok(ControlFlow::Break(()));
        }
        let now = clock::now();
        self.due = self.service.pass(now)?.max(now + PASS_MIN);
        Ok(ControlFlow::Continue(()))
    }

    fn health(&mut self, _: Time) -> Health {
        Health::Working(None)
    }
}
