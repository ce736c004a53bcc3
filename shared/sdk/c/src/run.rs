//! The main loop of a service in C.

use std::ffi::{c_int, c_void};
use std::ops::ControlFlow;

use messages::Service;
use service::bus::{Bus, WakeListener};
use service::exit::{Exit, Failure};
use service::lifecycle::{Cycle, Health, Ready, SOURCES_MAX, Sources, drive};
use service::{Span, Time};

use crate::complain;
use crate::group::Group;

/// Longest time between two steps.
const STEP_EVERY: Span = Span::from_ms(500);

/// Handles the messages that have arrived.
pub type Step = unsafe extern "C" fn(*mut c_void);

struct Loop<'a> {
    bus: &'a Bus,
    listener: WakeListener,
    step: Step,
    context: *mut c_void,
    is_ending: bool,
}

impl Cycle for Loop<'_> {
    fn listener(&self) -> &WakeListener {
        &self.listener
    }

    fn wake(&self, now: Time) -> (Sources<'_>, Time) {
        ([None; SOURCES_MAX], now + STEP_EVERY)
    }

    fn shut_down(&mut self) {
        self.is_ending = true;
    }

    fn pass(&mut self, _ready: Ready) -> Result<ControlFlow<()>, Failure> {
        if let Some(joined) = self.listener.take() {
            self.bus.connect(joined);
        }
        // SAFETY: whoever runs the service promises that its step may be called with its context.
        unsafe { (self.step)(self.context) };
        Ok(if self.is_ending { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }

    fn health(&mut self, _now: Time) -> Health {
        Health::Working(None)
    }
}

/// Returns the service of this name, if some topic wakes it.
fn woken(bus: &Bus, name: &str) -> Result<Service, String> {
    let service = bus.woken().into_iter().find(|service| service.name() == name);
    let help = "list its topics under `reads` of the service";
    service.ok_or_else(|| format!("no topic wakes a service {name}; help: {help}"))
}

fn run(group: &mut Group, step: Step, context: *mut c_void) -> Result<(), Failure> {
    let usage = |what: String| Failure::new(Exit::Usage, what);
    let (name, lifecycle) = group.take_lifecycle().map_err(usage)?;
    let bus = group.bus();
    let listener = bus.wake_listener(woken(bus, &name).map_err(usage)?)?;
    let mut cycle = Loop { bus, listener, step, context, is_ending: false };
    drive(lifecycle, &mut cycle)
}

/// Runs the service until it is asked to end. Returns the exit code of the program.
///
/// # Safety
/// `group` is null or joined, and `step` may be called with `context`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_run(
    group: *mut Group,
    step: Option<Step>,
    context: *mut c_void,
) -> c_int {
    // SAFETY: as the caller promises; readers and writers do not refer to the group.
    let (Some(group), Some(step)) = (unsafe { group.as_mut() }, step) else { return 64 };
    match run(group, step, context) {
        Ok(()) => 0,
        Err(failure) => {
            complain(&failure);
            c_int::from(failure.exit as u8)
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use messages::topics::VIEW;
    use messages::{Epoch, Incarnation};
    use service::bus::Identity;
    use service::group::{GroupName, GroupPaths};
    use service::shm_cleanup;
    use service::wakes::Wakes;

    use super::*;

    #[test]
    fn services_that_a_topic_wakes_can_be_replaced() {
        let home = tempfile::Builder::new().prefix("wo").tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &GroupName::new("c").unwrap()).unwrap();
        shm_cleanup::create_place(&paths).unwrap();
        Wakes::new([("label", VIEW.name)]).save(&paths).unwrap();
        let identity = Identity { epoch: Epoch(1), incarnation: Incarnation(1) };
        let bus = Bus::open(&paths, "c", identity).unwrap();
        for name in ["grounding", "ros2", "label"] {
            assert_eq!(woken(&bus, name).map(Service::name), Ok(name));
        }
        assert!(woken(&bus, "stranger").is_err_and(|error| error.contains("stranger; help: ")));
        drop(bus);
        shm_cleanup::remove_leftovers(&paths);
    }
}
